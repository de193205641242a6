"""Keys that the gas solver of a case does not read."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from coupling.choice import expected
from coupling.openfoam import patches, poly_mesh
from sdph.case.sections import Coupling
from sdph.engine.walls import facets
from sdph.methods.grains import start
from sdph.running import vessel
from sdph.schema import fields

OF = {"openfoam": ("gas_ranks", "transport"), "embedded": ("gas_tolerance",)}  # solver -> keys that it alone reads
NEAR = 0.5  # of a spacing: two drawings of one wall in facets differ by less; our choice


def warnings(case) -> list[str]:
    """A line for each key that was given for the other solver."""
    if "grains" not in case.matters:
        return []
    chosen, usual = expected(case.only("grains")), Coupling()
    (other,) = OF.keys() - {chosen}
    return [
        f"coupling.{key} = {getattr(case.coupling, at)} is of the {other} gas, and the gas is {chosen}: it does nothing"
        for key, (at, _) in fields(Coupling).items()
        if at in OF[other] and getattr(case.coupling, at) != getattr(usual, at)
    ]


def unseen(case, template: Path) -> list[str]:
    """A line where grains that the gas drags or presses have a `walls.mesh`, and the gas fills the domain, or a mesh of
    its own with walls elsewhere, so that it goes through; `template` is the OpenFOAM case with its mesh, if it has one
    of its own."""
    walls = "grains" in case.matters and start.mesh_of_walls(case) is not None
    if not walls or not {"drag", "gas_pressure"} & set(case.effects):
        return []
    if (template / poly_mesh.FOLDER).is_dir() and not vessel.fills(case, template):
        return _apart(case, template)
    return [
        f"walls.mesh = {case.parameters['walls'].mesh!r} holds the grains alone: the gas fills the domain and goes "
        "through it; where it has to go around, give the gas an OpenFOAM mesh of the vessel (docs/howto/vessel.md)"
    ]


def _apart(case, template: Path) -> list[str]:
    """The same of walls that stand within a mesh of the gas that is no box."""
    own, held = case.parameters["walls"], start.mesh_of_walls(case)
    if own.source == "gas":  # made of that mesh
        return []
    found = patches.of_mesh(poly_mesh.read(template), case.boundaries, case.dimensions)
    places = np.concatenate([held.reshape(-1, case.dimensions), held.mean(axis=1)])
    off = float(facets.Surface(found.corners).distance(places).max())
    if off <= NEAR * case.resolution.spacing:
        return []
    return [
        f"walls.mesh = {own.mesh!r} stands up to {1e3 * off:.3g} mm within the walls of the gas's mesh: gas goes "
        "through there; look at walls.mesh_scale, leave walls.mesh out for the walls of that mesh, or give the gas "
        "a mesh with these walls"
    ]
