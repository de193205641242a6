"""Heat that grains and droplets exchange while nozzles feed them, for estimates of windows: `Window.learn` is told of
it as a run tells it.

A run holds the change of every particle's rate of heat in a window, over the heat that there is to exchange. Of what
a nozzle feeds at a constant rate there is C t to exchange after the time t. Each second's share gives its heat at the
rates of

- the grains, 1/(heat time), and
- the gas among them, 1/(its heat time), thinned out as a cone spreads on half of its way, and as gas draws them apart
  that flows faster; gas that is passed faster than that is met anew once in 2 h and a cell, as far as a particle
  reaches: no rate is above speed/(2 h + cell).

So what is exchanged is (1 - exp(-r t)) C, and changes at the sum r of the two rates. A jet that does not spread meets
new gas at its rim, as thick as the gas takes to follow it or as the kernel resolves, until its grains are as warm as
that. What has gone out has nothing more to exchange: t is at most as long as grains stay. These are estimates: the
rates are those of the speed at the mouth, and how gas and droplets mix is not known before the run.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from sdph.effects.around import rates, sizes
from sdph.effects.around.streams import streams_of
from sdph.exchange.window import SAFETY, smallest_cell
from sdph.methods.grains.scales import scales_of


class Feed:
    """Feed of the nozzle of a case that has one, with scales `s`, in units of the heat of a second of it."""

    def __init__(self, case, s):
        (nozzle,) = case.nozzles.values()
        angle = math.tan(nozzle.half_angle)
        way = min(s.thrown * s.coasting, *case.domain.size)
        thinned = (s.length / (s.length + way * angle)) ** (case.dimensions - 1)
        thinned *= min(1.0, s.thrown / speed(case, s))  # gas that carries them off draws them apart
        reach = 2.0 * case.smoothing_length + smallest_cell(case)
        renewed = min(thinned / s.gas_heat_time, s.thrown / reach)
        self.rate = 1.0 / s.heat_time + renewed  # r [1/s]
        thick = 2.0 * max(s.thrown * s.gas_drag_time, case.smoothing_length)
        self.rim = 0.0 if angle else renewed * min(1.0, thick / s.length)  # [1/s]
        self.warm, self.stay = s.heat_time, staying(case, s)  # s
        # a particle is in the gas once the middle of its layer is past the mouth
        self.start = nozzle.start + 0.5 * case.resolution.spacing / nozzle.speed
        self.end, self.rates = nozzle.end or case.run.end_time, nozzle.rates
        self.windows = 0  # that exchanged any

    def stake(self, time: float) -> float:
        """Heat to exchange at a time [s]; of a rate against time, in units of a second of its largest."""
        if self.rates:
            before, passed = rates.passed(self.rates, np.array([self.start, min(time, self.end)]))
            fed = float(passed - before) / max(rate for _, rate in self.rates)
        else:
            fed = min(time, self.end) - self.start
        return min(max(0.0, fed), self.stay)

    def share(self, fed: float) -> float:
        """Heat that was exchanged at a time at which so much was fed, of a second's."""
        return -math.expm1(-self.rate * fed) - self.rim * self.warm * math.expm1(-fed / self.warm)

    def window(self, time: float, dt: float) -> tuple[float, float]:
        """Heat that a window of `dt` [s] from a time [s] exchanges, and the change of its rate since the last one."""
        fed, flow = self.stake(time), 0.0
        if fed > 0.0:
            flow = self.share(fed) * math.exp(-self.rate * max(0.0, time - self.end))
            self.windows += 1
        change = flow * -math.expm1(-self.rate * dt) if self.windows > 1 else 0.0
        return flow * dt, change

    def under_way(self, least: float, tolerance: float) -> bool:
        """True once there was a window with a change of the rate, as what holds later ones is longer from then on; or
        where `least` [s], of other limits, is below all that the heat asks for, as of a share that is r t at most."""
        return self.windows > 2 or least < SAFETY * math.sqrt(tolerance) / self.rate

    def longest(self, tolerance: float) -> float:
        """Window [s] that the heat allows half-way."""
        fed = 0.5 * self.stake(self.end)
        return SAFETY * math.sqrt(2.0 * tolerance * fed / (self.share(fed) * self.rate)) if fed > 0.0 else math.inf


class Feeds:
    """Feeds of the nozzles of a case, each by its share of the heat [W] that all bring to exchange: droplets of one may
    be far finer than those of another."""

    def __init__(self, case):
        own = [(one, scales_of(one)) for one in apart(case)]
        self.feeds = [Feed(one, s) for one, s in own]
        heat = [brought(one) * s.span for one, s in own]
        self.shares = [part / sum(heat) for part in heat]

    def stake(self, time: float) -> float:
        """Heat to exchange at a time [s], of all feeds by their shares."""
        return sum(share * one.stake(time) for share, one in zip(self.shares, self.feeds))

    def window(self, time: float, dt: float) -> tuple[float, float]:
        """Heat that a window of `dt` [s] from a time [s] exchanges, and change of its rate, of all by their shares."""
        found = [one.window(time, dt) for one in self.feeds]
        return tuple(sum(share * own[n] for share, own in zip(self.shares, found)) for n in (0, 1))

    def under_way(self, least: float, tolerance: float) -> bool:
        """True once every feed that brings heat is under way (`Feed.under_way`)."""
        return all(one.under_way(least, tolerance) for share, one in zip(self.shares, self.feeds) if share)

    def longest(self, tolerance: float) -> float:
        """Window [s] that the heat of the quickest feed allows half-way."""
        return min(one.longest(tolerance) for share, one in zip(self.shares, self.feeds) if share)


def apart(case) -> list:
    """The case with each of its nozzles alone, and with its regions alone where it has some."""
    found = [replace(case, nozzles={name: own}, particles={}) for name, own in case.nozzles.items()]
    return found + ([replace(case, nozzles={})] if case.particles else [])


def brought(case) -> float:
    """Heat capacity [W/K] that the nozzle of a case that has one brings, at its largest rate."""
    (nozzle,) = case.nozzles.values()
    streams = streams_of(case, nozzle)
    rate = rates.largest(nozzle) or streams.mass / streams.pitch * float(streams.speed.sum())
    return rate * case.of(nozzle.material).heat_capacity


def incoming(case) -> tuple[int, float]:
    """Particles that nozzles bring and that are there at once, at most, and on average over the run: those go that have
    gone through the domain, at their mean speed."""
    most, mean, end = 0.0, 0.0, case.run.end_time
    for one in apart(case)[: len(case.nozzles)]:
        (nozzle,), s = one.nozzles.values(), scales_of(one)
        pace = paced(one, nozzle)
        stay = staying(one, s)
        first, last = nozzle.start, nozzle.start + lasting(one, nozzle)
        leaves = min(last, max(first, end - stay))  # who comes later is still there at the end
        most += pace * min(stay, lasting(one, nozzle))
        there = (leaves - first) * stay if leaves > first else 0.0
        mean += pace * (there + 0.5 * ((end - leaves) ** 2 - (end - last) ** 2)) / end
    return math.ceil(most), mean


def paced(case, nozzle) -> float:
    """Particles that a nozzle brings in a second [1/s]."""
    return layer(case, nozzle) * nozzle.speed / case.resolution.spacing


def brought_in(case) -> int:
    """Particles that nozzles bring in all of the run."""
    own = ((one, nozzle) for one in apart(case)[: len(case.nozzles)] for nozzle in one.nozzles.values())
    return math.ceil(sum(paced(one, nozzle) * lasting(one, nozzle) for one, nozzle in own))


def staying(case, s) -> float:
    """Time [s] in which grains of scales `s` go through the domain; inf where they cannot leave it."""
    return max(case.domain.size) / speed(case, s) if "outflow" in case.effects and speed(case, s) > 0.0 else math.inf


def speed(case, s) -> float:
    """Mean speed [m/s] of grains of scales `s`, all that moves them counted."""
    return s.thrown * s.coasting / case.run.end_time + s.falling + s.blown


def lasting(case, nozzle) -> float:
    """Time [s] of a run for which a nozzle is open."""
    return max(0.0, min(nozzle.end or case.run.end_time, case.run.end_time) - nozzle.start)


def layer(case, nozzle) -> float:
    """Particles that a nozzle is wide."""
    places = mouth(case, nozzle) / case.resolution.spacing ** (case.dimensions - 1)
    return len(sizes.of_nozzle(case, nozzle).share) * places


def mouth(case, nozzle) -> float:
    """[m] or [m2] that a nozzle is wide."""
    radius = nozzle.radius or 0.0
    if nozzle.shape == "slot":
        return math.prod((nozzle.width or 0.0, nozzle.length or 0.0)[: case.dimensions - 1])
    return 2.0 * radius if case.dimensions == 2 else math.pi * (radius**2 - (nozzle.inner_radius or 0.0) ** 2)


def way(case, nozzle) -> float:
    """Way [m] that a stream goes, to the end of the run or of the domain."""
    through = max(case.domain.size) if "outflow" in case.effects else math.inf
    return min(nozzle.speed * lasting(case, nozzle), through)


def of(case, s) -> Feeds | None:
    """The feed of a case of nozzles alone that exchanges heat both ways."""
    if not case.nozzles or case.particles or "heat" not in case.effects or case.coupling.one_way or not s.thrown:
        return None
    return Feeds(case) if s.span else None
