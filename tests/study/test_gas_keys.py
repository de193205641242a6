"""Keys of the gas solver that a case does not have."""

import dataclasses
import itertools

import meshio
import numpy as np
import own_meshes
import pytest

from coupling.openfoam import poly_mesh
from sdph import scenes
from sdph.case import read as cases
from sdph.effects.around.walls import Walls
from sdph.engine.walls import facets
from sdph.study import gas_keys


@pytest.mark.parametrize(("gas", "key", "told"), [
    ("embedded", "gas_ranks=2", "coupling.gas_ranks = 2 is of the openfoam gas, and the gas is embedded"),
    ("embedded", 'transport="file"', "coupling.transport = file is of the openfoam gas"),
    ("openfoam", "gas_tolerance=1e-6", "coupling.gas_tolerance = 1e-06 is of the embedded gas"),
    ("openfoam", "gas_ranks=2", None),
    ("embedded", "gas_tolerance=1e-6", None),
])  # fmt: skip
def test_keys_of_the_other_solver_are_told(gas, key, told):
    case = cases.load(scenes.find("disc_cluster")[1], (f'coupling.gas="{gas}"', f"coupling.{key}"))
    found = gas_keys.warnings(case)
    assert [told in text for text in found] == [True] if told else not found


def test_walls_that_the_gas_goes_through_are_told(tmp_path):
    """Where the gas acts on grains: on an OpenFOAM mesh of the vessel, it does not."""
    path, case = tmp_path / "plate.vtk", cases.load(scenes.find("bubbling_bed")[1])
    meshio.write_points_cells(path, np.array([[0.0, 0.1, 0.0], [0.1, 0.1, 0.0]]), [("line", np.array([[0, 1]]))])
    assert not gas_keys.unseen(case, tmp_path)
    walls = case.parameters | {"walls": Walls(mesh=str(path), source="mesh")}
    case = dataclasses.replace(case, parameters=walls)
    (line,) = gas_keys.unseen(case, tmp_path)
    assert "the gas fills the domain and goes through it" in line and "docs/howto/vessel.md" in line
    assert not gas_keys.unseen(dataclasses.replace(case, effects=("walls", "gravity")), tmp_path)


def box(low, high):
    """Corners of the triangles of a cube, seen from within by the right hand."""
    place, found = np.array([low, high]), []
    for axis, side in itertools.product(range(3), range(2)):
        a, b = np.roll(np.eye(3), -axis, axis=0)[1:]
        square = [place[side] * np.eye(3)[axis] + u * a + v * b for u, v in itertools.product((low, high), repeat=2)]
        around = [square[k] for k in ((0, 1, 3, 2) if side else (0, 2, 3, 1))]
        found += [[around[0], around[1], around[2]], [around[0], around[2], around[3]]]
    return np.array(found)


@pytest.mark.parametrize(("scale", "told"), [(1.0, None), (0.98, None), (0.7, "15 mm"), (1.2, None)])
def test_walls_within_those_of_the_gas_are_told_with_how_far(tmp_path, scale, told):
    """A cube of gas of 0.1 m in a larger domain, and walls of grains that are as large, smaller about its middle, or
    around it: half a spacing is 2 mm."""
    own_meshes.write_tetrahedra(tmp_path / poly_mesh.FOLDER, 0.1, 2)
    facets.save(tmp_path / "walls.vtk", given(scale * box(-0.05, 0.05) + 0.05))
    case = cases.load(scenes.find("bubbling_bed_3d")[1], ("resolution.spacing_mm=4",))
    walls = case.parameters | {"walls": Walls(mesh=str(tmp_path / "walls.vtk"))}
    named = {"all": dataclasses.replace(case.boundaries["walls"], side=None)}
    case = dataclasses.replace(case, parameters=walls, boundaries=named)
    found = gas_keys.unseen(case, tmp_path)
    assert [f"stands up to {told} within the walls of the gas's mesh" in text for text in found] == [True] * bool(told)
    made = case.parameters | {"walls": dataclasses.replace(walls["walls"], source="gas")}
    assert not gas_keys.unseen(dataclasses.replace(case, parameters=made), tmp_path)


def given(corners):
    nothing = np.zeros(len(corners), bool)
    return facets.Facets(corners, nothing, nothing, np.full(len(corners), -1))
