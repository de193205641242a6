"""All that an OpenFOAM case tells a case of sdph."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np

from coupling.openfoam.foreign import bed, conditions, properties
from coupling.openfoam.foreign.conditions import PLANE, Condition
from coupling.openfoam.foreign.files import Files
from coupling.openfoam.poly_mesh import PolyMesh, box
from sdph.laws.constants import ROUND_OFF
from sdph.schema import CaseError

CLOSED = ("cyclic", "cyclicAMI", "cyclicACMI", "cyclicSlip", "processor", "wedge")  # types of patches not known here


@dataclasses.dataclass
class Found:
    """Sections of case.toml, and the `notes` that tell what was not known, a line each."""

    dimensions: int
    lower: list[float]
    size: list[float]
    cell: float  # m
    gravity: list[float]
    times: tuple[float, float]  # s: the end, and between outputs
    gas: dict
    grains: dict
    bed: dict
    boundaries: dict[str, Condition]
    drag: str
    friction_angle: float | None  # deg
    phases: tuple[str, str]
    notes: list[str]


def look(folder: Path) -> Found:
    """Read a case; `CaseError` where it is none, has no mesh, or one that sdph does not know."""
    files = Files(folder)
    mesh, notes = PolyMesh(files.folder), _without_fields(files)
    dimensions = _dimensions(files, mesh)
    low, high = (corner[:dimensions] for corner in box(files.folder))
    gravity, grains = properties.gravity(files, dimensions, notes), properties.grains(files, notes)
    gas = properties.gas(files, notes)
    region = bed.bed(files, mesh, (low, high), gravity, grains, notes)
    region["temperature_K"] = bed.temperature(files, mesh, gas["temperature_K"], notes)
    properties.turbulence(files, notes)
    found = conditions.conditions(files, mesh, dimensions, region["volume_fraction"])
    depth = 1.0 if dimensions == 3 else float(np.ptp(mesh.points[:, 2]))
    volumes = mesh.volumes
    return Found(
        dimensions, low.tolist(), (high - low).tolist(), float((volumes.mean() / depth) ** (1.0 / dimensions)), gravity,
        properties.times(files, notes), gas, grains, region, found, properties.drag(files, notes),
        properties.friction_angle(files), (files.phase, files.grains), notes,
    )  # fmt: skip


def _without_fields(files: Files) -> list[str]:
    """A note where a mesh comes alone."""
    if (files.folder / files.start).is_dir():
        return []
    return [f"the case has a mesh alone (no folder {files.start}): give the conditions of its patches in [boundaries]"]


def _dimensions(files: Files, mesh: PolyMesh) -> int:
    """2 where a layer of cells lies across z, else 3."""
    kinds = {name: patch.kind for name, patch in mesh.patches.items() if patch.faces.stop > patch.faces.start}
    for name, kind in kinds.items():
        if kind in CLOSED:
            raise CaseError(
                f"{files.folder}: patch {name} is of type {kind}, which no gas solver of sdph has; take another mesh"
            )
    across = [name for name, kind in kinds.items() if kind == PLANE]
    for name in across:
        if np.abs(mesh.areas[mesh.patches[name].faces][:, :2]).max() > ROUND_OFF * np.abs(mesh.areas).max():
            raise CaseError(
                f"{files.folder}: patch {name} (empty) does not stand across z; turn the mesh (transformPoints)"
            )
    return 2 if across else 3
