import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sdph.laws import exchange, kernels

FRACTIONS = [exchange.backward_euler_fraction, exchange.exponential_fraction]
conductivities = st.one_of(st.just(0.0), st.floats(1e-9, 1e4))


@pytest.mark.parametrize("fraction", FRACTIONS)
@given(lam=st.floats(0.0, 1e6), more=st.floats(1e-3, 1e3))
def test_fraction_lies_between_none_and_all_and_grows(fraction, lam, more):
    assert 0.0 <= fraction(lam) <= fraction(lam + more) <= 1.0


@pytest.mark.parametrize("fraction", FRACTIONS)
@given(lam=st.floats(1e-300, 1e-9))
def test_fraction_is_accurate_for_tiny_steps(fraction, lam):
    assert fraction(lam) == pytest.approx(lam, rel=2e-9)


@given(lam=st.floats(1e-6, 100.0), parts=st.integers(2, 6))
def test_exponential_fraction_composes_exactly(lam, parts):
    rest = (1.0 - exchange.exponential_fraction(lam / parts)) ** parts
    assert rest == pytest.approx(math.exp(-lam), rel=1e-9)


@given(lam=st.floats(1e-6, 100.0))
def test_backward_euler_lags_the_exact_exchange(lam):
    assert exchange.backward_euler_fraction(lam) < exchange.exponential_fraction(lam)


@given(a=conductivities, b=conductivities)
def test_harmonic_mean_is_symmetric_and_bounded(a, b):
    mean = exchange.harmonic_conductivity(a, b)
    assert mean == exchange.harmonic_conductivity(b, a)
    assert 0.999999 * min(a, b) <= mean <= min(2.0 * min(a, b), max(a, b)) * 1.000001
    assert exchange.harmonic_conductivity(a, 0.0) == 0.0


@given(
    q=st.floats(0.0, 1.9),
    k_i=st.floats(0.1, 1e3),
    k_j=st.floats(0.1, 1e3),
    m_i=st.floats(0.1, 2.0),
    m_j=st.floats(0.1, 2.0),
)
def test_pair_cools_the_hotter_and_conserves_energy(q, k_i, k_j, m_i, m_j):
    h, rho_i, rho_j = 0.00375, 1800.0, 900.0
    r = q * h
    gradient = kernels.cubic_spline_gradient(r, h, kernels.normalisation("cubic_spline", 2, h))
    to_i = exchange.cleary_monaghan(m_j, rho_i, rho_j, k_i, k_j, r * r, gradient, 0.01 * h * h)
    to_j = exchange.cleary_monaghan(m_i, rho_j, rho_i, k_j, k_i, r * r, gradient, 0.01 * h * h)
    assert to_i <= 0.0 and (to_i < 0.0 or q == 0.0 or r * r == 0.0)
    assert m_i * to_i == pytest.approx(m_j * to_j, rel=1e-13)


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
                gradient = kernels.cubic_spline_gradient(math.sqrt(r2), h, sigma)
                rate += exchange.cleary_monaghan(rho * dx * dx, rho, rho, k, k, r2, gradient, 0.0) * (
                    0.0 - 0.5 * (a * dx) ** 2
                )
    expected = k / rho * kernels.lattice_divergence_factor("cubic_spline", 2, 1.5)
    assert rate == pytest.approx(expected, rel=1e-12)
