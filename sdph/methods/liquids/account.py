"""Forces [N] on a liquid now, by cause, and the power [W] with which they work on it or take from it.

The last evaluation of the forces made accelerations from velocities of half a step before; a kick of half a step
follows. So forces are those that act, and powers are taken with the velocities after the kick: an acceleration acts
half a step before and half a step after them, and the trapezoidal rule over the steps is what the kicks do.

Walls are summed over their particles and what is outside over the liquid's, every step. What pairs of the liquid lose
(sdph.methods.liquids.losses) takes a loop over all pairs, as long as that of the forces: it is looked at in one step of
EVERY, holds until the next look, and is made up for then (trapezoidal rule between looks): what a liquid loses as a
whole changes over many steps.
"""

from __future__ import annotations

import numpy as np

from sdph.engine import arrays
from sdph.engine import state as particles
from sdph.methods.liquids import correction, equations, loads, losses, openings, walls

EVERY = 32  # steps; our choice: 2 % of the time of a step

# places in what `rates` returns
LOADS, BODY, GRAVITY, FRAME = slice(0, 6), slice(6, 9), 9, 10
WALLS, BY_WALLS, HELD_OFF = slice(11, 14), 14, 15
TENSION, BY_TENSION = slice(16, 19), 19
INLET, BY_INLET = slice(20, 23), 23
LOST = slice(24, 24 + len(losses.CAUSES))
BUBBLE, BY_BUBBLE = slice(LOST.stop, LOST.stop + 3), LOST.stop + 3
CONTROL, BY_CONTROL = slice(BY_BUBBLE + 1, BY_BUBBLE + 4), BY_BUBBLE + 4
SINCE = BY_CONTROL + 1  # time [s] since the last look
SIZE = SINCE + 1


def rates(stepper, ahead: float, last: np.ndarray | None) -> np.ndarray:
    """(SIZE,) of now, before a kick by `ahead` [s], and what pushes named parts of the tank, nine numbers each
    (sdph.methods.liquids.parts); `last` is what was told in the step before, None where nothing."""
    now, felt = np.zeros(SIZE), np.zeros((0, 8))
    now[: FRAME + 1] = loads.balance(stepper, ahead)
    if len(stepper.walls):
        felt = walls.feel(stepper, stepper.walls, ahead)
        whole = arrays.total(felt)
        now[WALLS], now[BY_WALLS : HELD_OFF + 1] = -whole[:3], whole[3:5]
    if stepper.bodies:
        own = stepper.active
        of_bodies = stepper.bodies.among(stepper.walls)
        now[WALLS] = -felt[~of_bodies, :3].sum(axis=0)
        now[LOADS] -= loads.of_forces(stepper, stepper.walls[of_bodies], felt[of_bodies, :3])  # they are no tank
        now[LOADS] += loads.of_forces(stepper, own, stepper.bodies.pressed[own])
    if stepper.p["surface_tension"]:
        pull = stepper.state.mass[:, None] * stepper.tightening
        velocity = particles.velocities(stepper.state) + ahead * stepper.acceleration
        now[TENSION], now[BY_TENSION] = pull.sum(axis=0), (pull * velocity).sum()
    if stepper.void:
        push = stepper.state.mass[:, None] * stepper.inflating
        velocity = particles.velocities(stepper.state) + ahead * stepper.acceleration
        now[BUBBLE], now[BY_BUBBLE] = push.sum(axis=0), (push * velocity).sum()
        now[LOADS] += loads.of_forces(stepper, np.arange(len(push)), push)  # the bubble is no tank
    if len(stepper.waiting):
        now[INLET], moment, now[BY_INLET] = openings.given(stepper, ahead)
        now[LOADS] += np.concatenate((now[INLET], moment))  # what waits is no tank
    if stepper.p["shifting"] and stepper.p["shifting"].tension:
        made = _unreturned(stepper, ahead)
        now[CONTROL], now[BY_CONTROL] = made[:3], made[6]
        now[LOADS] += made[:6]  # what no tank gives
    looks = last is None or (ahead and stepper.steps % EVERY == 0)
    if looks:
        now[LOST] = _lost(stepper, ahead)
    now = np.append(now, stepper.parts.pushed(stepper, felt)) if stepper.parts else now
    now = stepper.world.sum(now)
    if not looks:
        now[LOST], now[SINCE] = last[LOST], last[SINCE] + 2.0 * ahead
    return now


def between(before: np.ndarray, now: np.ndarray, dt: float) -> np.ndarray:
    """Integral [N s], [J] of `rates` over a step of `dt` [s]; a look makes up for what held since the one before."""
    sums = 0.5 * dt * (before + now)
    if now[SINCE] == 0.0:
        sums[LOST] += 0.5 * before[SINCE] * (now[LOST] - before[LOST])
    return sums


def _unreturned(stepper, ahead: float) -> np.ndarray:
    """(7,) force [N] by which control of tension pushes and is not pushed back, its moment [N m], and the power [W] it
    takes."""
    made = arrays.zeros((len(stepper.state.x), 7), stepper.state.x)
    equations.unreturned(
        stepper.kernel, stepper.state, stepper.rows, stepper.neighbours.box, stepper.flow, stepper.p["shifting"],
        stepper.excess, arrays.times(ahead, stepper.acceleration), made,
    )  # fmt: skip
    return arrays.total(made)


def _lost(stepper, ahead: float) -> tuple:
    """Power [W] that pairs lose by the causes of sdph.methods.liquids.losses."""
    p = stepper.p
    return losses.losses(
        stepper.kernel, stepper.state, stepper.rows, stepper.neighbours.box, stepper.flow, stepper.wall,
        stepper.viscous, p["liquid_damping"], () if stepper.summed else p["density_diffusion"],
        stepper.phases, () if correction.of_continuity(stepper) else stepper.excess, stepper.gradient,
        stepper.acceleration, stepper.moving, ahead,
    )  # fmt: skip
