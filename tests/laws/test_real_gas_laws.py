"""Equations of state and saturation against values that were made apart; limits."""

import pytest
from gel_values import PAPER, VALUES, VAPOUR

from sdph.laws import evaporation, real_gas
from sdph.laws.constants import GAS_CONSTANT

FOUND = {
    "srk_a_alpha_530": lambda: real_gas.attraction(VAPOUR, 530.0) * 1e-6,  # of a mole
    "srk_a_alpha_489.5": lambda: real_gas.attraction(VAPOUR, 489.5) * 1e-6,
    "srk_b": lambda: VAPOUR.covolume * 1e-3,
    "srk_p_V0.0155_T530": lambda: real_gas.pressure(VAPOUR, 15.5, 530.0),
    "srk_p_V0.035_T490": lambda: real_gas.pressure(VAPOUR, 35.0, 490.0),
    "srk_density_p250000_T530": lambda: real_gas.density(VAPOUR, 2.5e5, 530.0),
    "srk_density_p101325_T489.5": lambda: real_gas.density(VAPOUR, 101325.0, 489.5),
    "rk_paper_p_V0.01": lambda: real_gas.pressure(PAPER, 10.0, 288.0),
    "antoine_p_500": lambda: real_gas.saturation_pressure(VAPOUR, 500.0),
    "antoine_p_530": lambda: real_gas.saturation_pressure(VAPOUR, 530.0),
    "antoine_T_101325": lambda: real_gas.saturation_temperature(VAPOUR, 101325.0),
    "antoine_T_251325": lambda: real_gas.saturation_temperature(VAPOUR, 251325.0),
    "latent_heat_from_slope_510": lambda: real_gas.latent_heat_of_curve(VAPOUR, 510.0, 590.0),
    "clausius_clapeyron_p_530": lambda: evaporation.saturation_clausius_clapeyron(
        530.0, (101325.0, 489.5, 2.5e5, 170.33)
    ),
}


@pytest.mark.parametrize("name", FOUND)
def test_reference_values(name):
    assert FOUND[name]() == pytest.approx(VALUES[name], rel=1e-8)


@pytest.mark.parametrize("v", [VAPOUR, PAPER])
@pytest.mark.parametrize(("pressure", "temperature"), [(10.0, 300.0), (1e5, 490.0), (1e6, 600.0), (5e6, 700.0)])
def test_the_density_gives_the_pressure_back(v, pressure, temperature):
    """From the one root of a hot gas to the largest of three below the critical point."""
    volume = v.molar_mass / real_gas.density(v, pressure, temperature)
    assert real_gas.pressure(v, volume, temperature) == pytest.approx(pressure, rel=1e-10)


def test_a_thin_vapour_is_an_ideal_gas():
    ideal = 10.0 * VAPOUR.molar_mass / (GAS_CONSTANT * 500.0)
    assert real_gas.density(VAPOUR, 10.0, 500.0) == pytest.approx(ideal, rel=2e-5)


def test_the_paper_s_constants_have_another_critical_point():
    """Slope and curvature of its isotherm vanish at 346 K and 5.1 MPa, Z = 1/3; 0.42748 and 0.08664 have five
    digits."""
    T, p = VALUES["rk_paper_implied_Tc"], VALUES["rk_paper_implied_pc"]
    volume = GAS_CONSTANT * T / (3.0 * p)
    around = [real_gas.pressure(PAPER, volume * f, T) for f in (0.999, 1.0, 1.001)]
    assert around == pytest.approx([p] * 3, rel=1e-5)
    assert around == pytest.approx([around[1]] * 3, rel=2e-8)


def test_of_three_roots_the_vapour_is_the_thinnest():
    """Below the critical point the cubic has a liquid too; at 1 bar and 400 K the largest root is the vapour's."""
    assert 0.9 < real_gas.compressibility(VAPOUR, 1e4, 400.0) < 1.0
