"""`sdph explain` of a tank: its volume and what the pools that fill it hold, so that a wrong mesh shows."""

from __future__ import annotations

from sdph.effects.around import tank
from sdph.engine.walls.shapes import Joined
from sdph.methods.liquids import filling


def rows(case) -> list[dict]:
    """A row for the tank without its outlet pipe, and one for each pool of the shape tank: volume, mass, and how high
    its surface lies, counted upwards; by the metre in two dimensions."""
    if "tank" not in case.effects:
        return []
    own = case.only("liquid") if len(case.matters) > 1 else case
    shape, spatial = tank.shape_of(own), case.dimensions == 3
    inside = shape.tank if isinstance(shape, Joined) else shape
    found, below = [("tank", inside.volume, "", "")], 0.0
    for name, pool in own.pools.items():
        if pool.shape != "tank":
            continue
        (level,) = filling.levels(inside, filling.upwards(own), (pool.fill,), own.resolution.spacing)
        held, phase = (pool.fill - below) * inside.volume, own.gas_phase if pool.phase == "gas" else own.liquid
        found.append((f"pools.{name}", held, phase.density * held, float(level)))
        below = pool.fill
    volume, mass = ("volume [m3]", "mass [kg]") if spatial else ("area [m2]", "mass [kg/m]")
    return [dict(zip(("of", volume, mass, "surface, upwards [m]"), row)) for row in found]
