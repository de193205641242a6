"""Surface tension between two phases: curvature, pressure, waves and frequencies."""

import numpy as np
import pytest
from two_phase_drops import BASE, stepper

from sdph.case import read as cases
from sdph.engine import kernels as smoothing
from sdph.engine.state import LIQUID, positions, velocities
from sdph.laws import liquids
from sdph.methods.liquids import interface, start

DROP = {
    "effects": ["surface_tension"],
    "domain": {"size_m": [3.0, 3.0], "gravity_m_s2": [0.0, 0.0]},
    "resolution": {"spacing_mm": 50.0, "smoothing_ratio": 1.5},
    "liquid": BASE["liquid"] | {"periodic": [1.0, 1.0]},
    "surface_tension": {"coefficient_N_m": 0.5},
    "pools": {
        "drop": {"shape": "disc", "centre_m": [1.5, 1.5], "radius_m": 1.0},
        "air": {"phase": "gas", "shape": "box", "lower_m": [0.0, 0.0], "upper_m": [3.0, 3.0]},
    },
}


def test_curvature_of_a_disc():
    own = stepper(shaken=False, **DROP)
    across = own.curvature[own.curvature != 0.0]
    assert np.mean(across) == pytest.approx(1.0, rel=0.02)


def test_tension_of_one_curvature_is_balanced_by_its_pressure():
    """Whatever the disorder: with p = sigma kappa in the disc and 0 around it, force and pressure differ by no more
    than what one pressure everywhere gives."""
    own = stepper(**DROP)
    s, sigma = own.state, 0.5
    own.curvature[:] = np.where(own.normal.any(axis=1), 2.0, 0.0)
    tension = np.zeros((len(s.x), 3))
    interface.pull(
        own.kernel,
        s,
        own.rows,
        own.neighbours.box,
        own.active,
        own.p["surface_tension"],
        own.volume,
        own.normal,
        own.curvature,
        tension,
    )
    r, h = positions(s), own.kernel.h
    for i in np.flatnonzero(own.normal.any(axis=1))[::25]:
        jump = np.zeros(3)
        for j in np.flatnonzero((np.linalg.norm(r - r[i], axis=1) < 2.0 * h) & (s.kind != s.kind[i])):
            d, inside = r[i] - r[j], 2.0 * sigma * (s.kind[j] == LIQUID) - 2.0 * sigma * (s.kind[i] == LIQUID)
            pair = 2.0 * s.density[i] * inside / (s.density[i] + s.density[j])
            jump -= (
                s.mass[j]
                / s.density[j]
                * smoothing.slope.py_func(own.kernel, np.linalg.norm(d))
                * pair
                * d
                / s.density[i]
            )
        assert np.allclose(tension[i], -jump, rtol=1e-9, atol=1e-12 * np.abs(jump).max())


def test_wave_raises_the_particles_of_both_phases_about_its_level():
    middle = {"centre_m": [0.0, 0.4], "flow": "wave", "displacement_m": 0.02, "speed_m_s": 0.3}
    pools = {name: pool | middle for name, pool in BASE["pools"].items()}
    raised, flat = (start.fill(cases.from_table(BASE | {"pools": own})) for own in (pools, BASE["pools"]))
    wet = flat.kind >= LIQUID
    moved = (positions(raised) - positions(flat))[wet, :2]
    expected = liquids.wave(positions(flat)[wet, :2] - [0.0, 0.4], 0.5, 0.02)
    np.testing.assert_allclose(moved, expected, atol=1e-12)
    np.testing.assert_allclose(velocities(raised)[wet, :2], 15.0 * expected, atol=1e-12)
    assert (raised.y == flat.y)[~wet].all()


def test_quadrupole_is_continuous_across_the_rim_along_its_normal():
    angle = np.linspace(0.0, 2.0 * np.pi, 17)
    normal = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    inside, outside = (liquids.quadrupole(r * normal, 2.0, 0.3) for r in (2.0 - 1e-9, 2.0 + 1e-9))
    assert np.allclose((inside * normal).sum(axis=1), 0.3 * np.cos(2.0 * angle), atol=1e-8)
    assert np.allclose((outside * normal).sum(axis=1), 0.3 * np.cos(2.0 * angle), atol=1e-8)


def test_frequencies_of_discs():
    """Closed forms of Lamb 1932 in units of sqrt(sigma/(rho R^3)), n = 2 and 3."""
    assert liquids.disc_frequency(2, 1.0, 1.0, 1.0) == pytest.approx(2.44949, rel=1e-5)
    assert liquids.disc_frequency(3, 1.0, 1.0, 1.0) == pytest.approx(4.89898, rel=1e-5)
    assert liquids.disc_frequency(2, 1.0, 1.0, 1.0, 1.0) == pytest.approx(1.73205, rel=1e-5)
