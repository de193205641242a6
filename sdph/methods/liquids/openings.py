"""Liquid that comes in through nozzles and leaves through open sides.

A stream waits upstream of its mouth, moves at the nozzle's speed and has the pressure of the liquid in front, as a wall
has that moves (Adami, Hu & Adams 2012, Eq. 27, here for the liquid's own body force): a nozzle gives its speed, not a
pressure. Once through the mouth it is liquid (streams: sdph.effects.around.inflow). What is out of the domain through
an open side is taken out.
"""

from __future__ import annotations

import math

import numpy as np
from numba import prange
from scipy.spatial import cKDTree

from sdph import effects
from sdph.effects.around import outflow
from sdph.effects.around.source import Source
from sdph.effects.effect import OFF
from sdph.effects.liquids import shifting
from sdph.engine import kernels as smoothing
from sdph.engine import state as particles
from sdph.engine.geometry import apart
from sdph.engine.ledger import IN, OUT
from sdph.engine.rows import entry
from sdph.engine.state import INFLOW, LIQUID
from sdph.laws.compiled import parallel
from sdph.methods.liquids.equations import by_pair
from sdph.methods.liquids.forces import body
from sdph.methods.liquids.totals import specific_energies

FREE = (0.0, 0.0, 0.0)
NEAREST = 0.75  # spacings: liquid that stands nearer to what waits stands in its place; our choice


class Openings:
    """Nozzles and open sides of a stepper; `displaced`: particles of pools that gave way to streams; `passed` (2, 5):
    mass [kg], momentum (3) [kg m/s] and energy [J] that came in, and that left, since the start."""

    KEPT = ("source", "passed")  # see sdph.engine.kept

    def __init__(self, case, state):
        names = effects.arrays(case)
        self.case, self.passed = case, np.zeros((2, 5))
        self.source = Source(case, names, len(state.x)) if "inflow" in case.effects else None
        self.leave, self.displaced = "outflow" in case.effects, 0

    def begin(self, state):
        """The state with the streams that wait at the start; those of nozzles that open later stand still."""
        if not self.source:
            return state
        state = self._apart(self.source.fill(state, 0.0, 0.0))
        closed = np.flatnonzero(state.kind == INFLOW)
        closed = closed[self.source.start[state.nozzle[closed] - 1] > 0.0]
        for speed in (state.u, state.v, state.w)[: self.case.dimensions]:
            speed[closed] = 0.0
        return state

    def warnings(self) -> list[str]:
        """A line on liquid that a stream took the place of."""
        stood = "stood where streams wait upstream of their nozzles, and were left out"
        return [f"{self.displaced} particles of pools {stood}"] * bool(self.displaced)

    def _apart(self, state):
        """The state without the liquid in whose place a stream waits."""
        places, waits = particles.positions(state), state.kind == INFLOW
        if not waits.any():
            return state
        away, _ = cKDTree(places[waits]).query(places, distance_upper_bound=NEAREST * self.case.resolution.spacing)
        displaced = (state.kind == LIQUID) & np.isfinite(away)
        self.displaced = int(displaced.sum())
        return particles.take(state, ~displaced)

    def move(self, state, time: float, dt: float) -> None:
        """Take the streams that wait from `time` [s] on by `dt` [s]."""
        if not self.source:
            return
        waiting = np.flatnonzero(state.kind == INFLOW)
        nozzle, source = state.nozzle[waiting] - 1, self.source
        way = (source.gone(time + dt) - source.gone(time))[source.stream(state, waiting)]
        axis = source.axis[nozzle]
        for a, (place, speed) in enumerate(zip(particles.axes(state), (state.u, state.v, state.w))):
            place[waiting] += way * axis[:, a]
            speed[waiting] = way / dt * axis[:, a]

    def renew(self, stepper) -> None:
        """Let go of what is through its mouth, fill up the streams, take out what has left."""
        now = np.zeros((2, 5))
        if self.source:
            waiting = np.flatnonzero(stepper.state.kind == INFLOW)
            self.source.release(stepper.state)
            through = waiting[stepper.state.kind[waiting] == LIQUID]
            if len(through):
                now[IN] = _amounts(stepper, through)
                stepper.tell_apart()
            stepper.replace(self.source.fill(stepper.state, stepper.time, 0.0))
        gone = outflow.left(self.case, stepper.state) if self.leave else np.zeros(0, bool)
        if gone.any():
            now[OUT] = _amounts(stepper, np.flatnonzero(gone))
            stepper.leave(~gone)
        self.passed += stepper.world.sum(now)


def _amounts(stepper, rows) -> np.ndarray:
    """(5,) mass [kg], momentum (3) [kg m/s] and energy [J] of the own particles among `rows` (n,)."""
    s = stepper.state
    rows = rows[s.copy[rows] == 0] if len(s.copy) else rows
    mass, velocity = s.mass[rows], particles.velocities(s)[rows]
    return np.concatenate(([mass.sum()], mass @ velocity, [mass @ sum(specific_energies(stepper, rows))]))


@parallel
def meet(
    kernel, s, rows, box, waiting, gravity_p, frame_p, liquid, pressure, volume, density, gradient, enclosure,
):  # fmt: skip
    """Pressure [Pa], and what follows from it, of the particles that wait: that of the liquid in front, 0 without any.

    liquid (5,): column of the liquid in `sdph.methods.liquids.start.fluids`; density (N,) is s.density once more, as
    an output. The gradient of pressure is that of liquid that is not accelerated.
    """
    for n in prange(len(waiting)):
        i = waiting[n]
        bx, by, bz = body(gravity_p, frame_p, s, i, False)
        weight = push = 0.0
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            if s.kind[j] != LIQUID:
                continue
            dx, dy, dz = apart(s, box, i, j)
            value = smoothing.value(kernel, math.sqrt(dx * dx + dy * dy + dz * dz))
            weight += value
            push += value * (pressure[j] + s.density[j] * (bx * dx + by * dy + bz * dz))
        pressure[i] = push / weight if weight > 0.0 else 0.0
        density[i] = liquid[0] * (1.0 + (pressure[i] - liquid[3]) / liquid[1]) ** (1.0 / liquid[2])
        volume[i] = s.mass[i] / density[i]
        gradient[i, 0], gradient[i, 1], gradient[i, 2] = density[i] * bx, density[i] * by, density[i] * bz
        if len(enclosure):
            enclosure[i] = 1.0


def wait(stepper, around) -> None:
    """Give what waits the pressure of the liquid in front; `around` is what the loops of a stepper take."""
    s, p = stepper.state, stepper.p
    if len(stepper.waiting):
        meet(
            *around, stepper.waiting, p["gravity"], stepper.frame, stepper.fluids[:, LIQUID], stepper.pressure,
            stepper.volume, s.density, stepper.gradient, s.enclosure,
        )  # fmt: skip
    stepper.domain.refresh(stepper.pressure, stepper.volume, s.density, s.enclosure)


@parallel
def press(
    kernel, s, rows, box, flow, wall_p, laminar_p, damping_p, shifting_p, phases_p, excess, waiting, gain, given,
):  # fmt: skip
    """given (n, 4) by each particle that waits: force (3 columns) [N] on the liquid, and power [W] of pressure, with
    the velocities that the liquid has after a gain (N, 3) [m/s].

    Of a pair V_i V_j (dW/dr)/r [p_j v_i.r + p_i v_j.r]: what the motion of i gains and what its compression does.
    """
    for n in prange(len(waiting)):
        j = waiting[n]
        fx = fy = fz = power = 0.0
        for k in range(rows.number[j]):
            i = entry(rows, j, k)
            if s.kind[i] != LIQUID:
                continue
            V, p_i = flow.volume[i], flow.pressure[i]
            own = shifting.sign(shifting_p, p_i, flow.enclosure[i] if len(flow.enclosure) else 1.0) * p_i
            px, py, pz, share, _, dx, dy, dz = by_pair(
                kernel, s, box, flow, wall_p, laminar_p, damping_p, phases_p, excess, i, j, own, FREE
            )
            fx += V * px
            fy += V * py
            fz += V * pz
            w_i, w_j = (s.w[i] + gain[i, 2], s.w[j]) if len(s.w) else (0.0, 0.0)
            parting = (s.u[i] + gain[i, 0]) * dx + (s.v[i] + gain[i, 1]) * dy + w_i * dz
            following = s.u[j] * dx + s.v[j] * dy + w_j * dz
            power -= V * share * (flow.pressure[j] * parting + p_i * following)
        given[n, 0], given[n, 1], given[n, 2], given[n, 3] = fx, fy, fz, power


def given(stepper, ahead: float) -> tuple[np.ndarray, np.ndarray, float]:
    """Force (3,) [N], moment (3,) about the origin [N m] and power [W] of what waits on the liquid; `ahead` [s] of a
    kick."""
    waiting, p = stepper.waiting, stepper.p
    found = np.zeros((len(waiting), 4))
    press(
        stepper.kernel, stepper.state, stepper.rows, stepper.neighbours.box, stepper.flow, stepper.wall,
        stepper.viscous, p["liquid_damping"], p["shifting"], stepper.phases, stepper.excess or OFF, waiting,
        ahead * stepper.acceleration, found,
    )  # fmt: skip
    places = particles.positions(stepper.state)[waiting]
    return found[:, :3].sum(axis=0), np.cross(places, found[:, :3]).sum(axis=0), float(found[:, 3].sum())
