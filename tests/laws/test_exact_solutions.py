"""The exact solutions against what they must conserve, their limits, and direct integration."""

import math

import exact_solutions as solutions
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from reference_values import BED, GAS
from scipy.integrate import solve_ivp

from sdph.effects.gas.drag import LAWS as CHOSEN
from sdph.laws import drag, exact

AIR = GAS["rho"], GAS["mu"]
BED_OF_GRAINS = BED["rho"], 9.81, BED["d"], *AIR


@given(t=st.floats(0.0, 1e-2), eps=st.floats(1.0, 1e7))
def test_two_temperatures_conserve_heat(t, eps):
    T_p, T_g = exact.two_way_temperatures(t, 288.0, 350.0, eps, 4.5e3, 493.0)
    assert 4.5e3 * T_p + 493.0 * T_g == pytest.approx(4.5e3 * 288.0 + 493.0 * 350.0, rel=1e-14)
    assert T_p - 1e-9 <= solutions.equilibrium_temperature(288.0, 350.0, 4.5e3, 493.0) <= T_g + 1e-9


def test_two_way_tends_to_one_way_for_much_gas():
    T_p, _ = exact.two_way_temperatures(0.1, 288.0, 350.0, 1.6e6, 4.5e6, 1e16)
    assert T_p == pytest.approx(exact.one_way_temperature(0.1, 288.0, 350.0, 1.6e6, 4.5e6), rel=1e-9)


def test_dusty_wave_follows_its_roots():
    """The trace of the system is the sum of the roots of its dispersion relation, its determinant their product."""
    k, K = 2.0 * math.pi, 3.0
    roots = solutions.dusty_wave_roots(k, 1.0, 1.0, 2.0, K)
    assert roots.sum() == pytest.approx(-K * 1.5, rel=1e-12)
    assert np.prod(roots) == pytest.approx(-(k**2) * K / 2.0, rel=1e-12)


def test_tightly_coupled_wave_moves_at_the_mixture_speed():
    roots = solutions.dusty_wave_roots(1.0, 1.0, 1.0, 2.0, 1e7)
    assert roots[-1].imag == pytest.approx(1.0 / math.sqrt(3.0), rel=1e-6)


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


@pytest.mark.parametrize("name", sorted({*CHOSEN, "wen_yu_paper"} - {"ergun"}))
@given(alpha_p=st.floats(0.0, 0.5))
def test_settling_slip_balances_weight(name, alpha_p):
    if name == "gidaspow_paper" or name == "wen_yu_paper":
        alpha_p *= 0.2  # denser, Re_p passes its switch, where the force jumps
    slip = solutions.settling_slip(getattr(drag, name), alpha_p, *BED_OF_GRAINS)
    force = getattr(drag, name)(alpha_p, slip, BED["d"], *AIR) * slip
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
    assert solutions.settling_slip_at(1e-5, beta, alpha_p, rho_p, rho_g, g) == pytest.approx(slip, rel=1e-8)
