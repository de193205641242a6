"""Keys of the gas solver that a case does not have."""

import dataclasses

import meshio
import numpy as np
import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.effects.around.walls import Walls
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
