"""Gas that is let into a vessel with no way out: of constant density it cannot stay there either."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from coupling.openfoam import poly_mesh
from sdph.case import inlets
from sdph.case.gas_cells import cell_edges
from sdph.schema import CaseError

SAME = 1e-3  # of all that passes, in and out: as far as given digits and meshes of text files balance; our choice


def refuse_filling(case, template: Path) -> None:
    """CaseError where gas of constant density is let in, on balance, and nothing is open; `template` is the
    OpenFOAM case with its mesh, if it has one of its own."""
    kinds = [boundary.kind for boundary in case.boundaries.values()]
    if case.gas.equation_of_state != "constant" or "pressure_outlet" in kinds or "velocity_inlet" not in kinds:
        return
    own = (template / poly_mesh.FOLDER).is_dir()
    for time in inlets.times(case) or [0.0]:
        now = inlets.held(case, time)
        _refuse_unbalanced(case, _of_patches(now, template) if own else _of_box(now))


def _refuse_unbalanced(case, flows: np.ndarray) -> None:
    """CaseError where flows into the gas do not balance."""
    if abs(flows.sum()) <= SAME * np.abs(flows).sum():
        return
    name = next(name for name, boundary in case.boundaries.items() if boundary.kind == "velocity_inlet")
    raise CaseError(
        f"boundaries.{name} is a velocity_inlet, and {flows.sum():.3g} m{case.dimensions}/s of gas of constant "
        "density come in that find no way out; make a boundary a pressure_outlet, or set "
        'gas.equation_of_state = "ideal"'
    )


def _of_patches(case, template: Path) -> np.ndarray:
    """Flow [m3/s], in two dimensions [m2/s], into an own mesh through each of its patches that has a velocity."""
    mesh = poly_mesh.read(template)
    given = {name: b.velocity for name, b in case.boundaries.items() if b.kind == "velocity_inlet" and b.velocity}
    across = {name: mesh.areas[mesh.patches[name].faces].sum(axis=0) for name in given if name in mesh.patches}
    depth = np.ptp(mesh.points[:, 2]) if case.dimensions == 2 else 1.0
    return np.array([-area[: case.dimensions] @ np.array(given[name]) / depth for name, area in across.items()])


def _of_box(case) -> np.ndarray:
    """Flow (B,) [m3/s], in two dimensions [m2/s], into the box through each face of its boundary."""
    from coupling.embedded.boundaries import boundary_faces
    from coupling.embedded.grid import build_grid

    grid = build_grid(cell_edges(case))
    faces = boundary_faces(case, grid)
    along = faces.velocity[np.arange(len(faces.axis)), faces.axis] * faces.inlet
    return -faces.sign * along * grid.geometry.area[faces.axis, faces.face]
