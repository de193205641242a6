"""Radiation of grains: Stefan and Boltzmann's cooling curve, exchange with the gas equal on both sides, budgets, order,
nothing when off."""

import itertools
import math

import numpy as np
import pytest
from builders import FULL_BOX, disc, fixed_windows, run, simulation
from grain_boxes import DIAMETER
from lognormal import mass_moment

from sdph import effects
from sdph.case import read as cases
from sdph.effects import OFF
from sdph.effects.gas import radiation, sizes
from sdph.engine import state as particles
from sdph.laws import heat
from sdph.laws import radiation as law
from sdph.laws.constants import STEFAN_BOLTZMANN
from sdph.schema import CaseError
from sdph.study.explain import tables

HOT, END = 1500.0, 10.0
BOX = (*FULL_BOX, "resolution.spacing_mm=10", "run.report_at_s=[]", f"particles.disc.temperature_K={HOT}")
RATE = 0.8 * STEFAN_BOLTZMANN * 6.0 / 285e-6 / (3060.0 * 2470.0)  # 1/(K3 s)


def radiating(surroundings, *more, on=("radiation",), absorptivity=0.0, windows=1, end=END, std=0.0):
    """The disc's grains with radiation, and `heat` of Nu = 2 where it is on."""
    table = cases.to_table(
        disc(
            *BOX,
            f"grains.diameter_std_mm={std!r}",
            f"run.end_time_s={end!r}",
            f"run.output_interval_s={end!r}",
            *fixed_windows(end / windows),
            *more,
        )
    )
    for name in ("heat", "conduction"):
        del table[name]
    table["effects"], table["radiation"] = (
        list(on),
        {"emissivity": 0.8, "surroundings_temperature_K": surroundings, "gas_absorptivity": absorptivity},
    )
    if "heat" in on:
        table["heat"] = {"law": "ranz_marshall"}
    return cases.from_table(table)


@pytest.mark.parametrize("windows", [1, 7])
def test_lone_grains_cool_as_stefan_and_boltzmann_say(tmp_path, windows):
    """In a transparent gas, with cold surroundings: T (1 + 3 k T^3 t)^(-1/3), in any window; the budget closes."""
    done = run(radiating(1e-6, windows=windows), tmp_path)
    expected = HOT * (1.0 + 3.0 * RATE * HOT**3 * END) ** (-1.0 / 3.0)
    error = np.abs(done.state.temperature / expected - 1.0).max()
    print(f"cooling to {expected:.2f} K in {done.windows} windows: error {error:.1e}")
    assert error < 1e-12
    own = done.ledger.summary()
    lost = 2470.0 * done.state.mass.sum() * (HOT - expected)
    assert own["heat_to_surroundings_J"] == pytest.approx(lost, rel=1e-10)
    assert own["energy_drift_rel"] < 1e-10
    np.testing.assert_allclose(done.gas.temperature, 350.0, rtol=1e-14)


@pytest.mark.parametrize(("start", "surroundings"), [(HOT, 600.0), (300.0, 900.0)])
def test_warm_surroundings_are_reached_and_not_passed(tmp_path, start, surroundings):
    """Against the implicit closed form (ln and arctan), and in a window of 1e6 relaxation times."""
    done = run(radiating(surroundings, f"particles.disc.temperature_K={start}", windows=3), tmp_path)
    found, s = float(done.state.temperature.mean()), surroundings
    time = math.log(abs((s + found) / (s - found)) / abs((s + start) / (s - start))) + 2.0 * (
        math.atan(found / s) - math.atan(start / s)
    )
    assert time / (4.0 * s**3 * RATE) == pytest.approx(END, rel=1e-9)
    (tmp_path / "long").mkdir()
    long = run(
        radiating(surroundings, f"particles.disc.temperature_K={start}", end=1e6 / (RATE * s**3)), tmp_path / "long"
    )
    np.testing.assert_allclose(long.state.temperature, surroundings, rtol=1e-14)


def test_grains_of_all_sizes_radiate_by_their_surface():
    """6/d, whose mass average over the log-normal law is known in closed form."""
    case, std = radiating(300.0, std=0.1), 0.1e-3
    state = particles.empty(1, ("temperature", "diameter", "diameter_variance"))
    state.mass[:], state.diameter[:], state.diameter_variance[:] = 2.0, DIAMETER, std**2
    found = radiation.surface(sizes.kernel(case), state, 0)
    assert found == pytest.approx(6.0 * mass_moment(-1.0, DIAMETER, std), rel=1e-3)
    assert radiation.surface(OFF, state, 0) == pytest.approx(6.0 / DIAMETER, rel=1e-15)


@pytest.mark.parametrize("on", [("radiation",), ("radiation", "heat")])
def test_what_grains_radiate_to_the_gas_it_gets(tmp_path, on):
    done = run(radiating(400.0, on=on, absorptivity=0.3, windows=5, end=0.5), tmp_path)
    own = done.ledger.summary()
    print("radiation to gas and surroundings:", {key: f"{own[key]:.1e}" for key in own if key.endswith("_rel")})
    assert own["exchange_energy_mismatch_rel"] < 1e-10 and own["energy_drift_rel"] < 1e-10
    assert done.gas.temperature.min() > 351.0 and own["heat_to_surroundings_J"] > 0.0


def test_the_conductances_add_up():
    """epsilon a sigma (T + T_g)(T^2 + T_g^2) A beside heat's; without `heat` alone."""
    state = particles.empty(1, ("temperature", "diameter", "diameter_variance"))
    state.mass[:], state.diameter[:], state.temperature[:] = 2.0, 285e-6, HOT
    found = radiation.conductance(radiation.kernel(radiating(400.0, absorptivity=0.3)), OFF, state, 0, 350.0)
    assert found == pytest.approx(
        2.0 / 3060.0 * 6.0 / 285e-6 * 0.8 * 0.3 * law.exchange_coefficient(HOT, 350.0), rel=1e-14
    )
    assert radiation.conductance(OFF, OFF, state, 0, 350.0) == 0.0


def test_beside_heat_it_is_second_order_in_the_window(tmp_path):
    """Grains in gas that stays at 350 K (one-way) and surroundings of 600 K: dT/dt = -k (T^4 - T_s^4) + K/C (T_g -
    T)."""
    from scipy.integrate import solve_ivp

    eps = heat.exchange_geometric(0.4, 2.0, 0.0242, 285e-6) / (3060.0 * 2470.0)
    slope = lambda t, T: -RATE * (T**4 - 600.0**4) + eps * (350.0 - T)  # noqa: E731
    end = 2.0
    exact, errors = solve_ivp(slope, (0.0, end), [HOT], method="DOP853", rtol=1e-13).y[0, -1], []
    for windows in (8, 16, 32):
        folder = tmp_path / str(windows)
        folder.mkdir()
        case = radiating(600.0, "coupling.one_way=true", on=("radiation", "heat"), windows=windows, end=end)
        simulated = simulation(case, folder)
        simulated.clock.obey({"radiation": 1e9})
        while simulated.time < end:
            simulated.window()
            simulated.clock.obey({"radiation": 1e9})  # windows of one length
        assert simulated.windows == windows
        errors.append(abs(simulated.state.temperature.mean() - exact))
    orders = [math.log2(a / b) for a, b in itertools.pairwise(errors)]
    print(f"radiation beside heat: errors {errors} K, orders {orders}")
    assert orders[-1] == pytest.approx(2.0, abs=0.1)


def test_its_window_is_a_part_of_its_own_time(tmp_path):
    """Only beside what else changes the temperature; explain prints what the run obeys."""
    alone, beside = radiating(600.0), radiating(600.0, on=("radiation", "heat"))
    one, other = (simulation(case, tmp_path) for case in (alone, beside))
    limit = 0.1 / (4.0 * RATE * HOT**3)
    assert one.clock.limits["radiation"] == math.inf
    assert other.clock.limits["radiation"] == pytest.approx(limit, rel=1e-12)
    (row,) = [row for row in tables.explain(beside)["limits"] if row["cause"] == "radiation"]
    assert row["of"] == "window" and row["largest [s]"] == pytest.approx(limit, rel=1e-12)
    other.window()
    assert other.clock.limits["radiation"] > limit * 1.0001  # as it cools


def test_off_leaves_nothing(tmp_path):
    started = simulation(disc(*BOX), tmp_path)
    handed = started.hand(1e-3)
    assert started.parameters["radiation"] == OFF
    assert len(started.exchange.take(started.state, handed, started.gas_state).lost) == 0
    assert effects.kernel_of(radiation.EFFECT, started.case) == OFF


@pytest.mark.parametrize(
    ("key", "value"),
    [("emissivity", 0.0), ("emissivity", 1.1), ("gas_absorptivity", -0.1), ("surroundings_temperature_K", -1.0)],
)
def test_bad_input_is_one_line(key, value):
    table = cases.to_table(radiating(300.0))
    table["radiation"][key] = value
    with pytest.raises(CaseError, match=f"radiation.{key}") as told:
        cases.from_table(table)
    assert "\n" not in str(told.value)
