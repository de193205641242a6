"""Inlets whose gas goes out, or along them: OpenFOAM takes a velocity as it is given, and one that points out of the
domain sucks, one along its side brings nothing in."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from coupling.openfoam import poly_mesh
from sdph.engine.geometry import SIDES
from sdph.laws.constants import TINY

ASIDE = 1e-3  # of the velocity: one along its patch but for round-off and the facets of a round one; our choice

ROUND = 0.9  # length of the mean normal from which on a patch is nearly plane; our choice


def warnings(case, template: Path) -> list[str]:
    """A line for each velocity_inlet through which gas leaves on balance, or none comes, or of whose vapour nothing is
    said; `template` is the OpenFOAM case with its mesh, if it has one of its own. On a box, inlets without a side are
    not judged: they lie on several."""
    if "grains" not in case.matters:
        return []
    mesh = poly_mesh.read(template) if (template / poly_mesh.FOLDER).is_dir() else None
    told = _of_vapour(case)
    for name, boundary in case.boundaries.items():
        if not boundary.lets_in:
            continue
        velocity = np.array([*boundary.strongest, 0.0][:3])
        normal = _outwards(mesh, name, boundary)
        key = "the fastest of velocities" if boundary.velocities else "velocity_m_s"
        outwards, given = velocity @ normal, f"{key} = {list(boundary.strongest)}"
        plane = float(np.linalg.norm(normal)) > ROUND  # else it goes round, and a mean says nothing
        facing = ", ".join(f"{part:.2g}" for part in normal[: case.dimensions])
        if outwards > ASIDE * float(np.linalg.norm(velocity)):
            told.append(
                f"boundaries.{name} is a velocity_inlet, and {given} points out of the domain, whose normal there is "
                f"({facing}): it sucks gas out; turn its sign, unless that is meant"
            )
        elif plane and velocity.any() and outwards > -ASIDE * float(np.linalg.norm(velocity)):
            told.append(
                f"boundaries.{name} is a velocity_inlet, and {given} runs along it, whose normal is ({facing}): it "
                "lets no gas in; turn the velocity, or name another side"
            )
    return told


def _of_vapour(case) -> list[str]:
    """A line for each velocity_inlet that says nothing of the vapour that there is in the gas at the start."""
    inside = case.vapour.mass_fraction if case.vapour else 0.0
    return [
        f"boundaries.{name} gives no vapour_mass_fraction: its gas has that of the gas at the start, {inside:g}; give "
        "it, 0 for dry gas"
        for name, own in case.boundaries.items()
        if inside and own.kind == "velocity_inlet" and own.vapour_mass_fraction is None
    ]


def _outwards(mesh, name: str, boundary) -> np.ndarray:
    """Mean normal (3,) out of the domain, each part of a patch by its area; 0 where it is not known."""
    normal = np.zeros(3)
    if mesh is not None:
        if name in mesh.patches:
            own = mesh.areas[mesh.patches[name].faces]
            normal = own.sum(axis=0) / max(float(np.linalg.norm(own, axis=1).sum()), TINY)
    elif boundary.side:
        axis, end = SIDES[boundary.side]
        normal[axis] = 2.0 * end - 1.0
    return normal
