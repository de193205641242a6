"""Keys of the gas solver that a case does not have."""

import pytest

from sdph import scenes
from sdph.case import read as cases
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
