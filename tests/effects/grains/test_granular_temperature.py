"""Granular temperature: what pairs of particles hand each other, and what a step does to it."""

import math
from typing import NamedTuple

import numpy as np
import pytest
from exact_solutions import haff_cooling, lattice_divergence_factor

from sdph.effects.grains import granular_temperature as own
from sdph.laws import granular, kernels

E, PACKING, RHO, D, H = 0.9, 0.63, 2500.0, 3e-4, 0.01
ALPHA_P, THETA = 0.4, 1e-3
G0 = granular.sinclair_jackson(ALPHA_P, PACKING)


class Grains(NamedTuple):
    theta: np.ndarray


class Stress(NamedTuple):
    conductivity: np.ndarray


def parameters(dissipation="lun", model="transport", artificial=0.0, least=1e-12, most=1e3):
    places = own.MODELS.index(model), own.DISSIPATIONS.index(dissipation)
    return own.TemperatureP(*places, artificial, E, PACKING, RHO, H, least, most)


def test_diffusion_on_a_lattice_is_the_laplacian():
    """Of theta = x^2/2 and conductivity k each gets k/rho [W/kg] times the lattice's own divergence factor."""
    rho, k, h, total = 2.0, 3.0, 1.5, 0.0
    sigma = kernels.normalisation("cubic_spline", 2, h)
    for a in range(-3, 4):
        for b in range(-3, 4):
            if r2 := a * a + b * b:
                scale = kernels.cubic_spline_gradient(math.sqrt(r2), h, sigma) / rho
                grains, stress = Grains(np.array([0.0, 0.5 * a * a])), Stress(np.full(2, k))
                total += own.pair.py_func(parameters(), stress, grains, 0, 1, 0.0, 0.0, scale)
    assert total == pytest.approx(k / rho * lattice_divergence_factor("cubic_spline", 2, 1.5), rel=1e-12)


def test_a_pair_gets_half_of_its_works_and_conducts_by_the_harmonic_mean():
    grains, stress = Grains(np.array([0.1, 0.4])), Stress(np.array([1.0, 3.0]))
    given = own.pair.py_func(parameters(artificial=0.25), stress, grains, 0, 1, 0.2, 0.8, -0.5)
    assert given == pytest.approx(0.5 * (0.2 + 0.25 * 0.8) + 2.0 * 1.5 * (0.1 - 0.4) * -0.5, rel=1e-13)
    assert own.rest(parameters(artificial=0.25), 0.8) == pytest.approx(0.6, rel=1e-15)
    assert own.rest((), 0.8) == 0.8


def test_conductivity_is_that_of_gidaspow():
    expected = granular.gidaspow_conductivity(ALPHA_P, THETA, E, G0, RHO, D)
    assert own.conductivity(parameters(), ALPHA_P, THETA, D, G0) == pytest.approx(expected, rel=1e-14)
    assert own.conductivity(parameters(model="algebraic"), ALPHA_P, THETA, D, G0) == 0.0


def advanced(p, heating=0.0, damping=0.0, dt=0.01):
    return own.advance(p, ALPHA_P, THETA, heating, damping, D, 0.0, 0.0, G0, dt)


def test_collisions_cool_as_haff_found():
    """K of Lun's gamma = 12 (1 - e^2) g0 rho_p alpha_p^2 theta^1.5/(d sqrt(pi)), or of the paper's with alpha_p^1."""
    cooling = 8.0 * (1.0 - E * E) * ALPHA_P * G0 / (D * math.sqrt(math.pi))
    assert advanced(parameters())[0] == pytest.approx(haff_cooling(0.01, THETA, cooling), rel=1e-12)
    printed = advanced(parameters("paper"))[0]
    assert printed == pytest.approx(haff_cooling(0.01, THETA, cooling / ALPHA_P), rel=1e-12)


def test_the_gas_damps_twice_as_fast_as_it_stops_grains_and_heat_is_two_thirds():
    """d theta/dt = -2 beta/(alpha_p rho_p) theta; 3/2 theta grows by the heat. Of elastic grains."""
    elastic = parameters()._replace(restitution=1.0)
    assert advanced(elastic, damping=30.0)[0] == pytest.approx(THETA * math.exp(-2.0 * 30.0 * 0.01), rel=1e-12)
    assert advanced(elastic, heating=0.3)[0] == pytest.approx(THETA + 2.0 / 3.0 * 0.3 * 0.01, rel=1e-12)


def test_what_the_bounds_change_is_told():
    low, gained, *_ = advanced(parameters(least=2e-3))
    high, lost, *_ = advanced(parameters(most=1e-5))
    free = advanced(parameters())[0]
    assert (low, high) == (2e-3, 1e-5)
    assert gained == pytest.approx(2e-3 - free, rel=1e-12) and lost == pytest.approx(1e-5 - free, rel=1e-12)
