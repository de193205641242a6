"""Gas that is let into a vessel with no way out: of constant density it cannot stay there either, of another it stays
at a pressure, or at a temperature, that does not follow."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from coupling.openfoam import poly_mesh
from sdph.case import inlets
from sdph.case.gas_cells import cell_edges
from sdph.laws.sound import adiabatic
from sdph.schema import CaseError

# what does not follow as gas fills a vessel, by the equation of state: docs/theory/gas.md
STAYS = {
    "operating": "its density grows with what comes in, its pressure stays at gas.operating_pressure_Pa and no "
    "compression warms it, so that density is no longer that of pressure and temperature (gas_box_rel of history.csv: "
    'by how much); make a boundary a pressure_outlet, or set gas.equation_of_state = "ideal"',
    "ideal": "its pressure follows, but no compression warms it: where walls take no heat, pressure changes "
    "c_p/c_v = {:.3g} times too slowly",
}
SAME = 1e-3  # of all that passes, in and out: as far as given digits and meshes of text files balance; our choice


def refuse_filling(case, template: Path) -> None:
    """CaseError where gas of constant density is let in, on balance, and nothing is open; `template` is the
    OpenFOAM case with its mesh, if it has one of its own."""
    flow = _unbalanced(case, template) if case.gas.equation_of_state == "constant" else 0.0
    if flow:
        raise CaseError(
            f"boundaries.{_inlet(case)} is a velocity_inlet, and {flow:.3g} m{case.dimensions}/s of gas of constant "
            "density come in that find no way out; make a boundary a pressure_outlet, or set "
            'gas.equation_of_state = "ideal"'
        )


def warnings(case, template: Path) -> list[str]:
    """A line where gas whose density may change is let in, or sucked out, on balance, and nothing is open; `template`
    as of `refuse_filling`."""
    if "grains" not in case.matters or case.gas.equation_of_state not in STAYS:
        return []
    own = case.only("grains")
    flow = _unbalanced(own, template)
    if not flow:
        return []
    gamma = float(adiabatic(own.gas.heat_capacity, own.gas.molar_mass))
    way, back = ("comes in", "out") if flow > 0.0 else ("goes out", "in")
    filled = _room(own, template) / abs(flow)
    return [
        f"boundaries.{_inlet(own)} is a velocity_inlet, and {abs(flow):.3g} m{own.dimensions}/s of gas {way} on "
        f"balance that finds no way {back}, as much as there is within {filled:.3g} s: "
        f"{STAYS[own.gas.equation_of_state].format(gamma)}"
    ]


def _room(case, template: Path) -> float:
    """Volume [m3], in two dimensions [m2], of the gas's mesh."""
    if not (template / poly_mesh.FOLDER).is_dir():
        return math.prod(case.domain.size)
    mesh = poly_mesh.read(template)
    return float(mesh.volumes.sum()) / _depth(case, mesh)


def _depth(case, mesh) -> float:
    """Depth [m] of the mesh of a plane case; 1 in space."""
    return float(np.ptp(mesh.points[:, 2])) if case.dimensions == 2 else 1.0


def _unbalanced(case, template: Path) -> float:
    """Flow [m3/s], in two dimensions [m2/s], that comes in on balance where nothing is open, at the first time of the
    inlets' rows at which there is any; else 0."""
    kinds = [boundary.kind for boundary in case.boundaries.values()]
    if "pressure_outlet" in kinds or "velocity_inlet" not in kinds:
        return 0.0
    own = (template / poly_mesh.FOLDER).is_dir()
    for time in inlets.times(case) or [0.0]:
        now = inlets.held(case, time)
        flows = _of_patches(now, template) if own else _of_box(now)
        if abs(flows.sum()) > SAME * np.abs(flows).sum():
            return float(flows.sum())
    return 0.0


def _inlet(case) -> str:
    """Name of the first velocity_inlet."""
    return next(name for name, boundary in case.boundaries.items() if boundary.kind == "velocity_inlet")


def _of_patches(case, template: Path) -> np.ndarray:
    """Flow [m3/s], in two dimensions [m2/s], into an own mesh through each of its patches that has a velocity."""
    mesh = poly_mesh.read(template)
    given = {name: b.velocity for name, b in case.boundaries.items() if b.kind == "velocity_inlet" and b.velocity}
    across = {name: mesh.areas[mesh.patches[name].faces].sum(axis=0) for name in given if name in mesh.patches}
    depth = _depth(case, mesh)
    return np.array([-area[: case.dimensions] @ np.array(given[name]) / depth for name, area in across.items()])


def _of_box(case) -> np.ndarray:
    """Flow (B,) [m3/s], in two dimensions [m2/s], into the box through each face of its boundary."""
    from coupling.embedded.boundaries import boundary_faces
    from coupling.embedded.grid import build_grid

    grid = build_grid(cell_edges(case))
    faces = boundary_faces(case, grid)
    along = faces.velocity[np.arange(len(faces.axis)), faces.axis] * faces.inlet
    return -faces.sign * along * grid.geometry.area[faces.axis, faces.face]
