"""Burn-off of a grain in gas that stays as it is: closed forms, its temperature, sizes; what cannot be says so."""

import math

import numpy as np
import pytest
from char_boxes import BOTH, CHAR, DENSITY, DIAMETER, GAS, HEAT, OXIDANT, RATE, RATIO, D, char, finished, started
from scipy.integrate import solve_ivp

from sdph.case import read as cases
from sdph.effects.gas import reaction, sizes
from sdph.schema import CaseError


@pytest.mark.parametrize("windows", [1, 7])
def test_without_a_film_the_diameter_falls_evenly(tmp_path, windows):
    """d = d_0 - 2 k_s rho_g Y t/(nu rho_p), whatever the windows."""
    burn_out = RATIO * DENSITY * DIAMETER / (2.0 * RATE * GAS * OXIDANT)
    case = char(end=0.5 * burn_out, windows=windows, reaction={"film": False})
    run = finished(case, tmp_path)
    np.testing.assert_allclose(run.state.diameter, 0.5 * DIAMETER, rtol=1e-12)
    np.testing.assert_allclose(run.state.mass, 0.125 * run.state.born_mass, rtol=1e-12)


def test_a_fast_surface_has_the_d2_law(tmp_path):
    """d^2 = d_0^2 - 8 D rho_g Y t/(nu rho_p) in gas at rest, where the film alone hinders."""
    burn_out = RATIO * DENSITY * DIAMETER**2 / (8.0 * D * GAS * OXIDANT)
    run = finished(char(end=0.75 * burn_out, windows=5, reaction={"rate_m_s": 1e8}), tmp_path)
    np.testing.assert_allclose(run.state.diameter, 0.5 * DIAMETER, rtol=1e-6)


@pytest.mark.parametrize("slip", [0.0, 3.0])
def test_surface_and_film_in_series(tmp_path, slip):
    """dd/dt = -2 k rho_g Y/(nu rho_p), 1/k = 1/k_s + d/(Sh D), integrated apart; Arrhenius' k_s at the grain's
    temperature. Without drag the grains keep their speed."""
    k_s = 5.0 * math.exp(-3000.0 / 1100.0)

    def fall(t, d):
        reynolds, schmidt = GAS * slip * d / 4.5e-5, 4.5e-5 / (GAS * D)
        sherwood = 2.0 + 0.6 * math.sqrt(reynolds) * schmidt ** (1.0 / 3.0)
        return -2.0 * GAS * OXIDANT / (RATIO * DENSITY) / (1.0 / k_s + d / (sherwood * D))

    end = 4.0
    expected = solve_ivp(lambda t, d: [fall(t, d[0])], (0.0, end), [DIAMETER], rtol=1e-10, atol=1e-14).y[0, -1]
    case = char(end=end, windows=3, reaction={"rate_m_s": 5.0, "activation_temperature_K": 3000.0})
    run = started(case, tmp_path)
    run.gas_state.fields["velocity"][:, 0] = slip
    run.gas.advance = lambda dt, sources: run.gas_state
    while run.grains.time < end * (1.0 - 1e-12):
        run.window()
    assert 0.3 * DIAMETER < expected < 0.9 * DIAMETER
    np.testing.assert_allclose(run.state.diameter, expected, rtol=2e-6)


def test_the_order_in_the_window_is_the_first_where_temperatures_change(tmp_path, monkeypatch):
    """A grain that warms as it burns, five times as fast at the end, against its two equations integrated apart."""
    monkeypatch.setattr(reaction, "PART", math.inf)  # windows as given
    end, given = 0.4, {"rate_m_s": 150.0, "activation_temperature_K": 8000.0, "heat_J_kg": HEAT}

    def both(t, y):
        d, hot = y
        k = 1.0 / (math.exp(8000.0 / hot) / 150.0 + d / (2.0 * D))
        taken, h = k * GAS * OXIDANT, 2.0 * 0.07 / d
        warming = 6.0 / (d * DENSITY * CHAR) * (HEAT * taken / RATIO - h * (hot - 1100.0))
        return [-2.0 * taken / (RATIO * DENSITY), warming]

    expected = solve_ivp(both, (0.0, end), [DIAMETER, 1100.0], rtol=1e-11, atol=1e-16).y[0, -1]
    off = []
    for count in (20, 40, 80):
        (tmp_path / str(count)).mkdir()
        run = finished(char(BOTH, end=end, windows=count, reaction=given), tmp_path / str(count))
        off.append((run.state.diameter[0] - expected) / (DIAMETER - expected))
    print("loss of diameter in 20, 40, 80 windows, off by", off)
    assert abs(off[2]) < 0.02
    assert off[0] / off[1] == pytest.approx(2.0, rel=0.15) and off[1] / off[2] == pytest.approx(2.0, rel=0.1)


@pytest.mark.parametrize("change", [1.0, -1.0])
def test_a_window_changes_the_rate_by_a_tenth_at_most(tmp_path, change):
    """T_a dT/T^2, by the warming or cooling of the window before; none where k_s does not ask for the temperature."""
    given = {"rate_m_s": 150.0, "activation_temperature_K": 8000.0, "heat_J_kg": HEAT}
    run = started(char(BOTH, reaction=given), tmp_path)
    s, p = run.state, run.parameters["reaction"]
    k = 1.0 / (math.exp(8000.0 / 1100.0) / 150.0 + DIAMETER / (2.0 * D))
    heating = 6.0 / (DIAMETER * DENSITY * CHAR) * HEAT * k * GAS * OXIDANT / RATIO  # K/s, at the start
    assert run.clock.limits["reaction"] == pytest.approx(0.1 * 1100.0**2 / (8000.0 * heating))
    s.warming[:] = change * 5000.0
    assert reaction.window_limit(p, run.case, s) == pytest.approx(0.1 * 1100.0**2 / (8000.0 * 5000.0))
    assert reaction.window_limit(p._replace(activation_temperature=0.0), run.case, s) == math.inf


def test_a_run_away_is_followed_whatever_the_largest_window(tmp_path):
    """Grains that light up in 40 windows and in 4 are as large at the end, to 2 % of what they lost."""
    given, left = {"rate_m_s": 150.0, "activation_temperature_K": 8000.0, "heat_J_kg": HEAT}, []
    for count in (4, 40):
        (tmp_path / str(count)).mkdir()
        run = finished(char(BOTH, end=0.4, windows=count, reaction=given), tmp_path / str(count))
        left.append(run.state.diameter[0])
    assert DIAMETER - left[0] == pytest.approx(DIAMETER - left[1], rel=0.02)


def test_a_grain_warms_until_the_film_takes_the_heat_off(tmp_path):
    """T - T_g = Q k rho_g Y/(nu h), h = 2 k_g/d, in gas that stays as it is; after many times of warming."""
    case = char(BOTH, end=0.2, windows=40, reaction={"heat_J_kg": HEAT, "rate_m_s": 0.05})
    run = finished(case, tmp_path)
    d = run.state.diameter[0]
    k = 1.0 / (1.0 / 0.05 + d / (2.0 * D))
    rise = HEAT * k * GAS * OXIDANT / RATIO / (2.0 * 0.07 / d)
    np.testing.assert_allclose(run.state.temperature - 1100.0, rise, rtol=5e-3)


def test_sizes_shrink_with_the_mass(tmp_path):
    """A spread of sizes: the particle's mass is what its own sizes say, and each of them has burned by its own law."""
    std, end = 0.3 * DIAMETER, 6.0
    run = finished(char(end=end, windows=3, grains={"diameter_std_mm": std * 1e3}), tmp_path)
    state, p = run.state, run.exchange.sizes_p
    left, mean, variance = sizes.remaining(sizes.birth(p, state, 0))
    whole = sizes.remaining(sizes.birth_of(DIAMETER, std**2, 0.0, 0.0))[0]
    assert state.mass[0] / state.born_mass[0] == pytest.approx(left / whole, rel=1e-9)
    assert state.diameter[0] == pytest.approx(mean, rel=1e-12)
    assert state.diameter_variance[0] == pytest.approx(variance, rel=1e-9)

    def after(d):  # d/k_s + d^2/(4 D) falls by 2 rho_g Y t/(nu rho_p)
        left = d / RATE + d * d / (4.0 * D) - 2.0 * GAS * OXIDANT * end / (RATIO * DENSITY)
        root = -2.0 * D / RATE + np.sqrt((2.0 * D / RATE) ** 2 + 4.0 * D * np.maximum(left, 0.0))
        return np.where(left > 0.0, root, 0.0)

    spread = math.sqrt(math.log1p((std / DIAMETER) ** 2))
    z = np.linspace(-8.0, 12.0, 200_001)
    born = DIAMETER * np.exp(spread * z - 0.5 * spread**2)
    number = np.exp(-0.5 * z * z)
    expected = (number * after(born) ** 3).sum() / (number * born**3).sum()
    assert 0.1 < expected < 0.9
    assert state.mass[0] / state.born_mass[0] == pytest.approx(expected, rel=1e-5)


@pytest.mark.parametrize(("changes", "words"), [
    ({"vapour": None}, r"needs \[vapour\]"),
    ({"effects": ("reaction", "evaporation"), "evaporation": {"latent_heat_J_kg": 0.0,
      "saturation_pressure_Pa": 100.0}}, "holds reaction and evaporation: .* one species"),
    ({"effects": ("reaction", "break_up"), "break_up": {"liquid_viscosity_Pa_s": 1e-3, "products": "equal"},
      "grains": {"surface_tension_N_m": 0.02}}, "reaction and break_up"),
    ({"reaction": {"heat_J_kg": 1.0}}, "add heat to effects"),
    ({"coupling": {"film": True}}, "coupling.film"),
])  # fmt: skip
def test_a_reaction_that_cannot_be_says_so(tmp_path, changes, words):
    changes = dict(changes)
    effects = changes.pop("effects", ("reaction",))
    if changes.get("vapour", 1) is None:
        given = cases.to_table(char())
        del given["vapour"]
        case = cases.from_table(given)
    else:
        case = char(effects, **changes)
    with pytest.raises(CaseError, match=words):
        started(case, tmp_path)


def test_off_leaves_nothing_behind(tmp_path):
    run = started(char(("heat",)), tmp_path)
    assert "carrier" not in run.exchange.sources and run.exchange.losing is None
    assert len(run.state.lost_kinetic) == 0 and not any("D10" in name for name in run.row())
    assert "reaction" not in run.clock.limits
