"""Weber numbers of droplets, with the speed and the size that each is of."""

from __future__ import annotations

import math

import numpy as np

from sdph.effects.around import drops

WHOLE, SOURCE = 12.0, "Pilch & Erdman 1987"
THROWN = "as they begin"
MEANING = "droplets break up: that is the effect break_up"


def rows(s) -> list[tuple]:
    """Rows, as in `sdph.study.explain.tables.numbers`: of the drops that are the likeliest to break, and of those of
    tables."""
    drop = s.breaking
    value = s.gas.density * drop.slip**2 * drop.diameter / s.grains.surface_tension
    fastest = "drops across gas that comes in" if drop.across else _fastest(s)
    of = f"of {1e3 * drop.diameter:.3g} mm at {drop.slip:.3g} m/s, {fastest}"
    tables = [(name, own) for name, own in s.case.nozzles.items() if own.table]
    return [("Weber", value, WHOLE, f"{MEANING}; {of}", SOURCE), *(_of_table(s, *pair) for pair in tables)]


def _fastest(s) -> str:
    """Words on what has the largest slip of a case, and at which time."""
    speeds = {
        "gas that comes in": s.jet, THROWN: s.thrown, "their fall": s.falling, "gas that they give off": s.rush,
        "eddies of the gas": s.eddies,
    }  # fmt: skip
    first, nozzles = max(speeds, key=speeds.get), s.case.nozzles
    begun = max((math.hypot(*(own.velocity or ())) for own in s.case.particles.values()), default=0.0)
    if first != THROWN or begun >= s.thrown or not nozzles:
        return first
    name = max(nozzles, key=lambda one: nozzles[one].speed)
    return _of_nozzle(name, nozzles[name])


def _of_nozzle(name: str, nozzle) -> str:
    """The same of a nozzle. Rates against time leave its speed as it is, and drops of a table have their own."""
    if nozzle.rates:
        return f"nozzles.{name}, as fast at all times of its rates"
    return f"nozzles.{name}" + (", not of its table's drops" if nozzle.shape == "table" else "")


def _of_table(s, name: str, nozzle) -> tuple:
    """A row of the drop of a table with the largest number, in gas at rest."""
    own = drops.read(nozzle.table)
    speed = np.linalg.norm(own.velocity, axis=1)
    value = s.gas.density * speed**2 * own.diameter / s.grains.surface_tension
    k = int(np.argmax(np.where(own.time > nozzle.table_from, value, 0.0)))
    of = f"its drop at {own.time[k]:.4g} s, of {1e3 * own.diameter[k]:.3g} mm at {speed[k]:.3g} m/s"
    return (f"Weber, largest of nozzles.{name}.table", float(value[k]), WHOLE, f"{MEANING}; {of}", SOURCE)
