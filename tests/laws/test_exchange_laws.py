import math

import numpy as np
import pytest
from exact_solutions import lattice_divergence_factor
from hypothesis import given
from hypothesis import strategies as st

from sdph.laws import exchange, kernels

conductivities = st.one_of(st.just(0.0), st.floats(1e-9, 1e4))


@given(lam=st.floats(0.0, 1e6), more=st.floats(1e-3, 1e3))
def test_fraction_lies_between_none_and_all_and_grows(lam, more):
    assert 0.0 <= exchange.exponential_fraction(lam) <= exchange.exponential_fraction(lam + more) <= 1.0


@given(lam=st.floats(1e-300, 1e-9))
def test_fraction_is_accurate_for_tiny_steps(lam):
    assert exchange.exponential_fraction(lam) == pytest.approx(lam, rel=2e-9)


@given(lam=st.floats(1e-6, 100.0), parts=st.integers(2, 6))
def test_exponential_fraction_composes_exactly(lam, parts):
    rest = (1.0 - exchange.exponential_fraction(lam / parts)) ** parts
    assert rest == pytest.approx(math.exp(-lam), rel=1e-9)


@given(power=st.floats(-10.0, 10.0), relaxations=st.floats(0.01, 50.0), capacity=st.floats(0.1, 10.0))
def test_mean_rise_is_that_of_the_closed_form(power, relaxations, capacity):
    """Rise P/K (1 - exp(-K t/C)), its mean by quadrature; without conductance half of P dt/C."""
    conductance, dt = 2.0, relaxations * capacity / 2.0
    nodes, weights = np.polynomial.legendre.leggauss(60)
    rise = power / conductance * -np.expm1(-0.5 * relaxations * (nodes + 1.0))
    found = exchange.mean_rise(power, conductance, capacity, dt)
    assert found == pytest.approx(0.5 * float(weights @ rise), rel=1e-9, abs=1e-300)
    assert exchange.mean_rise(power, 0.0, capacity, dt) == pytest.approx(0.5 * power * dt / capacity, rel=1e-15)


@given(a=conductivities, b=conductivities)
def test_harmonic_mean_is_symmetric_and_bounded(a, b):
    mean = exchange.harmonic_mean(a, b)
    assert mean == exchange.harmonic_mean(b, a)
    assert 0.999999 * min(a, b) <= mean <= min(2.0 * min(a, b), max(a, b)) * 1.000001
    assert exchange.harmonic_mean(a, 0.0) == 0.0


@given(q=st.floats(0.0, 1.9), k=st.floats(0.1, 1e3), m_i=st.floats(0.1, 2.0), m_j=st.floats(0.1, 2.0))
def test_pair_cools_the_hotter_and_conserves_energy(q, k, m_i, m_j):
    h, density = 0.00375, 1350.0
    r = q * h
    gradient = kernels.cubic_spline_gradient(r, h, kernels.normalisation("cubic_spline", 2, h))
    pair = r * r, 0.01 * h * h, k, 3060.0, density
    to_i, to_j = (exchange.cleary_monaghan(m * gradient, *pair) for m in (m_j, m_i))
    assert to_i <= 0.0 and (to_i < 0.0 or q == 0.0 or r * r == 0.0)
    assert m_i * to_i == pytest.approx(m_j * to_j, rel=1e-13)


@given(alpha_i=st.floats(0.01, 0.6), alpha_j=st.floats(0.01, 0.6))
def test_grains_of_one_material_conduct_by_the_harmonic_mean_of_what_they_fill(alpha_i, alpha_j):
    """Cleary & Monaghan's 4 m_j/(rho_i rho_j) K_i K_j/(K_i + K_j) with K = alpha_p k, rho = alpha_p rho_p."""
    k, rho, pull = 300.0, 3060.0, -7.0
    harmonic = exchange.harmonic_mean(alpha_i * k, alpha_j * k)
    expected = 2.0 * harmonic / (alpha_i * rho * alpha_j * rho) * pull * 4.0 / 4.5
    mean = 0.5 * (alpha_i + alpha_j) * rho
    assert exchange.cleary_monaghan(pull, 4.0, 0.5, k, rho, mean) == pytest.approx(expected, rel=1e-12)


def test_conduction_on_a_lattice_is_the_laplacian():
    """dh_i/dt of T = x^2/2 is k/rho times the lattice's own divergence factor (closed form: Laplacian T = 1)."""
    dx, rho, k = 1.0, 2.0, 3.0
    h = 1.5 * dx
    sigma = kernels.normalisation("cubic_spline", 2, h)
    rate = 0.0
    for a in range(-3, 4):
        for b in range(-3, 4):
            r2 = (a * a + b * b) * dx * dx
            if r2 > 0.0:
                pull = rho * dx * dx * kernels.cubic_spline_gradient(math.sqrt(r2), h, sigma)
                rate += exchange.cleary_monaghan(pull, r2, 0.0, k, rho, rho) * (0.0 - 0.5 * (a * dx) ** 2)
    assert rate == pytest.approx(k / rho * lattice_divergence_factor("cubic_spline", 2, 1.5), rel=1e-12)


@pytest.mark.parametrize("lam", [0.0, 1e-9, 1e-8, 1e-6, 1e-3, 0.7, 3.0, 50.0])
def test_lead_makes_a_drift_of_pull_and_drag(lam):
    """v' = v + f (v_g' - v) + a tau f, exact of dv/dt = (v_g' - v)/tau + a; half a step where drag is slight."""
    f, pull, dt, v, gas = exchange.exponential_fraction(lam), -9.81, 0.3, 2.0, 5.0
    found = v + f * (gas - v - exchange.lead(lam) * pull * dt) + pull * dt
    drifted = pull * dt * (f / lam if lam else 1.0)
    assert found == pytest.approx(v + f * (gas - v) + drifted, rel=1e-9)
    assert lam > 1e-6 or exchange.lead(lam) == pytest.approx(0.5, abs=1e-6)
