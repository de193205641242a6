"""Loads of a liquid on its tank: forces and moments, by what is outside and by what the walls feel; energies of
motion."""

from __future__ import annotations

import numpy as np

from sdph.effects.around import tank
from sdph.engine import arrays, ashore
from sdph.engine import state as particles
from sdph.engine.walls import shapes
from sdph.methods.liquids import walls


def loads(stepper) -> np.ndarray:
    """(6,) force [N] and moment about the origin [N m] of the liquid on the tank: what acts on the liquid from outside,
    less what its momentum gains."""
    return balance(stepper)[:6]


def balance(stepper, ahead: float = 0.0) -> np.ndarray:
    """(11,) the same, then the force (3) [N] of gravity and of the frame's motion and the power [W] of each, with the
    velocities that the accelerations lead to in `ahead` [s]."""
    p, found = stepper.p, (stepper.state, stepper.active)
    return np.array(walls.reaction(*found, p["gravity"], stepper.frame, stepper.acceleration, ahead))


def wall_loads(stepper, chosen=None) -> np.ndarray:
    """(6,) the same, from what each wall particle feels of pressure and friction; of the wall particles `chosen` alone,
    if given."""
    chosen = stepper.walls if chosen is None else chosen
    if stepper.bodies:
        chosen = chosen[~stepper.bodies.among(chosen)]
    s = stepper.state
    stepper.domain.refresh(s.u, s.v, s.w)  # copies have those of before the last kick
    felt, chosen = (arrays.brought(own) for own in (walls.feel(stepper, chosen, 0.0), chosen))
    with ashore.ashore(stepper):
        return stepper.world.sum(of_forces(stepper, chosen, felt[:, :3]))


def of_forces(stepper, chosen, force) -> np.ndarray:
    """(6,) sum of forces (W, 3) [N] on the particles `chosen` (W,), and of their moments about the origin."""
    places = particles.positions(stepper.state)[chosen]
    return np.concatenate([force.sum(axis=0), np.cross(places, force).sum(axis=0)])


def pipe_loads(stepper) -> np.ndarray:
    """(6,) the same on the outlet pipe, and on what leaves through it."""
    number, own = stepper.state.ident[stepper.walls], stepper.own_walls
    return wall_loads(stepper, stepper.walls[(number < own.start) | (number >= own.stop)])


def pipe_energy(stepper) -> float:
    """Kinetic energy [J] of the liquid in the outlet pipe; 0 where there is none."""
    shape = tank.shape_of(stepper.case)
    if not isinstance(shape, shapes.Joined):
        return 0.0
    wet = particles.take(stepper.state, stepper.active)
    return kinetic_energy(particles.take(wet, shape.tank.distance(np.stack(particles.axes(wet), axis=1)) > 0.0))


def kinetic_energy(state) -> float:
    """Kinetic energy of the liquid [J], per metre of depth in two dimensions."""
    speed2 = (particles.velocities(state) ** 2).sum(axis=1)
    return float(0.5 * (state.mass * speed2)[particles.wet(state)].sum())
