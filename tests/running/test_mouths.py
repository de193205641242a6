"""Nozzles whose mouth reaches out of the gas are refused: what comes in there would be lost without a word."""

import dataclasses

import meshio
import numpy as np
import pytest
import pyvista

from sdph import scenes
from sdph.case import read as cases
from sdph.effects.around.walls import Walls
from sdph.running import vessel
from sdph.schema import CaseError


def sprayed(**nozzle):
    """The scene of a jet, its nozzle in the left side of a box."""
    case = cases.load(scenes.find("evaporating_jet")[1])
    own = dataclasses.replace(case.nozzles["jet"], **nozzle)
    return dataclasses.replace(case, nozzles={"jet": own})


def refuse(case, mesh=None):
    """Refuse what a run refuses of a case; without a `mesh` of its own the gas fills the domain."""
    vessel.refuse_beside(case, mesh)


def test_a_mouth_in_a_wall_is_fine():
    refuse(sprayed())


@pytest.mark.parametrize(("nozzle", "all_of_it"), [({"direction": (1.0, 0.8)}, False), ({"centre": (-0.5, 2.0)}, True)])
def test_a_mouth_that_reaches_out_is_refused(nozzle, all_of_it):
    with pytest.raises(CaseError, match=r"nozzles.jet: (\d+) of its (\d+) streams come in outside the gas") as said:
        refuse(sprayed(**nozzle))
    out, streams = (int(word) for word in np.array(str(said.value).split())[[1, 4]])
    assert 0 < out < streams or (all_of_it and out == streams)


def test_what_is_periodic_has_no_outside():
    case = sprayed(centre=(1.0, -0.1))
    domain = dataclasses.replace(case.domain, periodic=("y",))
    refuse(dataclasses.replace(case, domain=domain))


def test_a_mouth_beside_a_mesh_of_ones_own_is_refused(monkeypatch):
    """The mesh fills the left half of the domain alone."""
    size = sprayed().domain.size
    cells = pyvista.ImageData(
        dimensions=(3, 3, 2), spacing=(size[0] / 4.0, size[1] / 2.0, 1.0), origin=(0.0, 0.0, -0.5)
    )
    monkeypatch.setattr(vessel.patches, "cells", lambda mesh, dimensions: cells.cast_to_unstructured_grid())
    monkeypatch.setattr(vessel, "fills", lambda case, mesh: False)
    monkeypatch.setattr(vessel, "_refuse_other_size", lambda case, mesh: None)
    refuse(sprayed(), "gas")
    with pytest.raises(CaseError, match="come in outside the gas"):
        refuse(sprayed(centre=(0.6 * size[0], 0.5 * size[1])), "gas")


def around_block(case, path, lower, upper):
    """The case with a block from `lower` to `upper` [m], around which grains stand, as walls.mesh."""
    (a, b), (c, d) = lower, upper
    corners = np.array([[a, b, 0.0], [a, d, 0.0], [c, d, 0.0], [c, b, 0.0]])
    meshio.write_points_cells(path, corners, [("line", np.array([[0, 1], [1, 2], [2, 3], [3, 0]]))])
    more = {"walls": Walls(mesh=str(path), source="mesh")}
    return dataclasses.replace(case, effects=(*case.effects, "walls"), parameters=case.parameters | more)


def test_a_mouth_within_walls_of_particles_alone_is_refused(tmp_path):
    """The gas of the box is there too: the mesh of the walls tells."""
    case, path = sprayed(), tmp_path / "block.vtk"
    (x, y), spacing, wide = case.nozzles["jet"].centre, case.resolution.spacing, case.nozzles["jet"].width
    refuse(around_block(case, path, (x + 2.0 * spacing, y - wide), (x + 0.2, y + wide)))  # ahead of the mouth
    with pytest.raises(CaseError, match=r"nozzles.jet: (\d+) of its \1 streams come in within walls.mesh"):
        refuse(around_block(case, path, (x - 0.1, y - wide), (x + 0.2, y + wide)))
