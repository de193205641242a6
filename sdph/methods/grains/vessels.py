"""A surface mesh that is the walls of grains, looked at before grains stand in it: where it is open, and which of its
sides they are on."""

from __future__ import annotations

import math

from sdph.engine.surface import unit
from sdph.engine.walls import facets, nested
from sdph.schema import CaseError

RIMS = 3  # that are named; our choice


def checked(case) -> list[str]:
    """Lines on a `walls.mesh` that is open, or whose normals point away from the grains of a region that fills it;
    CaseError where such a one is closed: its grains would stand around it. Patches of the gas's mesh are right."""
    own = case.parameters["walls"] if "walls" in case.effects else None
    if own is None or not own.mesh or own.source == "gas":
        return []
    key, corners = f"walls.mesh = {own.mesh!r}", facets.read(own.mesh, case.dimensions, unit(own))
    nested.refuse_mixed(corners, key)
    rims = facets.Surface(corners).rims()
    filling, parts = [name for name, region in case.particles.items() if region.shape == "walls"], facets.parts(corners)
    inside_out = filling if facets.enclosed(corners) < 0.0 else []
    if inside_out and not rims:
        raise CaseError(
            f'particles.{inside_out[0]}.shape = "walls", and {key} is closed and inside out: its normals point out of '
            "it, and the grains would stand around it; normals must point towards the grains, so flip them"
        )
    gaps = [rim for rim in rims if not _in_a_side(case, rim[0])]
    told = [_open(key, gaps)] if gaps else []
    if rims and parts.max():
        told += [_of_several(name, key, parts.max() + 1) for name in filling]
    turned = f"{key} is inside out: its normals point out of what it encloses, and must point towards the grains"
    return told + [f'particles.{name}.shape = "walls", and {turned}' for name in inside_out]


def _of_several(name: str, key: str, count: int) -> str:
    """A line on a region that fills an open surface of several parts."""
    return (
        f'particles.{name}.shape = "walls" fills what lies in front of {key}, which is open and has {count} parts: '
        "each place by the part that is nearest; look at the start, or give a box, or another region"
    )


def _in_a_side(case, middle) -> bool:
    """True of the middle (d,) [m] of a rim that lies in a side of the domain, which is a wall too."""
    near = 1e-6 * math.hypot(*case.domain.size)
    sides = zip(middle, case.domain.corner, case.domain.upper)
    return any(abs(at - side) <= near for at, *both in sides for side in both)


def _open(key: str, rims: list) -> str:
    """A line on the rims (middle (d,) [m], length [m]) of an open surface, the shortest of them named."""
    own = "; ".join(
        f"({', '.join(f'{a:.4g}' for a in middle)}) m" + (f", {length:.3g} m round" if length else "")
        for middle, length in rims[:RIMS]
    )
    many = f"{len(rims)} places, the smallest" if len(rims) > RIMS else "the places"
    return (
        f"{key} is open at {many} about {own}: grains pass there; close what is no mouth of the vessel and no edge of "
        "a plate"
    )
