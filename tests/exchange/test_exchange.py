"""Heat exchange with a gas at rest: equal on both sides, stable, first order in the window, exact where it can be."""

import json
import math
from pathlib import Path

import exact_solutions as solutions
import numpy as np
import pytest
from builders import FULL_BOX, PLAIN_EXCHANGE, disc, fixed_windows, run, simulation
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from sdph.engine import state as particles
from sdph.laws import exact, grain_sizes, heat
from sdph.running import history

REFERENCE = {
    value["id"]: value["expected"]
    for value in json.loads((Path(__file__).parents[1] / "data" / "sdph_reference_values.json").read_text())["values"]
}
ONE_WAY = ("coupling.one_way=true",)
CHAINS = settings(max_examples=12, suppress_health_check=[HealthCheck.function_scoped_fixture])

# The lumped problem: alpha_p = 0.6 in a box that is one cell, Nu = 2.
ALPHA_P = 0.6
GRAIN = exact.volumetric_heat_capacity(ALPHA_P, 3060.0, 2470.0)
GAS = exact.volumetric_heat_capacity(1.0 - ALPHA_P, 1.225, 1006.43)
EPS = ALPHA_P * 6.0 * 2.0 * 0.0242 / 285e-6**2
RATE = exact.exchange_rate(EPS, GRAIN, GAS)


def lumped(*overrides):
    return disc(*FULL_BOX, *PLAIN_EXCHANGE, "resolution.spacing_mm=5", "run.report_at_s=[]", *overrides)


def ending(time, windows=1):
    """Overrides of a run to `time` [s] in equal windows."""
    return (f"run.end_time_s={time!r}", f"run.output_interval_s={time!r}", *fixed_windows(time / windows))


def content(simulated):
    """Heat [J per metre of depth] of the grains and of the gas."""
    case, s, gas = simulated.case, simulated.state, simulated.gas
    of_gas = gas.alpha * gas.temperature * gas.mesh.volumes * case.gas.density * case.gas.heat_capacity
    return math.fsum(s.mass * s.temperature) * case.grains.heat_capacity, math.fsum(of_gas)


@CHAINS
@given(
    lam=st.floats(1e-3, 1e3),
    windows=st.integers(1, 5),
    gas=st.floats(200.0, 2000.0),
    law=st.sampled_from(["gunn", "gunn_interstitial", "ranz_marshall"]),
    closure=st.sampled_from(["geometric", "paper"]),
    std=st.sampled_from([0.0, 0.1]),
)
def test_what_one_side_loses_the_other_gains(tmp_path, lam, windows, gas, law, closure, std):
    """Energy closed to 1e-12 of what was exchanged, and nobody passes the other, from 1e-3 to 1e3 relaxation times."""
    case = disc(
        "resolution.spacing_mm=10",
        "resolution.cell_mm=25",
        f"gas.temperature_K={gas!r}",
        f"heat.law={law!r}",
        f"heat.closure={closure!r}",
        f"grains.diameter_std_mm={std!r}",
        "run.report_at_s=[]",
        *ending(windows * lam / RATE, windows),
    )
    started = simulation(case, tmp_path)
    before = content(started)
    cold, hot = sorted((288.0, gas))
    while started.time < case.run.end_time:
        started.window()
        assert (started.state.temperature >= cold * (1.0 - 1e-13)).all() and (
            started.state.temperature <= hot * (1.0 + 1e-13)
        ).all()
        assert (started.gas.temperature >= cold * (1.0 - 1e-13)).all() and (
            started.gas.temperature <= hot * (1.0 + 1e-13)
        ).all()
    started.ledger.table.close()
    summary = started.ledger.summary()
    assert started.windows == windows
    assert summary["heat_exchanged_J"] > 0.0 or gas == 288.0
    assert summary["exchange_energy_mismatch_rel"] <= 1e-12
    after = content(started)
    assert math.fsum((*after, *(-b for b in before))) == pytest.approx(0.0, abs=1e-14 * sum(before))


@pytest.mark.parametrize("dt", [1e-6, 1e-3, 1.0, 1e3])
def test_one_way_is_exact_in_any_window(tmp_path, dt):
    """Gas that feels nothing: the exponential itself, in one window or in three."""
    for windows in (1, 3):
        folder = tmp_path / str(windows)
        folder.mkdir()
        done = run(lumped(*ONE_WAY, *ending(dt, windows)), folder)
        expected = exact.one_way_temperature(dt, 288.0, 350.0, EPS, GRAIN)
        np.testing.assert_allclose(done.state.temperature, expected, rtol=1e-12)


@pytest.mark.parametrize(
    ("closure", "key"), [("paper", "disc_oneway_Tp_paper_t0.1"), ("geometric", "disc_oneway_Tp_geom_t0.1")]
)
def test_one_way_disc_reaches_the_reference(tmp_path, closure, key):
    """The heart of the disc (r < 0.09 m) is uniform and has the published temperature at 0.1 s; half the resolution."""
    case = disc("resolution.spacing_mm=5", "resolution.cell_mm=10", f"heat.closure={closure!r}", *ONE_WAY)
    done = run(case, tmp_path)
    assert history.probe(done, (0.25, 0.25))["temperature_K"] == pytest.approx(REFERENCE[key], abs=1e-6)
    heart = np.hypot(done.state.x - 0.25, done.state.y - 0.25) < 0.06
    assert np.ptp(done.state.temperature[heart]) < 1e-2


def rise_after(folder, time, windows):
    done = run(lumped(*ending(time, windows)), folder, cells=(1, 1))
    assert done.windows == windows
    assert np.ptp(done.state.temperature) < 1e-10
    return done.state.temperature.mean() - 288.0


def test_two_way_is_first_order_in_the_window(tmp_path):
    """The lumped two-temperature problem at one relaxation time, with 8 to 128 windows."""
    time, errors = 1.0 / RATE, []
    expected = exact.two_way_rise(time, 288.0, 350.0, EPS, GRAIN, GAS)
    counts = [8, 16, 32, 64, 128]
    for windows in counts:
        folder = tmp_path / str(windows)
        folder.mkdir()
        errors.append(abs(rise_after(folder, time, windows) / expected - 1.0))
    order = -np.polyfit(np.log(counts), np.log(errors), 1)[0]
    assert 0.9 <= order <= 1.1
    assert errors[-1] < 0.01


def test_window_of_a_thousand_relaxation_times_lands_on_equilibrium(tmp_path):
    rise = rise_after(tmp_path, 1e3 / RATE, 1)
    full = solutions.equilibrium_temperature(288.0, 350.0, GRAIN, GAS) - 288.0
    assert rise == pytest.approx(full, rel=2e-3)  # backward Euler leaves 1/(1 + 1000)


@pytest.mark.parametrize("tolerance", [1e-4, 1e-5])
def test_adaptive_windows_follow_the_lumped_solution(tmp_path, tolerance):
    """The rise within 1 % at 1, 2, 5 and 20 ms, with few windows; ten times the tolerance costs about a third of
    them."""
    times = [0.001, 0.002, 0.005, 0.02]
    case = lumped(
        "run.end_time_s=0.1",
        "run.output_interval_s=0.1",
        f"run.report_at_s={times}",
        f"coupling.window_tolerance={tolerance}",
    )
    simulated = simulation(case, tmp_path, cells=(1, 1))
    seen = {}
    while simulated.time < case.run.end_time:
        simulated.window()
        seen[simulated.time] = simulated.state.temperature.mean() - 288.0
    assert set(times) <= set(seen)
    for time in times:
        assert seen[time] == pytest.approx(exact.two_way_rise(time, 288.0, 350.0, EPS, GRAIN, GAS), rel=0.01)
    assert simulated.windows < 4.0 / math.sqrt(tolerance)


def test_two_way_disc_follows_the_lumped_solution_in_its_heart(tmp_path):
    """Several cells, Gunn's law: the rise of the centre within 1 % at 1 ms, as the reference values say."""
    case = disc(
        "heat.closure='paper'", "run.end_time_s=0.001", "run.output_interval_s=0.001", "run.report_at_s=[]",
        "resolution.spacing_mm=5", "resolution.cell_mm=10",
    )  # fmt: skip
    done = run(case, tmp_path)
    centre = history.probe(done, (0.25, 0.25))
    assert centre["temperature_K"] - 288.0 == pytest.approx(REFERENCE["disc_twoway_dTp_paper_t1e-3"], rel=0.01)


@pytest.mark.parametrize("std_mm", [0.03, 0.1, 0.285])
@pytest.mark.parametrize("law", ["gunn", "ranz_marshall"])
def test_size_distribution_against_many_bins(tmp_path, law, std_mm):
    """The exchange of grains of all sizes, by mass, against 2000 bins of the log-normal law; grains move at 1 m/s."""
    dt, alpha_p = 1e-3, 0.6
    case = disc(
        f"grains.diameter_std_mm={std_mm}", f"heat.law={law!r}", "particles.disc.velocity_m_s=[0.6,-0.8]",
        "resolution.spacing_mm=5", "resolution.cell_mm=10", *ONE_WAY, *ending(dt),
    )  # fmt: skip
    done = run(case, tmp_path)
    heart = np.hypot(done.state.x - 0.25, done.state.y - 0.25) < 0.05
    share = (done.state.temperature[heart] - 288.0) / (350.0 - 288.0)
    eps = -np.log1p(-share) * 3060.0 * 2470.0 / dt  # over alpha_p
    expected = binned(law, alpha_p, 285e-6, std_mm * 1e-3)
    tolerance = 1e-6 if std_mm < 0.05 else 1e-4 if std_mm < 0.2 else 5e-3
    np.testing.assert_allclose(eps, expected, rtol=tolerance)
    alone = heat.exchange_geometric(0.4, heat.LAWS[law](0.4, 1.225 * 285e-6 / 1.7895e-5, PRANDTL), 0.0242, 285e-6)
    assert abs(expected / alone - 1.0) > 100.0 * tolerance or std_mm > 0.2  # the sizes do matter


PRANDTL = heat.prandtl_number(1.7895e-5, 1006.43, 0.0242)


def binned(law, alpha_p, mean, std):
    """Mass average of eps/alpha_p over 2000 bins in ln d, from 9 standard deviations below to 9 above."""
    s, m = grain_sizes.log_std(mean, std), grain_sizes.log_mean(mean, std)
    edges = np.linspace(m - 9.0 * s, m + 9.0 * s, 2001)
    middle = 0.5 * (edges[1:] + edges[:-1])
    number = np.exp(-0.5 * ((middle - m) / s) ** 2)
    mass = number * np.exp(3.0 * middle)
    d = np.exp(middle)
    alpha_g = 1.0 - alpha_p
    nusselt = np.array([heat.LAWS[law](alpha_g, 1.225 * 1.0 * each / 1.7895e-5, PRANDTL) for each in d])
    return float((mass * 6.0 * nusselt * 0.0242 / d**2).sum() / mass.sum())


def test_gas_volume_fraction_is_what_the_grains_leave(tmp_path):
    """The volume of gas and grains is that of the box; in the heart of the disc alpha_g is 0.4."""
    case = disc()
    started = simulation(case, tmp_path)
    alpha_g = started.gas.alpha
    volume = started.state.mass.sum() / case.grains.density
    assert ((1.0 - alpha_g) * started.gas.mesh.volumes).sum() == pytest.approx(volume, rel=1e-13)
    heart = np.linalg.norm(started.gas.mesh.centres[:, :2] - 0.25, axis=1) < 0.08
    np.testing.assert_allclose(alpha_g[heart], 0.4, atol=2e-3)


def test_case_without_particles_leaves_the_gas_alone(tmp_path):
    done = run(disc("particles={}", *ending(0.01)), tmp_path)
    np.testing.assert_allclose(done.gas.temperature, 350.0, rtol=1e-14)
    assert len(particles.positions(done.state)) == 0
