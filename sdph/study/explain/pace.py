"""Windows and sub-steps to be expected of grains: the run's own clock, driven by the scales of the case.

What rules later differs from the start in four ways, each by an argument from the case alone:
- gas that is let in has blown its mouth free, so that the Courant number is that of its own speed, not of that
  between packed grains;
- grains that the gas grips as one bear `sdph.exchange.window.GRIP` of the time in which it stops them beyond their own
  drag, at the slip that carries their weight;
- lasting contacts of packed grains become as stiff as what they carry asks for: the weight that the gas leaves to
  them, all of it where gas passes in bubbles, as soon as grains can have fallen through the bed, or the dynamic
  pressure alpha_p rho_p v^2/2 of grains that are thrown and brought to rest. Grains that gas blows along, or that
  fall, are not those that carry.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from sdph import effects
from sdph.effects.gas import evaporation, reaction
from sdph.effects.grains import friction, granular_pressure
from sdph.engine.clock import count_of_parts
from sdph.exchange.window import GRIP, MOST, Window, held, settling, smallest_cell
from sdph.laws.constants import HALVINGS
from sdph.methods.grains import ways
from sdph.methods.grains.method import limits as limits_of_step
from sdph.methods.grains.scales import scales_of
from sdph.methods.grains.sound import swing, waves_of
from sdph.study.explain import feed

ACROSS = 6.0  # smoothing lengths: grains less than three kernels across are all rim, and hold no bubble


class Pace(NamedTuple):
    """Windows and sub-steps of a run."""

    windows: int
    steps: int


def expected(case, s, state, crossed: float = 0.0) -> Pace:
    """Counts for the case with scales `s` and particles as in `state` at the start; `crossed` as of `later`."""
    early, late = (
        case.run.step_factor * min(sub_steps(case, s, state, come_down).values(), default=math.inf)
        for come_down in (False, True)
    )
    moving, windows, steps, time, falling = effects.moving(case), 0, 0.0, 0.0, coming_down(case, s)
    for length, number in lengths(case, s, state, crossed):
        windows += number
        steps += number * parts(length, early if time < falling else late, moving)
        time += number * length
    return Pace(windows, math.ceil(steps))


def parts(window: float, limit: float, moving: bool) -> float:
    """Sub-steps in a window, both [s]. The limit of grains that move varies from one to the next, so that what is
    rounded up is half a sub-step more on average; that of others does not."""
    share = window / limit
    if moving:
        return share + 0.5 if share > 0.5 else 1.0
    return max(1, math.ceil(share))


def lengths(case, s, state, crossed: float = 0.0) -> list[tuple[float, int]]:
    """(length [s], how many) of the windows, one after the other; `crossed` as of `later`."""
    clock = Window(case)
    clock.obey(asked(case, s, state))
    driven, found, time = Driven(case, s, clock, crossed), [], 0.0
    if min([clock.longest(), *driven.steady.values()]) < clock.shortest:  # the run itself will say that it gets nowhere
        return [(clock.longest(), math.ceil(case.run.end_time / clock.longest()))]
    while not clock.over(time) and not driven.settled():
        end = clock.choose(time)
        found.append((end - time, 1))
        driven.learn(end - time)
        time = end
    return found + ([] if clock.over(time) else _evenly(clock, time))


def _evenly(clock, time: float) -> list[tuple[float, int]]:
    """Lengths and numbers of the windows left, of one limit, in equal parts between moments that must be met."""
    moments = clock.landmarks[clock.landmarks > time + clock.shortest]
    gaps = np.diff(moments, prepend=time)
    numbers = [count_of_parts(gap, clock.longest(), clock.shortest, "the window") for gap in gaps]
    return [(gap / number, number) for gap, number in zip(gaps, numbers)]


class Driven:
    """News for a clock after each window: speeds that the case leads to, and the heat that one lump of grains
    exchanges with its gas, from the temperatures that both start with."""

    def __init__(self, case, s, clock, crossed: float):
        self.clock, self.steady = clock, later(case, s, crossed)
        self.fastest = s.speed if effects.moving(case) else 0.0
        self.rate, self.flow = 0.0, None  # [1/s], and heat in the last window over its length, of all there is [1/s]
        self.feed, self.time, self.thickening = feed.of(case, s), 0.0, thickening(case)
        if self.thickening:
            clock.obey({self.thickening.cause: self.thickening.limit(1.0)})
            self.steady[self.thickening.cause] = self.thickening.limit(self.thickening.steady)
        if self.feed:
            clock.begin(0.0, 0.0)
        elif "heat" in case.effects and s.span and not case.coupling.one_way:
            self.rate = 1.0 / s.heat_time + 1.0 / s.gas_heat_time
            clock.begin(self.rate, 1.0)
        apart = max((abs(patch.temperature - case.gas.temperature) for patch in case.particles.values()), default=0.0)
        self.left = apart / s.span if self.rate else 0.0  # to exchange

    def settled(self) -> bool:
        """True where no limit that rules will change any more: each is what it will be, or stays above the least."""
        now = self.clock.limits
        least = min(limit for cause, limit in now.items() if cause != "heat exchange")
        if self.feed and not self.feed.under_way(least, self.clock.control.tolerance):
            return False
        pairs = [(now.get(cause, 0.0), limit) for cause, limit in self.steady.items()]
        steady = all(math.isclose(*pair) or min(pair) > least for pair in pairs)
        return steady and now.get("heat exchange", math.inf) > least

    def learn(self, dt: float) -> None:
        """A window of `dt` [s] is done; what is left of the heat has relaxed exponentially, or nozzles feed more."""
        courant = self.clock.courant * dt / self.steady["courant"] if "courant" in self.steady else 0.0
        if self.thickening:
            self.thickening.learn(self.clock, dt)
        if self.feed:
            self.clock.learn(dt, *self.feed.window(self.time, dt), courant, self.fastest)
            self.time += dt
            self.clock.stake(self.feed.stake(self.time))
            return
        given = self.left * -math.expm1(-self.rate * dt)
        change = abs(given / dt - self.flow) if self.flow is not None else 0.0
        self.left, self.flow = self.left - given, given / dt
        self.clock.learn(dt, given, change, courant, self.fastest)


def later(case, s, crossed: float = 0.0) -> dict[str, float]:
    """Longest windows [s] by what moves once the start is over, of gas and of grains; `crossed` is how often in a
    second [1/s] gas crosses a cell of a mesh of its own, where there is one."""
    let_in = max((b.fastest for b in case.boundaries.values()), default=0.0)
    cell = smallest_cell(case)
    rates = {
        "courant": max(let_in / cell, s.rush / cell, crossed),
        "particles": s.speed / cell if effects.moving(case) else 0.0,
    }
    return {cause: case.coupling.courant / rate for cause, rate in rates.items() if rate}


def asked(case, s, state) -> dict[str, float]:
    """Longest windows [s] that drag and the effects bear, by what bears them."""
    own = {"grip": grip(case, s), "settling": drifting(case, s)}
    return own | effects.window_limits(parameters(case), case, state)


def drifting(case, s) -> float:
    """Longest window [s] in which grains drift right (`sdph.exchange.exchange.Exchange.settling`)."""
    if "drag" not in case.effects or not s.patches:
        return math.inf
    return settling(case, math.hypot(*s.weight), s.drag_time, s.slip)


class Thickening:
    """Vapour that droplets give the gas among them, or oxidant that grains take from it: what there is relaxes towards
    the share `most` at `rate` [1/s], while gas that flows past at the slip of the case renews it cell by cell."""

    def __init__(self, case, s, cause: str, rate: float, most: float):
        self.cause, self.most, self.rate = cause, most, rate
        self.left = 1.0  # of the way to the most
        self.both = rate + s.slip / smallest_cell(case)
        self.steady = 1.0 - rate / self.both if self.both else 1.0  # what is left then

    def limit(self, left: float) -> float:
        """Longest window [s] with so much left."""
        pace = self.rate * self.most * left
        return MOST[self.cause] / pace if pace > 0.0 else math.inf

    def learn(self, clock, dt: float) -> None:
        """Tell a clock of a window of `dt` [s]."""
        given = (self.left - self.steady) * -math.expm1(-self.both * dt)
        time = self.steady * dt + (given / self.both if self.both else 0.0)
        clock.thicken(dt, self.rate * self.most * time, self.cause)
        self.left -= given


def thickening(case) -> Thickening | None:
    """Thickening by those grains of a case that ask for the shortest window, each nozzle's apart; None of those that
    change no gas."""
    found = [_thickening(one, scales_of(one)) for one in feed.apart(case)]
    return min((own for own in found if own), key=lambda own: own.limit(1.0), default=None)


def _thickening(case, s) -> Thickening | None:
    """Thickening by the densest grains of a case; None as above."""
    if not s.patches or case.vapour is None or case.coupling.one_way:
        return None
    if "evaporation" in case.effects:
        return Thickening(case, s, "evaporation", *evaporation.filling(s))
    if "reaction" in case.effects:
        return Thickening(case, s, "reaction", reaction.stripping(s, max(case.temperatures), s.slip), 1.0)
    return None


def grip(case, s) -> float:
    """Longest window [s] of grains that the gas grips as one (`sdph.exchange.exchange.Exchange.grip`)."""
    if not {"gas_pressure", "drag"} <= set(case.effects) or case.coupling.one_way or not case.particles:
        return math.inf
    carrying = s.minimum_fluidisation / (1.0 - s.capped)
    slip = s.slip if math.isnan(carrying) else min(s.slip, carrying)
    rate = s.damping(s.alpha_p, slip) * held(s.capped, s.gas.density / s.grains.density)
    return GRIP / rate if rate else math.inf


def sub_steps(case, s, state, come_down: bool = True) -> dict[str, float]:
    """Longest sub-steps [s] by cause, before run.step_factor, once grains have `come_down` or before
    (`coming_down`)."""
    pace = fastest(case, s, come_down) if effects.moving(case) else 0.0
    return effects.finite(limits_of_step(case, parameters(case), state, pace, {}))


def fastest(case, s, come_down: bool) -> float:
    """omega h + 2 v [m/s] of grains that carry, which go no faster than they are thrown, or of the fastest, whose
    contacts do not last."""
    waves, carrying = waves_of(case), stiffness(case, s, come_down or not bubbles(case, s))
    agitated = stiffness(case, s, lasting=False)
    return max(swing(waves, *carrying) + 2.0 * s.thrown, swing(waves, *agitated) + 2.0 * s.speed)


def parameters(case) -> dict:
    """Parameters of the effects that are on, as the run's loops take them."""
    return {name: effects.kernel_of(effects.REGISTRY[name], case) for name in case.effects}


def sound(case, s) -> float:
    """c [m/s] of agitation and friction where grains lie closest once they carry what they have to."""
    return math.sqrt(stiffness(case, s)[0])


def stiffness(case, s, lasting: bool = True) -> tuple[float, float]:
    """c^2 and pressure over density [m2/s2] there, with `lasting` contacts or without."""
    squared = pressed = 0.0
    if lasting and "friction" in case.effects:
        p, alpha_p = friction.kernel(case), s.alpha_p
        if alpha_p >= ways.SETTLED * p.onset or bubbles(case, s):
            alpha_p = max(alpha_p, packed_by(p, carried(case, s)))
        pressure, slope = friction.pressure(p, alpha_p)
        squared = friction.sound_squared(p, slope)
        pressed = pressure / (alpha_p * s.grains.density) if pressure else 0.0
    if "granular_pressure" in case.effects and s.alpha_p:
        p = granular_pressure.kernel(case)
        squared += granular_pressure.sound_squared(p, s.alpha_p, s.theta, s.g0)
        pressed += granular_pressure.pressure(p, s.alpha_p, s.theta, s.g0) / (s.alpha_p * s.grains.density)
    return squared, pressed


def carried(case, s) -> float:
    """Pressure [Pa] that lasting contacts carry: the weight of grains on a floor that gas from below does not, or the
    dynamic pressure (Bernoulli's) of those that are thrown."""
    density, weight = s.alpha_p * s.grains.density, 0.0
    if s.gravity and s.patches and ways.lie(case, s.patches):
        weight = density * s.gravity * height(case, s) * (1.0 - lifted(case, s))
    return max(0.5 * density * s.thrown**2, weight)


def height(case, s) -> float:
    """Height [m] of the tallest region of grains."""
    up = ways.upright(case)
    return max(patch.upper[up] - patch.lower[up] for patch in s.patches)


def lifted(case, s) -> float:
    """Share of the weight that gas carries which is let in against gravity: U/U_mf of the slowest inlet, as a jet
    beside it lifts what lies before it only; Ergun's law is all but linear there. Nothing of it for good where gas
    passes in bubbles: grains that one has left behind come down on each other with all their weight, as all do where
    it is shut off."""
    return 0.0 if bubbles(case, s) else min(1.0, ways.slowest(case, min) / s.minimum_fluidisation)


def bubbles(case, s) -> bool:
    """True where gas is let in under lying grains faster than lifts them, so that the rest passes in bubbles (Toomey &
    Johnstone 1952, Chem. Eng. Prog. 48, 220), and slower than carries them away."""
    wide = s.length >= ACROSS * case.smoothing_length
    return wide and ways.lie(case, s.patches) and s.minimum_fluidisation < ways.slowest(case) < s.falling


def coming_down(case, s) -> float:
    """Time [s] in which grains fall as far as a bed is high that gas bubbles through; none in others. Before, what the
    gas has lifted cannot be back."""
    return math.sqrt(2.0 * height(case, s) / s.gravity) if bubbles(case, s) else 0.0


def packed_by(p, pressure: float) -> float:
    """alpha_p at which contacts with the parameters `p` carry a pressure [Pa], by bisection."""
    low, high = 0.0, 1.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if friction.pressure(p, middle)[0] < pressure else (low, middle)
    return low
