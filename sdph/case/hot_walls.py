"""Walls that have a temperature in a case without the effect that brings it to grains."""

from __future__ import annotations

from sdph.engine.walls.faces import temperatures

FELT = "the gas feels the temperature of these walls, grains with wall_heat in effects alone"


def warnings(case) -> list[str]:
    """A line that names boundaries with a temperature that no grains feel; none where all in the case are as warm."""
    if "grains" not in case.matters or "wall_heat" in case.effects:
        return []
    hot = temperatures(case)
    return [f"boundaries {', '.join(hot)}: {FELT}"] if hot and len(set(case.temperatures)) > 1 else []
