import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from reference_values import GAS, JET

from sdph.laws import evaporation, exact
from sdph.laws.constants import ATMOSPHERE, GAS_CONSTANT

CLAPEYRON = (JET["psat"], 294.3, JET["hfg"], JET["W"])
WATER_ANTOINE = (9.6543, 1435.264, -64.848)  # log10 Pa, K, K: Stull 1947 as in the NIST WebBook, 256-373 K
temperatures = st.floats(250.0, 450.0)
part = st.floats(0.0, 1.0)


@given(temperature=temperatures)
def test_clausius_clapeyron_satisfies_its_equation(temperature):
    step = 1e-3
    high, low = (evaporation.saturation_clausius_clapeyron(temperature + s, CLAPEYRON) for s in (step, -step))
    slope = (math.log(high) - math.log(low)) / (2.0 * step)
    assert slope == pytest.approx(JET["hfg"] * JET["W"] / (GAS_CONSTANT * temperature**2), rel=1e-6)


@given(pressure=st.floats(1e3, 1e6))
def test_boiling_temperature_is_where_saturation_reaches_the_pressure(pressure):
    temperature = evaporation.boiling_temperature(pressure, CLAPEYRON)
    assert evaporation.saturation_clausius_clapeyron(temperature, CLAPEYRON) == pytest.approx(pressure, rel=1e-11)


def test_water_boils_at_one_atmosphere():
    assert evaporation.saturation_antoine(373.15, WATER_ANTOINE) == pytest.approx(ATMOSPHERE, rel=0.02)
    assert evaporation.saturation_antoine(293.15, WATER_ANTOINE) == pytest.approx(2339.0, rel=0.02)  # IAPWS-95


@given(temperature=temperatures)
def test_constant_saturation(temperature):
    assert evaporation.saturation_constant(temperature, (1329.0,)) == 1329.0


@given(x=part, w=st.floats(2.0, 300.0), w_g=st.floats(2.0, 300.0))
def test_mole_and_mass_fractions_are_inverses(x, w, w_g):
    y = evaporation.vapour_mass_fraction(x, w, w_g)
    assert 0.0 <= y <= 1.0
    assert evaporation.vapour_mole_fraction(y, w, w_g) == pytest.approx(x, rel=1e-12, abs=1e-300)
    assert x * w + (1.0 - x) * w_g == pytest.approx(evaporation.mixture_molar_mass(y, w, w_g), rel=1e-12)


@given(surface=st.floats(0.0, 1e-2), gas=st.floats(0.0, 1e-2))
def test_flux_follows_the_difference_and_nothing_condenses(surface, gas):
    flux = evaporation.molar_flux(0.01, surface, gas)
    assert flux == (0.01 * (surface - gas) if surface > gas else 0.0)
    assert evaporation.mass_flux_linear(0.01, surface, gas, 142.284) == pytest.approx(142.284 * flux, rel=1e-15)


@given(y=st.floats(1e-9, 0.99), gas=st.floats(0.0, 0.99))
def test_spalding_flux_is_at_most_its_linearisation(y, gas):
    number = evaporation.spalding_number(y, gas)
    flux = evaporation.mass_flux_spalding(0.01, GAS["rho"], number)
    assert 0.0 <= flux <= 0.01 * GAS["rho"] * max(0.0, number) * (1.0 + 1e-12)
    assert (flux > 0.0) == (number > 0.0)
    if 0.0 < number < 1e-6:
        assert flux == pytest.approx(0.01 * GAS["rho"] * number, rel=1e-6)


def test_spalding_tends_to_the_linear_law_for_little_vapour():
    """rho_g (Y_s - 0) = W C_s for a trace of vapour in a gas of the same temperature and pressure."""
    w_g, temperature, pressure = 28.0, 300.0, ATMOSPHERE
    mole_fraction = 1e-7
    rho_g = pressure * w_g / (GAS_CONSTANT * temperature)
    y = evaporation.vapour_mass_fraction(mole_fraction, 142.0, w_g)
    surface = evaporation.vapour_concentration(mole_fraction * pressure, temperature)
    spalding = evaporation.mass_flux_spalding(0.01, rho_g, evaporation.spalding_number(y, 0.0))
    assert spalding == pytest.approx(evaporation.mass_flux_linear(0.01, surface, 0.0, 142.0), rel=1e-6)


@given(d=st.floats(1e-5, 5e-3), flux=st.floats(1e-8, 1.0), rho=st.floats(500.0, 3000.0))
def test_rates_of_mass_and_diameter_belong_together(d, flux, rho):
    mass = rho * math.pi / 6.0 * d**3
    rate = evaporation.mass_rate(flux, d)
    assert evaporation.relative_mass_rate(flux, d, rho) * mass == pytest.approx(rate, rel=1e-12)
    assert 3.0 * mass / d * evaporation.diameter_rate(flux, rho) == pytest.approx(rate, rel=1e-12)
    assert 2.0 * d * evaporation.diameter_rate(flux, rho) == pytest.approx(-evaporation.regression_rate(flux, d, rho))


@given(d=st.floats(1e-5, 5e-3), loss=st.floats(0.0, 3.0), parts=st.integers(2, 6))
def test_d2_step_does_not_depend_on_how_time_is_cut(d, loss, parts):
    rate, cut = loss * d * d, d
    for _ in range(parts):
        cut = evaporation.d2_step(cut, rate, 1.0 / parts)
    whole = evaporation.d2_step(d, rate, 1.0)
    assert cut**2 == pytest.approx(whole**2, abs=1e-14 * d * d)
    assert (whole == 0.0) == (d * d - rate <= 0.0)


def test_d2_law_ends_at_its_life():
    rate = 3e-9
    life = exact.d2_law_life(3e-3, rate)
    assert exact.d2_law_diameter(0.75 * life, 3e-3, rate) == pytest.approx(1.5e-3, rel=1e-12)
    assert exact.d2_law_diameter(1.000001 * life, 3e-3, rate) == 0.0


@given(gas=st.floats(300.0, 800.0))
def test_boiling_takes_the_heat_that_comes_in(gas):
    flux = evaporation.boiling_flux(50.0, gas, 447.0, JET["hfg"])
    assert flux * JET["hfg"] == pytest.approx(50.0 * max(0.0, gas - 447.0), rel=1e-13)
    shielded = evaporation.boiling_flux_spalding(50.0, gas, 447.0, JET["hfg"], 2000.0)
    assert 0.0 <= shielded <= flux and (shielded > 0.0) == (gas > 447.0)
    assert evaporation.boiling_flux_spalding(50.0, gas, 447.0, JET["hfg"], 1e-6) == pytest.approx(flux, rel=1e-6)


def test_wet_bulb_balances_heat_and_vapour():
    def saturation(temperature):
        return evaporation.saturation_clausius_clapeyron(temperature, CLAPEYRON)

    args = JET["D"], JET["W"], JET["hfg"], GAS["k"]
    t = exact.wet_bulb_temperature(350.0, saturation, *args)
    vapour = JET["D"] * JET["W"] * JET["hfg"] * evaporation.vapour_concentration(saturation(t), t)
    assert GAS["k"] * (350.0 - t) == pytest.approx(vapour, rel=1e-10)
    with pytest.raises(ValueError, match="no wet-bulb temperature"):
        exact.wet_bulb_temperature(350.0, lambda T: 1e6, *args)


def test_stefan_tube_is_diffusion_for_little_vapour():
    flux = exact.stefan_tube_flux(ATMOSPHERE, 1e-5, 300.0, 0.1, 1e-6, 0.0)
    assert flux == pytest.approx(1e-5 / 0.1 * evaporation.vapour_concentration(1e-6 * ATMOSPHERE, 300.0), rel=1e-6)
    assert exact.stefan_tube_flux(ATMOSPHERE, 1e-5, 300.0, 0.1, 0.5, 0.0) > 0.5 / 1e-6 * flux
