"""Length of the next window: the least of all limits, each by its cause.

The exchange is first order in the window. Its error over a window is estimated from how much the exchanged heat
changed since the last one, error = sum |Q_n/dt_n - Q_(n-1)/dt_(n-1)| dt_n^2/(dt_n + dt_(n-1)), and held at
`coupling.window_tolerance` times the heat that there is to exchange.
"""

from __future__ import annotations

import math

import numpy as np

from sdph import effects
from sdph.case import inlets
from sdph.case.gas_cells import cell_edges
from sdph.effects.around.streams import streams_of
from sdph.engine.clock import Clock
from sdph.engine.kept import POSITIVE, Maybe, Named, Unfit
from sdph.engine.state import GRAIN
from sdph.laws.constants import TINY

SAFETY, GROWTH, SHRINK = 0.9, 2.0, 0.3  # usual bounds of a step controller (Hairer, Norsett & Wanner, II.4); our choice
# most that a window brings or takes: vapour that comes into a cell, of the gas in it, so that it is carried away as it
# comes; oxidant that a reaction takes from one, of what the richest gas of the case holds there; our choice
MOST = {"evaporation": 0.1, "reaction": 0.2}
# of the time in which gas that gives way stops grains beyond what their own drag does, most that it may be held: a bed
# then slows at a rate that is up to half of that, 5 %, too high, whatever its volume fraction; our choice
GRIP = 0.1
# gas that is pushed aside answers an acceleration a by r (2 a - a_before), a window later: at most so much of r a
ANSWER = 3.0
# limit -> what a user can change about it
KEYS = {
    "largest": "coupling.window_largest_s", "heat exchange": "coupling.window_tolerance", "courant": "coupling.courant",
    "particles": "coupling.courant", "evaporation": "the rate of evaporation",
    "reaction": "the rate of the reaction", "grip": "the drag on packed grains",
    "settling": "run.accuracy",
    "contact": "liquid.sound_speed_m_s, whose square is the stiffness of contacts",
}  # fmt: skip


def held(alpha_p, ratio):
    """Share of drag's rate beta/(alpha_p rho_p) that is of gas which a window holds, `ratio` being rho_g/rho_p.

    With alpha_g v_g + alpha_p v_p given, drag and pressure gradient together are beta/alpha_g^2 v_p: grains that move
    as one stop at the rate beta/(alpha_g^2 alpha_p rho_p). Drag alone is exact over a window, the rest is held; so is
    the answer of the gas that is pushed aside, r = alpha_p rho_g/(alpha_g rho_p) times their inertia, to drag itself.
    """
    alpha_g = 1.0 - alpha_p
    return alpha_g**-2 - 1.0 + ANSWER * ratio * alpha_p / alpha_g


class Control:
    """Step control of one exchanged quantity by the change of its rate."""

    KEPT, FORMS = ("before", "scale", "error"), {"before": Maybe(0.0)}  # see sdph.engine.kept

    def __init__(self, tolerance: float):
        self.tolerance = tolerance
        self.before = None  # length of the last window [s]
        self.scale = 0.0
        self.error = 0.0

    def admit(self, kept: dict) -> None:
        """Unfit where what it learned cannot be."""
        if (kept["before"] is not None and not kept["before"] > 0.0) or min(kept["scale"], kept["error"]) < 0.0:
            raise Unfit("the control of the window has learned what no window can tell")

    def begin(self, rate: float, scale: float) -> float:
        """First window [s] of a relaxation at `rate` [1/s]: backward Euler errs by (rate dt)^2/2 of `scale`."""
        self.scale = scale
        return math.sqrt(2.0 * self.tolerance) / rate if rate > 0.0 else math.inf

    def learn(self, dt: float, heat: float, change: float) -> float:
        """Next window [s] after one of `dt` [s] in which particles exchanged `heat` [J], sum of |Q|, at rates that
        differ by `change` [W], sum of |Q/dt - Q/dt before|, from those of the last window."""
        before, self.before = self.before, dt
        self.scale = max(self.scale, heat)
        if self.scale == 0.0:  # nothing to exchange, nothing to resolve
            return dt * GROWTH
        if before is None:
            return dt
        self.error = change * dt * dt / (dt + before) / self.scale
        return dt * min(GROWTH, max(SHRINK, SAFETY * math.sqrt(self.tolerance / max(self.error, TINY))))


def learned(state, heat, dt: float) -> tuple[float, float]:
    """Heat [J] that grains exchanged in a window of `dt` [s], sum of |heat|, and the change [W] of its rate since the
    last one, of those that were in the gas in both; the state gets the rate of now."""
    inside = state.kind == GRAIN
    change = 0.0
    if len(state.received):
        both = inside & (state.exchanged > 0)
        change = float(np.abs(heat[both] / dt - state.received[both]).sum())
        state.received[:], state.exchanged[:] = heat / dt, inside
    return float(np.abs(heat[inside]).sum()), change


class Window(Clock):
    """Chooses windows: what is told of each limit decides how long the next one is."""

    KEPT, FORMS = ("limits", "control", "limit"), {"limits": Named(POSITIVE)}  # see sdph.engine.kept

    def __init__(self, case):
        super().__init__(case.run, turns=inlets.times(case))
        self.case, self.courant, self.cell = case, case.coupling.courant, smallest_cell(case)
        self.limits = {"largest": case.coupling.window_largest} | opening(case)
        self.control = Control(case.coupling.window_tolerance)

    def admit(self, kept: dict) -> None:
        """Unfit where a limit would never let the run come to its end."""
        limits = kept["limits"]
        if limits.get("largest") != self.limits["largest"] or min(limits.values()) < self.shortest:
            raise Unfit(f"the limits of the window are not those of this case, or one is below {self.shortest:.2g} s")

    def begin(self, rate: float, scale: float) -> None:
        """Set the limits before the first window; see `Control.begin`."""
        self.limits["heat exchange"] = self.control.begin(rate, scale)

    def choose(self, time: float) -> float:
        """The time [s] at which the next window ends."""
        self._foresee(time)
        self.limit = min(self.limits, key=self.limits.get)
        return self.part(
            time, self.limits[self.limit], f"the window's limit {self.limit!r} ({KEYS.get(self.limit, 'an effect')})"
        )

    def _foresee(self, time: float) -> None:
        """Take note of gas that an inlet lets in faster up to the next landmark than at `time` [s]."""
        speed = inlets.quickened(self.case, time, self.next(time)) / (1.0 - packed(self.case))
        if speed:
            limit = self.courant * self.cell / speed
            self.limits["courant"] = min(limit, self.limits.get("courant", math.inf))

    def longest(self) -> float:
        """No window that `choose` picks next is longer [s]."""
        return min(self.limits.values())

    def thicken(self, dt: float, share: float, cause: str = "evaporation") -> None:
        """Take note that in `dt` [s] vapour came into a cell of gas, or oxidant was taken from it, that was `share` of
        what was there, or would at the rate of now; `cause` is one of MOST."""
        self.limits[cause] = dt * min(GROWTH, MOST[cause] / share) if share > 0.0 else math.inf

    def hold(self, grip: float) -> None:
        """Take note that gas that cannot give way stops grains that move as one at the rate `grip` [1/s]."""
        self.limits["grip"] = GRIP / grip if grip > 0.0 else math.inf

    def obey(self, limits: dict[str, float]) -> None:
        """Take note of the longest windows [s] that are borne now, by what bears them; inf where any is. What is one of
        MOST obeys what `thicken` was told of too."""
        both = {cause: min(limits[cause], self.limits.get(cause, math.inf)) for cause in MOST.keys() & limits.keys()}
        self.limits |= limits | both

    @property
    def idle(self) -> bool:
        """True as long as there was nothing to exchange."""
        return self.control.scale == 0.0

    def stake(self, heat: float) -> None:
        """There is `heat` [J] to exchange now."""
        self.control.scale = max(self.control.scale, heat)

    def learn(self, dt: float, heat: float, change: float, courant: float, fastest: float) -> None:
        """Set the limits from the window just done: `heat` and `change` as of `Control.learn`, courant of the gas,
        fastest particle [m/s]."""
        self.limits["particles"] = self.courant * self.cell / fastest if fastest > 0.0 else math.inf
        if "heat exchange" in self.limits:
            self.limits["heat exchange"] = self.control.learn(dt, heat, change)
        if courant > 0.0:
            self.limits["courant"] = dt * min(GROWTH, self.courant / courant)
        elif "courant" in self.limits:  # the gas has come to rest
            self.limits["courant"] *= GROWTH


def settling(case, pull: float, tau: float, speed: float) -> float:
    """Longest window [s] in which grains drift right that a force pulls by `pull` [m/s2] while drag stops them within
    `tau` [s]; `speed` [m/s] of what moves there.

    Drag and pull are held over a window. What the pull makes of velocity on the way there, dt/(2 tau) of tau pull and
    at most pull dt/2, is held to `run.accuracy` of the fastest of their drift, of what moves, and of a smoothing length
    in the run, as what is slower moves nothing.
    """
    felt = max(tau * pull, speed, case.smoothing_length / case.run.end_time)
    return 2.0 * case.run.accuracy * felt / pull if pull > 0.0 else math.inf


def smallest_cell(case) -> float:
    """Least width [m] of a gas cell."""
    return min(float(np.diff(edges).min()) for edges in cell_edges(case))


def packed(case) -> float:
    """Largest volume fraction of grains at the start."""
    return max((region.volume_fraction for region in case.particles.values()), default=0.0)


def opening(case) -> dict[str, float]:
    """Limits [s] of the first window from the speeds that the case gives: gas that is let in, as fast as it is between
    the grains, and grains that are thrown at the start or by a nozzle. Later windows are told what moves how fast."""
    let_in = max((b.fastest for b in case.boundaries.values()), default=0.0) / (1.0 - packed(case))
    thrown = (
        [math.hypot(*region.velocity) for region in case.particles.values() if region.velocity]
        if effects.moving(case)
        else []
    )
    if "inflow" in case.effects:
        thrown += [
            float(np.linalg.norm(streams_of(case, nozzle).velocity, axis=1).max(initial=nozzle.speed))
            for nozzle in case.nozzles.values()
        ]
    reach = case.coupling.courant * smallest_cell(case)
    return {
        cause: reach / speed for cause, speed in (("courant", let_in), ("particles", max(thrown, default=0.0))) if speed
    }
