"""Liquid that comes in through nozzles and leaves as whole pieces, each of which is told of.

A piece leaves where its middle is out of the domain and nothing of it is the sheet, the piece that hangs on a nozzle.
What hangs on it further than a domain's length beyond the end is cut off, and counted.
"""

from __future__ import annotations

import functools
import math

import numpy as np
from numba import prange

from sdph.effects.around.outflow import open_sides
from sdph.effects.around.source import Source
from sdph.engine import arrays
from sdph.engine import state as particles
from sdph.engine.ledger import IN, OUT
from sdph.engine.state import INFLOW, LIQUID
from sdph.engine.world import ALONE
from sdph.laws.compiled import parallel
from sdph.methods.mps import alone, annulus, pieces, tanks


class Openings:
    """Nozzles and open sides of a stepper; `passed` (2, 5): mass [kg], momentum (3) [kg m/s] and kinetic energy [J]
    that came in, and that left, since the start; `left` and `cut`: pieces that left, particles that were cut off."""

    KEPT = ("source", "passed", "left", "cut")  # see sdph.engine.kept

    def __init__(self, case, state, world=ALONE):
        names = tanks.arrays(case)
        self.world = world
        self.case, self.passed, self.left, self.cut = case, np.zeros((2, 5)), 0, 0
        self.source = Source(case, names, len(state.x)) if "inflow" in case.effects else None
        self.leave = "outflow" in case.effects
        shapes = [nozzle.shape for nozzle in self.source.nozzles] if self.source else []
        self.annuli = {k: annulus.of_source(self.source, k) for k, shape in enumerate(shapes) if shape == "annulus"}
        self.told: list[dict] = []  # pieces that have left, until somebody has written them down

    def begin(self, state):
        """The state with the streams that wait at the start."""
        return self.source.fill(state, 0.0, 0.0) if self.source else state

    def move(self, state, time: float, dt: float) -> None:
        """Take the streams that wait from `time` [s] on by `dt` [s]: along, and around where they turn."""
        if not self.source:
            return
        source = self.source
        gone = source.gone(time + dt) - source.gone(time)
        for k, own in self.annuli.items():
            annulus.turn(own, state, float(gone[np.searchsorted(source.of, k)]), dt, *state[:6])
        if len(self.annuli) < len(source.nozzles):
            self._push(state, gone, dt)

    def _push(self, state, gone, dt: float) -> None:
        """Take the streams that do not turn along by their ways, gone (S,) [m]."""
        rows, source = np.flatnonzero(state.kind == INFLOW), self.source
        for k in set(range(len(source.nozzles))) - self.annuli.keys():
            own = rows[state.nozzle[rows] == k + 1]
            way = gone[source.stream(state, own)]
            for a, (place, speed) in enumerate(zip(particles.axes(state), (state.u, state.v, state.w))):
                place[own] += way * source.axis[k, a]
                speed[own] = way / dt * source.axis[k, a]

    def renew(self, stepper) -> None:
        """Let go of what is through its mouth, fill up the streams, take out what has left."""
        if self.source:
            s = stepper.domain.own(stepper.state)
            for own in self.annuli.values():
                self._pass(IN, annulus.let_go(own, s))
            if len(self.annuli) < len(self.source.nozzles):
                waiting = np.flatnonzero(s.kind == INFLOW)
                self.source.release(s)
                released = waiting[s.kind[waiting] == LIQUID]
                self._count(IN, particles.take(s, released))
            stepper.replace(self.source.fill(stepper.state, stepper.time, 0.0))
        if self.leave:
            self._let_out(stepper)

    def _let_out(self, stepper) -> None:
        s, case = stepper.state, self.case
        out = arrays.empty(len(s.x), s.x, np.bool_)
        if not self.world.any(beyond(s, *ends(case, 0.0), out)):
            return
        label, number = self._pieces(stepper)
        s = stepper.domain.own(stepper.state)
        out, far, gone, lost, kept = (arrays.empty(len(s.x), s.x, np.bool_) for _ in range(5))
        beyond(s, *ends(case, 0.0), out)
        beyond(s, *ends(case, 1.0), far)
        outside, waiting = (arrays.taken(label, rows) for rows in (arrays.chosen(out), alone.of_kind(s, INFLOW)))
        many = [self.world.sum(arrays.starts(own, number)) for own in (label, outside, waiting)]
        whole, cut = map(int, self.world.sum(np.array(leave(label, *many, far, gone, lost, kept))))
        self.cut += cut
        if whole:
            self._tell(stepper, s, label, arrays.chosen(gone))
        if whole or cut:
            self._count(OUT, particles.brought(particles.take(s, arrays.chosen(lost))))
            stepper.take(arrays.chosen(kept))

    def _pieces(self, stepper) -> tuple:
        """Number (N,) of the piece of each own particle, and how many numbers there may be."""
        distance = stepper.own.piece * self.case.resolution.spacing
        if stepper.domain.alone:  # on a device too
            return pieces.joined(particles.axes(stepper.state), distance), len(stepper.state.x)
        stepper.share()
        s = stepper.state
        label, number = pieces.labels(stepper.domain, s, np.arange(len(s.x)), distance)
        return stepper.domain.mine_of(label), number

    def _tell(self, stepper, s, label, rows) -> None:
        """Rows of the pieces that leave, of own particles (n,) of a state, of all processes."""
        taken = particles.brought(particles.take(s, rows))
        parts = self.world.everywhere((taken, arrays.brought(arrays.taken(label, rows))))
        states, labels = zip(*parts)
        found = pieces.of(functools.reduce(particles.join, states), np.concatenate(labels), self.case)
        self.told += [{"time_s": stepper.time} | row for row in found]
        self.left += len(found)

    def _pass(self, way: int, sums) -> None:
        """Add mass, momentum and energy of what passed, in all processes."""
        self.passed[way] += self.world.sum(np.array(sums))

    def _count(self, way: int, state) -> None:
        velocity = particles.velocities(state)
        energy = 0.5 * state.mass @ np.einsum("ij,ij->i", velocity, velocity)
        self._pass(way, np.concatenate(([state.mass.sum()], state.mass @ velocity, [energy])))


def ends(case, share: float) -> tuple[tuple, tuple]:
    """Lower and upper places (3,) [m] past which one is out of the domain through an open side, by `share` of its
    length or more; infinite where no side is open."""
    found = [-math.inf] * 3, [math.inf] * 3
    for axis, end in open_sides(case):
        low, high = case.domain.corner[axis], case.domain.upper[axis]
        past = share * (high - low)
        found[end][axis] = high + past if end else math.nextafter(low - past, -math.inf)
    return tuple(map(tuple, found))


@parallel
def beyond(s, lower, upper, out):
    """out (N,): liquid past these places; the number of it. Upstream of a nozzle nobody is out."""
    found = 0.0
    for i in prange(len(s.x)):
        past = s.x[i] < lower[0] or s.x[i] > upper[0] or s.y[i] < lower[1] or s.y[i] > upper[1]
        if len(s.z) > 0:
            past = past or s.z[i] < lower[2] or s.z[i] > upper[2]
        out[i] = past and s.kind[i] == LIQUID
        found += 1.0 if out[i] else 0.0
    return found


@parallel
def leave(label, many, outside, waiting, far, gone, lost, kept):
    """gone (N,): particles of whole pieces that leave: most of them is out, and none waits; lost (N,): these and what
    is far out; kept (N,): the others. Of each label (N,) there are as many, and as many outside, and that wait, as
    sdph.engine.arrays.starts has it. The number of those gone, and of the others that are lost."""
    whole = cut = 0.0
    for i in prange(len(label)):
        first, past = label[i], label[i] + 1
        most = outside[past] - outside[first] > 0.5 * (many[past] - many[first])
        gone[i] = most and waiting[past] == waiting[first]
        lost[i] = gone[i] or far[i]
        kept[i] = not lost[i]
        whole += 1.0 if gone[i] else 0.0
        cut += 1.0 if lost[i] and not gone[i] else 0.0
    return whole, cut
