"""Flows of an incompressible liquid against the equations that they solve, by differences, and against numbers worked
out by hand."""

import math

import numpy as np
import pytest

from sdph.laws import liquids

RHO, STEP = 900.0, 1e-4
PLACES = np.random.default_rng(5).uniform(0.1, 0.9, (20, 2))
SHIFTS = STEP * np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]])


def slopes(function):
    """d/dx and d/dy of a function of points at PLACES, (2, 20, ...)."""
    right, left, up, down = (function(PLACES + shift) for shift in SHIFTS)
    return np.array([right - left, up - down]) / (2.0 * STEP)


def test_vortices_of_taylor_and_green_are_steady_without_viscosity():
    """div u = 0 and rho (u grad) u = -grad p."""
    velocity = liquids.taylor_green(PLACES, 1.0, 2.0, RHO)[0]
    gradient = slopes(lambda points: liquids.taylor_green(points, 1.0, 2.0, RHO)[0])
    pressure = slopes(lambda points: liquids.taylor_green(points, 1.0, 2.0, RHO)[1])
    np.testing.assert_allclose(gradient[0, :, 0] + gradient[1, :, 1], 0.0, atol=1e-5)
    carried = velocity[:, :1] * gradient[0] + velocity[:, 1:] * gradient[1]
    np.testing.assert_allclose(RHO * carried, -pressure.T, atol=1e-5 * RHO * 4.0 * 2.0 * math.pi)
    assert np.abs(velocity).max() > 1.0


def test_they_decay_by_viscosity():
    """Half of the velocity is left after ln 2/(2 nu k^2)."""
    half = math.log(2.0) / (2.0 * 1e-2 * (2.0 * math.pi / 0.5) ** 2)
    assert liquids.taylor_green_decay(half, 0.5, 1e-2) == pytest.approx(0.5, rel=1e-12)


def test_pressure_of_a_square_that_turns():
    """lap p = 2 rho omega^2, and none at the rim."""
    points = 0.3 + 0.4 * PLACES
    h = 0.02
    own = [liquids.square_patch_pressure(points + h * s, 1.0, 3.0, RHO) for s in (*SHIFTS / STEP, np.zeros(2))]
    laplacian = (sum(own[:4]) - 4.0 * own[4]) / h**2
    np.testing.assert_allclose(laplacian, 2.0 * RHO * 9.0, rtol=0.02)
    rim = np.array([[0.0, 0.3], [1.0, 0.4], [0.6, 0.0], [0.2, 1.0]])
    np.testing.assert_allclose(liquids.square_patch_pressure(rim, 1.0, 3.0, RHO), 0.0, atol=1e-6 * RHO * 9.0)


def test_flow_between_plates_starts_and_ends():
    """du/dt = F + nu d2u/dy2 on the way; at rest first, F y (H - y)/(2 nu) in the end."""
    y, time, own = np.linspace(0.2, 0.8, 7), 0.05, (1.0, 0.4, 0.1)  # height, force, viscosity
    later, sooner = (liquids.poiseuille(y, time + s, *own) for s in (1e-5, -1e-5))
    up, here, down = (liquids.poiseuille(y + s, time, *own) for s in (1e-3, 0.0, -1e-3))
    np.testing.assert_allclose((later - sooner) / 2e-5, 0.4 + 0.1 * (up - 2.0 * here + down) / 1e-6, rtol=1e-4)
    np.testing.assert_allclose(liquids.poiseuille(y, 0.0, *own), 0.0, atol=1e-5)
    np.testing.assert_allclose(liquids.poiseuille(y, 50.0, *own), 2.0 * y * (1.0 - y), rtol=1e-12)


# omega_0 t, height/length of a wave that is 0.01 high at the start, Laplace number 3000, without its sign: Popinet &
# Zaleski 1999 after Prosperetti 1981 (comphy-lab/basilisk-C, prosperetti.h)
WAVE = [(0.338877, 0.0094816), (1.69439, 7.29205e-4), (3.45655, 7.2896e-3), (10.3358, 3.48877e-3), (23.7214, 7.4837e-4)]


def test_capillary_wave_is_that_of_the_table():
    omega = math.sqrt((2.0 * math.pi) ** 3 / 2.0)
    for phase, expected in WAVE:
        height = liquids.capillary_wave(phase / omega, 1.0, 1.0, 1.0, 1.0, 0.0182571749236)
        assert abs(0.01 * height) == pytest.approx(expected, abs=1e-6)


@pytest.mark.parametrize(("around", "viscosity"), [(0.0, 1e-3), (120.0, 2e-2), (900.0, 1e-1)])
def test_capillary_wave_begins_from_rest_whatever_the_liquids(around, viscosity):
    """Height 1, then less by half of omega^2 t^2 = sigma k^3/(rho + rho') t^2, before viscosity acts."""
    k = 2.0 * np.pi / 0.2
    square = 0.07 * k**3 / (900.0 + around)
    time = 1e-3 / max(square**0.5, viscosity * k * k)
    start, later = liquids.capillary_wave([0.0, time], 0.2, 0.07, 900.0, around, viscosity)
    assert start == pytest.approx(1.0, abs=1e-10)  # roots of a quartic: 7e-12 off
    assert 1.0 - later == pytest.approx(0.5 * square * time**2, rel=0.1)


def test_capillary_wave_of_one_liquid_without_viscosity_is_a_cosine():
    """omega^2 = sigma k^3/rho: Lamb 1932, section 266."""
    omega, time = math.sqrt(0.07 * (2.0 * math.pi / 0.2) ** 3 / 900.0), np.linspace(0.0, 3.0, 7)
    height = liquids.capillary_wave(time, 0.2, 0.07, 900.0, 0.0, 1e-12)
    np.testing.assert_allclose(height, np.cos(omega * time), atol=1e-4)


def test_wave_has_no_divergence_and_no_curl():
    """On both sides of its level, across which its vertical part does not jump; it is its amplitude at a crest."""

    def own(points):
        return liquids.wave(points - [0.0, 0.5], 0.8, 2.0)

    gradient = slopes(own)
    np.testing.assert_allclose(gradient[0, :, 0] + gradient[1, :, 1], 0.0, atol=1e-4)
    np.testing.assert_allclose(gradient[0, :, 1] - gradient[1, :, 0], 0.0, atol=1e-4)
    low, high = liquids.wave(np.array([[0.1, -1e-9], [0.1, 1e-9]]), 0.8, 2.0)
    assert low[1] == pytest.approx(high[1], rel=1e-6)
    assert low[0] == pytest.approx(-high[0], rel=1e-6)
    np.testing.assert_allclose(liquids.wave(np.zeros((1, 2)), 0.8, 2.0), [[0.0, 2.0]], atol=1e-12)


def test_quadrupole_has_no_divergence_and_no_curl():
    """Inside and outside of the rim; at the rim on the x axis it goes outwards with the speed."""
    own = PLACES - 0.5

    def flow(points):
        return liquids.quadrupole(points - 0.5, 0.25, 2.0)

    gradient, far = slopes(flow), np.abs(np.hypot(*own.T) - 0.25) > 10.0 * STEP
    np.testing.assert_allclose(gradient[0, :, 0] + gradient[1, :, 1], 0.0, atol=1e-4)
    np.testing.assert_allclose((gradient[0, :, 1] - gradient[1, :, 0])[far], 0.0, atol=1e-4)
    for radius in (0.25, 0.25 + 1e-9):
        np.testing.assert_allclose(liquids.quadrupole(np.array([[radius, 0.0]]), 0.25, 2.0), [[2.0, 0.0]], atol=1e-6)


def test_frequencies_by_hand():
    """Of a disc of n = 2, sigma 0.5, R 0.1 in something a fifth as dense: sqrt(6 0.5/(1.2 1e-3 900)); of a box by the
    tables of tanh: k = pi, tanh(pi/2) = 0.917152336."""
    assert liquids.disc_frequency(2, 0.1, 0.5, RHO, 180.0) == pytest.approx(math.sqrt(3.0 / 1.08), rel=1e-12)
    assert liquids.box_slosh(1.0, 0.5, 9.81) == pytest.approx(math.sqrt(9.81 * math.pi * 0.917152336), rel=1e-8)
