"""Turbulence that a gas brings along, against numbers reckoned apart."""

import pytest

from sdph.laws import turbulence


def test_turbulence_of_an_inlet():
    """10 m/s at 5 %, l = 7 mm: k = 1.5 x 0.25, epsilon = 0.164317 x 0.229640/0.007, omega = 0.612372/(0.547723 x
    0.007)."""
    k = turbulence.kinetic_energy(10.0, 0.05)
    assert k == pytest.approx(0.375, rel=1e-12)
    assert turbulence.dissipation(k, 0.007) == pytest.approx(5.39055, rel=1e-5)
    assert turbulence.frequency(k, 0.007) == pytest.approx(159.719, rel=1e-5)
    assert turbulence.dissipation(k, 0.007) == pytest.approx(0.09 * k * turbulence.frequency(k, 0.007), rel=1e-12)
