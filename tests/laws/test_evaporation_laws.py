import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from reference_values import GAS, JET
from scipy.integrate import solve_ivp

from sdph.laws import evaporation, exact
from sdph.laws.constants import GAS_CONSTANT

ATMOSPHERE = 101325.0  # Pa, CGPM 1954
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


@given(y=st.floats(1e-9, 0.99), gas=st.floats(0.0, 0.99))
def test_spalding_force_is_at_most_its_linearisation(y, gas):
    number = evaporation.spalding_number(y, gas)
    force = evaporation.driving_force_spalding(y, gas, GAS["rho"])
    assert force <= GAS["rho"] * number * (1.0 + 1e-12 * (number > 0.0) - 1e-12 * (number < 0.0))
    assert (force > 0.0) == (number > 0.0) and (force < 0.0) == (number < 0.0)
    if 0.0 < abs(number) < 1e-6:
        assert force == pytest.approx(GAS["rho"] * number, rel=1e-6)


def test_spalding_by_hand():
    """B = 0.25, 1 and -1/3 by mass fractions written down: rho_g ln(1 + B)."""
    for y, gas, expected in ((0.2, 0.0, 0.223143551314), (0.5, 0.0, 0.693147180560), (0.25, 0.5, -0.405465108108)):
        assert evaporation.driving_force_spalding(y, gas, 1.2) == pytest.approx(1.2 * expected, rel=1e-11)


def test_spalding_tends_to_the_linear_law_for_little_vapour():
    """rho_g (Y_s - 0) = W C_s for a trace of vapour in a gas of the same temperature and pressure."""
    w_g, temperature, pressure = 28.0, 300.0, ATMOSPHERE
    mole_fraction = 1e-7
    rho_g = pressure * w_g / (GAS_CONSTANT * temperature)
    y = evaporation.vapour_mass_fraction(mole_fraction, 142.0, w_g)
    surface = evaporation.vapour_concentration(mole_fraction * pressure, temperature)
    spalding = evaporation.driving_force_spalding(y, 0.0, rho_g)
    assert spalding == pytest.approx(evaporation.driving_force_linear(surface, 0.0, 142.0), rel=1e-6)


@given(concentration=st.floats(0.0, 1.0), temperature=temperatures)
def test_partial_pressure_is_the_inverse_of_the_concentration(concentration, temperature):
    pressure = evaporation.partial_pressure(concentration, temperature)
    assert evaporation.vapour_concentration(pressure, temperature) == pytest.approx(concentration, rel=1e-14)


def test_antoine_boils_where_it_reaches_the_pressure():
    temperature = evaporation.boiling_temperature_antoine(ATMOSPHERE, WATER_ANTOINE)
    assert evaporation.saturation_antoine(temperature, WATER_ANTOINE) == pytest.approx(ATMOSPHERE, rel=1e-12)
    assert temperature == pytest.approx(373.15, abs=0.6)


@given(d=st.floats(1e-5, 5e-3), force=st.floats(1e-6, 1.0), rho=st.floats(500.0, 3000.0), c=st.floats(0.0, 300.0))
def test_rates_of_mass_and_diameter_belong_together(d, force, rho, c):
    """dm/dt = rho_p pi/4 d d(d^2)/dt of a sphere."""
    rate = evaporation.gas_exchanged(math.pi / 6.0 * d**3, d, c, 3.79e-6) * force
    square = evaporation.regression_rate(force, 3.79e-6, rho) * (1.0 + c * math.sqrt(d))
    assert rho * math.pi / 4.0 * d * square == pytest.approx(rate, rel=1e-12)
    assert evaporation.regression_rate(-force, 3.79e-6, rho) == 0.0


@given(
    gas=st.floats(300.0, 2000.0), start=st.floats(300.0, 460.0), relaxations=st.floats(0.01, 20.0),
    beside=st.sampled_from([0.0, 0.7, -0.1]),
)  # fmt: skip
def test_at_boiling_a_drop_takes_what_ends_the_step_there(gas, start, relaxations, beside):
    """m c dT/dt = h (T_g - T) + beside - latent F, solved in closed form, ends at 447 K, in gas colder than that too;
    short of it nothing changes."""
    capacity, conductance, latent = 2e-3, 5e-3, 3.0
    dt = relaxations * capacity / conductance
    force = evaporation.boiling_force(start, gas, beside, 447.0, conductance, capacity, latent, 0.0, dt)
    gas += beside / conductance
    held = gas - latent * force / conductance
    end = held + (start - held) * math.exp(-relaxations)
    free = gas + (start - gas) * math.exp(-relaxations)
    assert end == pytest.approx(min(free, 447.0), rel=1e-10)
    assert (force > 0.0) == (free > 447.0)


@pytest.mark.parametrize("relaxations", [0.0, 1e-12, 0.9e-8, 1.1e-8])
def test_a_drop_above_boiling_comes_down_to_it_in_a_step_without_heat_too(relaxations):
    """Heat over latent heat, C (T - T_b) and what little comes in, on both sides of where the law takes its limit."""
    force = evaporation.boiling_force(460.0, 1000.0, 0.0, 447.0, relaxations * 2e-3 / 0.5, 2e-3, 3.0, 1e-3, 0.5)
    assert force == pytest.approx(2e-3 * (13.0 + relaxations * 540.0) / (3.0 * 0.5), rel=1e-7)


@pytest.mark.parametrize("blown", [1e-9, 0.1, 1.0, 3.0, 20.0])
def test_heat_that_gets_past_the_vapour_is_that_of_the_profile_around_a_drop(blown):
    """-4 pi k dT/ds = m' c (T - T_s) + Q, s = 1/r, integrated from the surface on: Q over 2 pi d k (T_g - T_s);
    and ln(1 + B)/B with B = m' c (T_g - T_s)/Q."""
    conductance = 2.0 * math.pi * 1e-3 * 0.025
    flow = blown * conductance  # W/K
    profile = solve_ivp(lambda s, T: -(flow * T + 1.0) / (4.0 * math.pi * 0.025), (2e3, 0.0), [0.0], rtol=1e-11)
    span = profile.y[0, -1]  # K, for Q = 1 W
    share = evaporation.heat_share(blown)
    assert share == pytest.approx(1.0 / (conductance * span), rel=1e-8)
    assert share == pytest.approx(math.log1p(flow * span) / (flow * span), rel=1e-8)


def test_without_vapour_all_heat_gets_there():
    assert [evaporation.heat_share(z) for z in (0.0, 1e-300, 1e3)] == [1.0, 1.0, 0.0]


def test_wet_bulb_with_stefan_flow_balances_heat_and_vapour():
    """Heat that gets past the vapour evaporates it."""
    vapour = lambda T: math.exp(0.05 * (T - 500.0))  # noqa: E731
    T = exact.spalding_wet_bulb(900.0, 890.0, vapour, 0.7, 150.0)
    flow = 0.7 * math.log1p(vapour(T))  # m' c_pv/(h A)
    assert (900.0 - T) * evaporation.heat_share(flow) == pytest.approx(150.0 * flow, rel=1e-9)


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
