"""Rigid sides: sides of the domain that bodies bounce off without friction.

    F = k (dx/2 - d)  for a particle nearer than half a spacing,  k = rho c^2 dx^(d-2)

a spring as stiff as the solid (as in sdph.engine.contact). Its energy comes back, the side takes the momentum.
"""

from __future__ import annotations

from typing import NamedTuple

from sdph.effects.effect import Effect
from sdph.engine.geometry import SIDES
from sdph.schema import CaseError, record, words


@record
class RigidSides:
    """Sides of the domain, by their names."""

    sides: tuple = words(())


class RigidSidesP(NamedTuple):
    """(axis, sign of the inward normal, place [m]) of each side."""

    planes: tuple


def kernel(case) -> RigidSidesP:
    own, there = case.parameters["rigid_sides"], list(SIDES)[: 2 * case.dimensions]
    named = (own.sides,) if isinstance(own.sides, str) else own.sides
    for name in named or ("",):
        if name not in there:
            raise CaseError(f"rigid_sides.sides holds {name!r}; allowed: {', '.join(there)}")
    return RigidSidesP(tuple((axis, 1 - 2 * end, end * case.domain.size[axis]) for axis, end in map(SIDES.get, named)))


def depths(p: RigidSidesP, axes, spacing: float) -> list[tuple]:
    """(axis, sign, how far particles are pressed into the side (N,) [m], above 0 where they are) of each side."""
    return [(axis, sign, 0.5 * spacing - sign * (axes[axis] - place)) for axis, sign, place in p.planes]


EFFECT = Effect(
    name="rigid_sides",
    summary="rigid sides of the domain",
    parameters=RigidSides,
    kernel=kernel,
    matter=("solid",),
)
