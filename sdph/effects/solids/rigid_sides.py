"""Rigid sides: planes that bodies bounce off without friction: sides of the domain, or walls of a box tank.

    F = k (dx/2 - d)  for a particle nearer than half a spacing,  k = rho c^2 dx^(d-2)

a spring as stiff as the solid (as in sdph.engine.contact). Its energy comes back, the side takes the momentum. The
walls of a box tank hold bodies without this effect; with it those that it names do.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from sdph.effects.around import tank
from sdph.effects.effect import OFF, Effect
from sdph.engine.geometry import SIDES
from sdph.schema import CaseError, record, words


@record
class RigidSides:
    """Sides of the domain, or of a box tank, by their names."""

    sides: tuple = words(())


class RigidSidesP(NamedTuple):
    """(name, axis, sign of the inward normal, place [m]) of each side."""

    planes: tuple


def kernel(case) -> RigidSidesP:
    own, there = case.parameters["rigid_sides"], list(SIDES)[: 2 * case.dimensions]
    named = (own.sides,) if isinstance(own.sides, str) else own.sides
    if not named:
        raise CaseError(
            f"rigid_sides.sides is an empty list; it holds sides out of {', '.join(there)}: name some, or leave "
            "rigid_sides out of effects"
        )
    for name in named:
        if name not in there:
            raise CaseError(f"rigid_sides.sides holds {name!r}; allowed: {', '.join(there)}")
    return _planes(named, case.domain.corner, case.domain.upper)


def _planes(names, lower, upper) -> RigidSidesP:
    """Sides of a box from `lower` to `upper` (d,) [m]."""
    found = ((name, *SIDES[name]) for name in names)
    return RigidSidesP(tuple((name, axis, 1 - 2 * end, float((lower, upper)[end][axis])) for name, axis, end in found))


def beside(case):
    """Sides that hold bodies in a liquid: those that the case names, without any the walls of its box tank; OFF where
    it has neither."""
    own, given = case.parameters.get("tank"), "rigid_sides" in case.effects
    if own is None or own.shape != "box":
        return kernel(case) if given else OFF
    names = [name for name, *_ in kernel(case).planes] if given else tank.sides(case)
    return _planes(names, *tank.corners(case))


def warnings(case) -> list[str]:
    """A line where a tank's walls do not hold the bodies of a case."""
    own = case.parameters.get("tank")
    if not case.bodies or own is None or own.shape == "box":
        return []
    return [
        f"tank.shape = {own.shape!r} holds the liquid but no bodies: they pass through its walls; only a box holds "
        "them, and the sides of the domain that rigid_sides names"
    ]


class Sides:
    """Rigid sides of a run: planes, and numbers of the particles that each holds. What is clamped (`held_lower_m`)
    is not pushed, nor is a body by a side that its clamp lies behind."""

    def __init__(self, p, made, contact, names):
        self.contact, self.planes = contact, []
        for side, axis, sign, place in p.planes if p else ():
            behind = sign * (_axis(made.state, axis) - place) < 0.0
            through = np.unique(made.body[behind])
            for body in through:
                if not (behind & made.held & (made.body == body)).any():
                    raise CaseError(
                        f"bodies.{names[body]} reaches through the rigid side {side!r} at {'xyz'[axis]} = {place:g} m; "
                        "move it, or name the sides that are to hold bodies in rigid_sides.sides"
                    )
            self.planes.append((axis, sign, place, np.flatnonzero(~made.held & ~np.isin(made.body, through))))

    def press(self, state, acceleration) -> tuple[float, np.ndarray]:
        """Add the springs to accelerations (N, 3) [m/s2]; their energy [J] and force (3,) [N]."""
        energy, force, stiffness = 0.0, np.zeros(3), self.contact.stiffness
        for axis, sign, held, depth in self._depths(state):
            pressed, deep = held[depth > 0.0], depth[depth > 0.0]
            acceleration[pressed, axis] += sign * stiffness * deep / state.mass[pressed]
            energy += 0.5 * stiffness * float(deep @ deep)
            force[axis] += sign * stiffness * deep.sum()
        return energy, force

    def near(self, state) -> bool:
        """True where a particle is so near, within a spacing, that it may be pressed after the next step."""
        return any((depth > -0.5 * self.contact.spacing).any() for *_, depth in self._depths(state))

    def _depths(self, state):
        """(axis, sign, particles, how far each is pressed into the side [m], above 0 where it is) of each side."""
        for axis, sign, place, held in self.planes:
            yield axis, sign, held, 0.5 * self.contact.spacing - sign * (_axis(state, axis)[held] - place)


def _axis(state, axis: int) -> np.ndarray:
    return (state.x, state.y, state.z)[axis]


EFFECT = Effect(
    name="rigid_sides",
    summary="rigid sides of the domain, or of a box tank, for bodies",
    parameters=RigidSides,
    kernel=kernel,
    matter=("solid",),
)
