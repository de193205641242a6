"""Rows that `sdph explain` shows of several materials, each one alone in the gas, and of grains that touch."""

from __future__ import annotations

from sdph.effects.gas import drag
from sdph.effects.grains import conduction
from sdph.methods.grains import start
from sdph.methods.grains.materials import fluidising
from sdph.methods.grains.scales import Scales

PACKED, SPREAD = "conduction over that of a packed bed", "heat spread by cells over conduction"
MOMENT = 0.3  # of h_c^2: second moment along an axis of the kernel between particles and cells, 31/98 in 2-D


def touching(s) -> list[tuple]:
    """Rows, as in `sdph.study.explain.tables.numbers`, of grains that touch: what they conduct, and what exchange with
    cells spreads besides (docs/theory/grains.md)."""
    if not s.collides:
        return []
    what = "grains touch in points: conduction.law = 'zehner_schluender'"
    wide = max(s.case.smoothing_length, s.case.resolution.cell)
    conducted = conduction.conductivity(s.case, s.alpha_p) / (s.grains.density * s.grains.heat_capacity)
    spread = MOMENT * wide**2 / s.heat_time / conducted
    return [
        (PACKED, conduction.over_packed(s), 1.5, what, "Zehner & Schluender 1970"),
        (SPREAD, spread, 1.0, "exchange with cells spreads more heat than grains conduct", "measured, packed steel"),
    ]


def rows(case) -> list[dict]:
    """A row for each of several materials: Archimedes number, U_mf of a bed of it alone, as dense as that of all
    (Ergun), and the velocity at which a lone grain falls in the end (Schiller & Naumann)."""
    if not case.mixed:
        return []
    gas, found = case.gas, []
    for (name, grains), speed in zip(case.materials.items(), fluidising(case)):
        s = Scales(case.of_one(name))
        excess = gas.density * (grains.density - gas.density) * s.gravity
        found.append({
            "material": name, "density [kg/m3]": grains.density, "diameter [mm]": 1e3 * grains.diameter,
            "Archimedes": excess * grains.diameter**3 / gas.viscosity**2, "U_mf [m/s]": speed,
            "terminal velocity [m/s]": drag.terminal(s),
        })  # fmt: skip
    return found


def filled(case, masses: dict[str, float]) -> list[dict]:
    """A row for each region: the mass of its particles at the start, of `masses` by name, and that which it is given,
    `start.meant`; in two dimensions by the metre."""
    unit = "kg" if case.dimensions == 3 else "kg/m"
    return [
        {"region": name, f"mass [{unit}]": mass, f"given [{unit}]": start.meant(case, case.particles[name])}
        for name, mass in masses.items()
    ]
