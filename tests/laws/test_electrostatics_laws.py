import math

import pytest

from sdph.laws import electrostatics
from sdph.laws.constants import VACUUM_PERMITTIVITY


def test_charge_of_a_sphere_is_that_of_its_surface():
    """A grain of 100 um and 2500 kg/m3 with 1e-5 C/m2: pi d^2 sigma = 0.314 pC on 1.309 ug."""
    assert electrostatics.charge_per_mass(1e-5, 1e-4, 2500.0) == pytest.approx(3.1415927e-13 / 1.3089969e-9, rel=1e-7)
    assert electrostatics.charge_per_mass(-1e-5, 1e-4, 2500.0) == -electrostatics.charge_per_mass(1e-5, 1e-4, 2500.0)


def test_permittivity_is_that_of_light():
    """eps_0 = 1/(mu_0 c^2), mu_0 of CODATA 2018."""
    assert pytest.approx(1.0 / (1.25663706212e-6 * 299792458.0**2), rel=1e-9) == VACUUM_PERMITTIVITY


def test_field_of_a_slab_is_that_of_its_sheets():
    """Rings of a wide slab, charge by charge by Coulomb's law, on the axis at its face."""
    charge_density, width, wide, sheets = 2e-6, 0.02, 200.0, 400
    thick = width / sheets
    depths = [(k + 0.5) * thick for k in range(sheets)]
    coulomb = sum(1.0 - z / math.hypot(z, wide) for z in depths) * charge_density * thick / (2.0 * VACUUM_PERMITTIVITY)
    assert electrostatics.slab_field(charge_density, width) == pytest.approx(coulomb, rel=1e-4)
