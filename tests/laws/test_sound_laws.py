"""Speed of sound of ideal gases against numbers of tables."""

import numpy as np
import pytest

from sdph.laws import sound


@pytest.mark.parametrize(
    ("temperature", "capacity", "molar", "speed"),
    [(300.0, 1004.7, 28.964, 347.2), (273.15, 5193.0, 4.0026, 972.5), (300.0, 1041.0, 28.013, 353.1)],
)
def test_gases_have_the_sound_of_tables(temperature, capacity, molar, speed):
    """Air at 300 K, helium at 0 degrees Celsius, nitrogen at 300 K: CRC Handbook, gases at low pressure."""
    assert float(sound.of_ideal_gas(temperature, capacity, molar)) == pytest.approx(speed, rel=2e-3)


def test_a_heat_capacity_that_no_gas_of_its_molar_mass_has_counts_as_that_of_one_atom():
    found = sound.adiabatic(np.array([1004.7, 5193.0, 1e5]), 4.0026)
    assert found == pytest.approx([5.0 / 3.0, 5.0 / 3.0, 1e5 / (1e5 - 8314.46 / 4.0026)], rel=1e-3)
