"""Drag between grains of two materials against numbers computed apart, and what it must be like."""

import math

import pytest

from sdph.laws import grain_drag


def test_syamlal_against_a_count_of_collisions():
    """Smooth spheres of a stream that sweep through others at rest: n_s pi D^2 u collisions a second, each of a mean
    momentum (1 + e)/2 m u along the way for the reduced mass m, and D = (d_m + d_s)/2; twice g0 where crowded.

    beta/(alpha_m alpha_s) = n_m n_s pi D^2 u (1 + e)/2 m g0/(alpha_m alpha_s), n = 6 alpha/(pi d^3).
    """
    e, g0, u = 0.9, 2.0, 0.3
    for (rho_m, d_m), (rho_s, d_s) in (((2500.0, 1e-3), (1000.0, 3e-3)), ((2500.0, 1e-3), (2500.0, 1e-3))):
        mass_m, mass_s = (rho * math.pi / 6.0 * d**3 for rho, d in ((rho_m, d_m), (rho_s, d_s)))
        reduced = mass_m * mass_s / (mass_m + mass_s)
        per_volume = (6.0 / (math.pi * d_m**3)) * (6.0 / (math.pi * d_s**3))
        swept = math.pi * (0.5 * (d_m + d_s)) ** 2 * u
        expected = per_volume * swept * 0.5 * (1.0 + e) * reduced * g0
        found = grain_drag.syamlal(e, 0.0, rho_m, rho_s, d_m, d_s, g0, u)
        assert found == pytest.approx(expected, rel=1e-12)


def test_it_is_symmetric_and_grows_with_friction():
    own = grain_drag.syamlal(0.9, 0.1, 2500.0, 1000.0, 1e-3, 2e-3, 1.5, 0.2)
    assert own == pytest.approx(grain_drag.syamlal(0.9, 0.1, 1000.0, 2500.0, 2e-3, 1e-3, 1.5, 0.2), rel=1e-15)
    smooth = grain_drag.syamlal(0.9, 0.0, 2500.0, 1000.0, 1e-3, 2e-3, 1.5, 0.2)
    assert own / smooth == pytest.approx(1.0 + 0.1 * math.pi / 4.0, rel=1e-12)
