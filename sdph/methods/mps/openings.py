"""Liquid that comes in through nozzles and leaves as whole pieces, each of which is told of.

A piece leaves where its middle is out of the domain and nothing of it is the sheet, the piece that hangs on a nozzle.
What hangs on it further than a domain's length beyond the end is cut off, and counted.
"""

from __future__ import annotations

import math

import numpy as np

from sdph.effects.around.outflow import open_sides
from sdph.effects.around.source import Source
from sdph.effects.around.streams import about
from sdph.engine import state as particles
from sdph.engine.state import INFLOW, LIQUID
from sdph.methods.mps import pieces, tanks

IN, OUT = 0, 1


class Openings:
    """Nozzles and open sides of a stepper; `passed` (2, 5): mass [kg], momentum (3) [kg m/s] and kinetic energy [J]
    that came in, and that left, since the start; `left` and `cut`: pieces that left, particles that were cut off."""

    KEPT = ("source", "passed", "left", "cut")  # see sdph.engine.kept

    def __init__(self, case, state):
        names = tanks.arrays(case)
        self.case, self.passed, self.left, self.cut = case, np.zeros((2, 5)), 0, 0
        self.source = Source(case, names, len(state.x)) if "inflow" in case.effects else None
        self.leave = "outflow" in case.effects
        self.told: list[dict] = []  # pieces that have left, until somebody has written them down

    def begin(self, state):
        """The state with the streams that wait at the start."""
        return self.source.fill(state, 0.0, 0.0) if self.source else state

    def move(self, state, time: float, dt: float) -> None:
        """Take the streams that wait from `time` [s] on by `dt` [s]: along, and around where they turn."""
        if not self.source:
            return
        rows, source = np.flatnonzero(state.kind == INFLOW), self.source
        gone = source.gone(time + dt) - source.gone(time)
        for k, nozzle in enumerate(source.nozzles):
            own = rows[state.nozzle[rows] == k + 1]
            if nozzle.shape == "annulus":
                self._turn(state, own, k, float(gone[np.searchsorted(source.of, k)]), dt)
            else:
                way = gone[source.stream(state, own)]
                for a, (place, speed) in enumerate(zip(particles.axes(state), (state.u, state.v, state.w))):
                    place[own] += way * source.axis[k, a]
                    speed[own] = way / dt * source.axis[k, a]

    def _turn(self, state, rows, k: int, way: float, dt: float) -> None:
        """Particles (n,) of an annulus go `way` [m] along its axis, on helices."""
        nozzle, axis = self.source.nozzles[k], self.source.axis[k]
        offsets = particles.positions(state)[rows] - nozzle.centre
        along = (offsets @ axis)[:, None] * axis
        angle = nozzle.swirl * way / np.linalg.norm(offsets - along, axis=1)
        moved = nozzle.centre + about(axis, offsets - along, angle) + along + way * axis
        velocity = (moved - particles.positions(state)[rows]) / dt
        for a, (place, speed) in enumerate(zip(particles.axes(state), (state.u, state.v, state.w))):
            place[rows], speed[rows] = moved[:, a], velocity[:, a]

    def renew(self, stepper) -> None:
        """Let go of what is through its mouth, fill up the streams, take out what has left."""
        if self.source:
            waiting = np.flatnonzero(stepper.state.kind == INFLOW)
            self.source.release(stepper.state)
            self._count(IN, stepper.state, waiting[stepper.state.kind[waiting] == LIQUID])
            stepper.replace(self.source.fill(stepper.state, stepper.time, 0.0))
        if self.leave:
            self._let_out(stepper)

    def _let_out(self, stepper) -> None:
        s, case = stepper.state, self.case
        out = beyond(case, s, 0.0)
        if not (out & (s.kind == LIQUID)).any():
            return
        label = pieces.labels(particles.positions(s), stepper.own.piece * case.resolution.spacing)
        held = np.zeros(label.max() + 1, bool)
        held[label[s.kind == INFLOW]] = True
        count = np.bincount(label)
        middle = np.bincount(label, weights=out * 1.0) > 0.5 * count  # the middle of most of it
        gone = (middle & ~held)[label]
        cut = beyond(case, s, 1.0) & (s.kind == LIQUID) & ~gone
        self.cut += int(cut.sum())
        self._tell(stepper, label, gone)
        if (gone | cut).any():
            self._count(OUT, s, np.flatnonzero(gone | cut))
            stepper.take(~(gone | cut))

    def _tell(self, stepper, label, gone) -> None:
        """Rows of the pieces that leave."""
        if gone.any():
            taken = particles.take(stepper.state, gone)
            found = pieces.of(taken, label[gone], self.case)
            self.told += [{"time_s": stepper.time} | row for row in found]
            self.left += len(found)

    def _count(self, way: int, state, rows) -> None:
        mass, velocity = state.mass[rows], particles.velocities(state)[rows]
        energy = 0.5 * mass @ np.einsum("ij,ij->i", velocity, velocity)
        self.passed[way] += np.concatenate(([mass.sum()], mass @ velocity, [energy]))


def beyond(case, state, share: float) -> np.ndarray:
    """Mask of the particles out of the domain through an open side, by `share` of its length or more; upstream of a
    nozzle nobody is out."""
    gone = np.zeros(len(state.x), bool)
    for axis, end in open_sides(case):
        place, size = particles.axes(state)[axis], case.domain.size[axis]
        gone |= place > (1.0 + share) * size if end else place < -share * size - math.ulp(0.0)
    return gone & (state.kind == LIQUID)
