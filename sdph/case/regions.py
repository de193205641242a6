"""Checks of the regions that grains fill; each raises a CaseError: what was given, and what is allowed."""

from __future__ import annotations

from sdph.engine import regions
from sdph.engine.walls.outline import outline
from sdph.schema import CaseError

NEEDS = {
    "box": ("lower", "upper"), "disc": ("centre", "radius"), "sphere": ("centre", "radius"),
    "cylinder": ("centre", "radius", "length"), "cone": ("centre", "radius", "end_radius", "length"),
    "outline": ("corners",), "mesh": ("mesh",), "walls": (),
}  # fmt: skip
KEYS = {"mesh": "mesh"}  # of a case file, where they end on no unit
SPACE = ("cylinder", "cone", "mesh")  # shapes of three dimensions


def check(case, where: str, region) -> None:
    """A region has what its shape needs, and a level only where that is known; grains fit into what it asks for."""
    for name in NEEDS[region.shape]:
        if not getattr(region, name) and getattr(region, name) != 0.0:
            needs = " and ".join(KEYS.get(n, f"{n}_m") for n in NEEDS[region.shape])
            raise CaseError(f"{where}.{KEYS.get(name, f'{name}_m')} is missing; a {region.shape} needs {needs}")
    if region.shape in SPACE and case.dimensions != 3:
        raise CaseError(
            f"{where}.shape = {region.shape!r} is of three dimensions; in two give a box, a disc, an outline, or the "
            "walls"
        )
    if region.shape == "outline" and case.dimensions != 2:
        raise CaseError(f'{where}.shape = "outline" is of two dimensions; in three give a mesh, or another shape')
    if region.shape == "outline":
        outline(f"{where}.corners_m", region.corners)
    if region.shape == "walls" and "walls" not in case.effects:
        raise CaseError(f'{where}.shape = "walls" is what the walls enclose; add walls to effects')
    if region.shape == "cone" and not max(region.radius, region.end_radius) > 0.0:
        raise CaseError(f"{where}: a cone needs a radius above 0 at one end")
    _check_level(case, where, region)
    if region.volume_fraction > case.grains.packing_limit:
        given = f"{where}.volume_fraction = {region.volume_fraction:g}"
        raise CaseError(
            f"{given}; grains pack to grains.packing_limit = {case.grains.packing_limit:g} at most: lower the one or "
            "raise the other"
        )


def _check_level(case, where: str, region) -> None:
    if region.height is not None and region.mass is not None:
        raise CaseError(f"{where} has height_m and mass_kg; either is a level: give one")
    level = "height_m" if region.height is not None else "mass_kg" if region.mass is not None else ""
    if level and not any(case.domain.gravity):
        raise CaseError(
            f"{where}.{level} is a level from below, and domain.gravity_m_s2 = {list(case.domain.gravity)} tells of no "
            "below: give gravity, or leave it out"
        )


def extents(case, region):
    """Lower and upper corner [m] of the box around a region whose place the case file tells; None where a mesh does."""
    if region.shape in ("mesh", "walls"):
        return None
    return regions.bounds(region, None, case.dimensions)
