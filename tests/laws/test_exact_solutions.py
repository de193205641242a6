"""The exact solutions against what they must conserve, their limits, and direct integration."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from reference_values import BED, GAS
from scipy.integrate import solve_ivp

from sdph.laws import drag, exact, riemann

AIR = GAS["rho"], GAS["mu"]
BED_OF_GRAINS = BED["rho"], 9.81, BED["d"], *AIR
times = st.floats(0.0, 10.0)


@given(t=times, rho_g=st.floats(0.1, 10.0), rho_d=st.floats(0.1, 1e3), K=st.floats(0.0, 1e3))
def test_dusty_box_conserves_momentum_and_never_speeds_up(t, rho_g, rho_d, K):
    v_g, v_d = exact.dusty_box(t, 1.0, -2.0, rho_g, rho_d, K)
    assert rho_g * v_g + rho_d * v_d == pytest.approx(rho_g - 2.0 * rho_d, rel=1e-12, abs=1e-12 * rho_d)
    assert -1e-12 <= v_g - v_d <= 3.0 + 1e-12


@given(t=st.floats(0.0, 1e-2), eps=st.floats(1.0, 1e7))
def test_two_temperatures_conserve_heat(t, eps):
    T_p, T_g = exact.two_way_temperatures(t, 288.0, 350.0, eps, 4.5e3, 493.0)
    assert 4.5e3 * T_p + 493.0 * T_g == pytest.approx(4.5e3 * 288.0 + 493.0 * 350.0, rel=1e-14)
    assert T_p - 1e-9 <= exact.equilibrium_temperature(288.0, 350.0, 4.5e3, 493.0) <= T_g + 1e-9


def test_two_way_tends_to_one_way_for_much_gas():
    T_p, _ = exact.two_way_temperatures(0.1, 288.0, 350.0, 1.6e6, 4.5e6, 1e16)
    assert T_p == pytest.approx(exact.one_way_temperature(0.1, 288.0, 350.0, 1.6e6, 4.5e6), rel=1e-9)


def test_uniform_mode_is_the_two_temperature_problem():
    mode = exact.mode_exchange(1e-4, 0.0, 1.6e6, 4.5e6, 493.0, 6.6e-5, 2e-5, (288.0, 350.0))
    assert tuple(mode) == pytest.approx(exact.two_way_temperatures(1e-4, 288.0, 350.0, 1.6e6, 4.5e6, 493.0), rel=1e-10)


def test_mode_without_exchange_decays_by_conduction():
    mode = exact.mode_exchange(2.0, 60.0, 0.0, 1.0, 1.0, 6e-5, 2e-5, (1.0, 1.0))
    assert tuple(mode) == pytest.approx([exact.cosine_decay(2.0, 60.0, D) for D in (6e-5, 2e-5)], rel=1e-12)


def test_dusty_wave_follows_its_roots():
    """An eigenmode of the system decays with the root of the dispersion relation: the trace is their sum."""
    k, K = 2.0 * math.pi, 3.0
    roots = exact.dusty_wave_roots(k, 1.0, 1.0, 2.0, K)
    assert roots.sum() == pytest.approx(-K * 1.5, rel=1e-12)
    assert np.prod(roots) == pytest.approx(-(k**2) * K / 2.0, rel=1e-12)
    drift = exact.dusty_wave(0.3, 0.0, 1e-4, k, 1.0, 1.0, 2.0, K)
    np.testing.assert_allclose(drift, 1e-4 * math.sin(k * 0.3), rtol=1e-12)


def test_tightly_coupled_wave_moves_at_the_mixture_speed():
    roots = exact.dusty_wave_roots(1.0, 1.0, 1.0, 2.0, 1e7)
    assert roots[-1].imag == pytest.approx(exact.dusty_sound_speed(1.0, 1.0, 2.0), rel=1e-6)


def test_shock_tube_without_dust_is_sod():
    star = riemann.dusty_shock_tube((1.0, 1.0), (0.125, 0.1), 1.4, 0.0)
    # Toro 2009, table 4.2 (test 1); speed from Rankine-Hugoniot
    published = 0.30313, 0.92745, 0.42632, 0.26557, 1.75216
    assert tuple(star) == pytest.approx(published, abs=5e-6)


@given(loading=st.floats(0.0, 20.0))
def test_shock_tube_obeys_rankine_hugoniot(loading):
    star = riemann.dusty_shock_tube((1.0, 1.0), (0.125, 0.1), 1.4, loading)
    mass = 1.0 + loading
    assert star.density_right * (star.shock_speed - star.velocity) == pytest.approx(0.125 * star.shock_speed, rel=1e-10)
    assert 0.125 * mass * star.shock_speed * star.velocity == pytest.approx(star.pressure - 0.1, rel=1e-10)


@given(alpha_p=st.floats(0.2, 0.62), velocity=st.floats(0.0, 2.0))
def test_ergun_column_is_the_drag_law_in_model_a(alpha_p, velocity):
    """-alpha_g dP/dL = beta v_g, v_g = U/alpha_g."""
    alpha_g = 1.0 - alpha_p
    beta = alpha_p * drag.ergun(alpha_p, velocity / alpha_g, BED["d"], *AIR)
    gradient = exact.ergun_gradient(alpha_p, velocity, BED["d"], *AIR)
    assert gradient == pytest.approx(beta * velocity / alpha_g**2, rel=1e-12)


@given(alpha_p=st.floats(0.1, 0.62))
def test_minimum_fluidisation_carries_the_bed(alpha_p):
    velocity = exact.minimum_fluidisation(alpha_p, *BED_OF_GRAINS)
    carried = exact.ergun_gradient(alpha_p, velocity, BED["d"], *AIR)
    assert carried == pytest.approx(exact.buoyant_weight(alpha_p, BED["rho"], AIR[0], 9.81), rel=1e-12)
    assert exact.fluidised_fraction(velocity, *BED_OF_GRAINS) == pytest.approx(alpha_p, rel=1e-10)


@pytest.mark.parametrize("name", sorted(set(drag.LAWS) - {"ergun"}))
@given(alpha_p=st.floats(0.0, 0.5))
def test_settling_slip_balances_weight(name, alpha_p):
    if name == "gidaspow_paper" or name == "wen_yu_paper":
        alpha_p *= 0.2  # denser, Re_p passes its switch, where the force jumps
    slip = exact.settling_slip(drag.LAWS[name], alpha_p, *BED_OF_GRAINS)
    force = drag.LAWS[name](alpha_p, slip, BED["d"], *AIR) * slip
    assert force == pytest.approx((1.0 - alpha_p) * (BED["rho"] - AIR[0]) * 9.81, rel=1e-9)


def test_settling_from_rest_by_direct_integration():
    beta, alpha_p, rho_p, rho_g, g = 3e4, 0.6, 3060.0, 1.225, 9.81
    m_p, m_g = alpha_p * rho_p, (1.0 - alpha_p) * rho_g
    lift = (m_p + m_g) * g  # the pressure gradient that holds the mixture

    def rates(t, v):
        drag_force = beta * (v[0] - v[1])
        return [(0.4 * lift - m_g * g - drag_force) / m_g, (0.6 * lift - m_p * g + drag_force) / m_p]

    path = solve_ivp(rates, (0.0, 1e-5), [0.0, 0.0], rtol=1e-11, atol=1e-14)
    slip = path.y[0, -1] - path.y[1, -1]
    assert exact.settling_slip_at(1e-5, beta, alpha_p, rho_p, rho_g, g) == pytest.approx(slip, rel=1e-8)


@given(stefan=st.floats(1e-6, 5.0))
def test_stefan_front_solves_its_equation(stefan):
    x = exact.stefan_front_coefficient(stefan)
    assert math.sqrt(math.pi) * x * math.exp(x * x) * math.erf(x) == pytest.approx(stefan, rel=1e-9)
