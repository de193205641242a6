"""Rows that `sdph explain` shows of several materials, each one alone in the gas, and of grains that touch."""

from __future__ import annotations

from sdph.effects.grains import conduction
from sdph.methods.grains.materials import fluidising
from sdph.methods.grains.scales import Scales

PACKED = "conduction over that of a packed bed"


def packed(s) -> list[tuple]:
    """Rows, as in `sdph.study.explain.tables.numbers`, of grains that touch."""
    what = "grains touch in points: conduction.law = 'zehner_schluender'"
    return [(PACKED, conduction.over_packed(s), 1.5, what, "Zehner & Schluender 1970")] if s.collides else []


def rows(case) -> list[dict]:
    """A row for each of several materials: Archimedes number, U_mf of a bed of it alone, as dense as that of all
    (Ergun), and the velocity at which a lone grain falls within the run (Gidaspow's drag)."""
    if not case.mixed:
        return []
    gas, found = case.gas, []
    for (name, grains), speed in zip(case.materials.items(), fluidising(case)):
        s = Scales(case.of_one(name))
        excess = gas.density * (grains.density - gas.density) * s.gravity
        found.append({
            "material": name, "density [kg/m3]": grains.density, "diameter [mm]": 1e3 * grains.diameter,
            "Archimedes": excess * grains.diameter**3 / gas.viscosity**2, "U_mf [m/s]": speed,
            "terminal velocity [m/s]": s.falling,
        })  # fmt: skip
    return found
