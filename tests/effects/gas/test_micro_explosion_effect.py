"""Gel droplets that burst: sealed until they tear, what they throw is what the gas gets; mass, energy and number close;
restart, bad input, nothing when off."""

import copy
import math

import numpy as np
import pytest
from builders import simulation

from coupling.embedded import EmbeddedGas
from sdph import effects, scenes
from sdph.case import judge
from sdph.case import read as cases
from sdph.effects import OFF
from sdph.effects.gas import micro_explosion, sizes
from sdph.engine import state as particles
from sdph.exchange import bursts
from sdph.laws import bursting
from sdph.running import driver
from sdph.running.metrics import bursts as metrics
from sdph.running.metrics import refuse_unknown
from sdph.running.progress import Reporter
from sdph.schema import CaseError

SCENE = cases.parsed(scenes.HERE / "gel_spray" / "case.toml")
END, WINDOW = 0.02, 2.5e-4
GONE = ("inflow", "outflow", "gravity", "drag")
CLOSED = (
    "mass_drift_rel", "particle_mass_drift_rel", "species_drift_rel", "exchange_mass_mismatch_rel",
    "exchange_energy_mismatch_rel", "energy_drift_rel",
)  # fmt: skip


def table(*on, end=END, alpha_p=1e-6, std=0.0, **more):
    """A closed box of hot air with droplets in its middle, which do not move."""
    found = copy.deepcopy(SCENE) | {"dimensions": 2, "scene": "", "effects": ["heat", "evaporation", *on]}
    for name in ("nozzles", "drag", *(() if "micro_explosion" in on else ("micro_explosion",))):
        del found[name]
    found |= {
        "run": {"end_time_s": end, "output_interval_s": 2.5e-3},
        "domain": {"size_m": [0.04, 0.04], "gravity_m_s2": [0.0, 0.0]},
        "resolution": {"spacing_mm": 10.0, "cell_mm": 10.0},
        "coupling": {"gas": "embedded", "window_largest_s": WINDOW, "window_tolerance": 1e30},
        "boundaries": {"walls": {"kind": "wall"}},
        "particles": {
            "droplet": {
                "shape": "box", "lower_m": [0.015, 0.015], "upper_m": [0.025, 0.025], "volume_fraction": alpha_p,
                "temperature_K": 300.0,
            }
        },
    }  # fmt: skip
    found["grains"]["diameter_std_mm"] = std
    for name, section in more.items():
        found[name] = found.get(name, {}) | section
    return found


def bursting_case(on=(), **more):
    return cases.from_table(table("micro_explosion", *on, **more))


def started(case, folder):
    return simulation(case, folder, gas=lambda case, cells: EmbeddedGas(case))


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    """A run through the tear, and its rows: time, temperature, sealed, throwing, mass of the particle."""
    run, rows = started(bursting_case(std=0.01), tmp_path_factory.mktemp("burst")), []
    while run.time < END:
        run.window()
        s = run.state
        rows.append((run.time, s.temperature[0], s.sealed[0], s.throwing[0], s.mass[0], run.ledger.last))
    return run, rows


def test_sealed_droplets_lose_nothing_until_they_tear(done):
    run, rows = done
    whole = [row for row in rows if row[2] == 1.0 and row[3] == 0.0]
    assert len(whole) > 10 and whole[-1][0] < END - 2e-3
    assert all(row[-1]["evaporated_kg"] == 0.0 and row[4] == rows[0][4] for row in whole)
    assert whole[-1][1] > run.parameters["micro_explosion"].own.boiling + 30.0


def test_all_balances_close(done):
    summary = done[0].ledger.summary()
    assert summary["thrown_kg"] > 0.2 * done[1][0][4]
    assert {name: summary[name] for name in CLOSED if not summary[name] <= 1e-10} == {}


def test_particles_and_bubbles_get_all_heat_until_the_tear(done):
    """m c dT and what bubbles hold are the heat from the gas, to round-off."""
    run, rows = done
    before = [row for row in rows if row[2] == 1.0 and row[3] == 0.0][-1]
    taken = [row[-1]["heat_to_particles_J"] for row in rows if row[0] <= before[0]]
    c = run.case.grains.heat_capacity
    assert before[-1]["particle_energy_J"] - c * before[4] * 300.0 == pytest.approx(math.fsum(taken), rel=1e-10)
    assert before[-1]["particle_energy_J"] > c * before[4] * before[1]


def test_every_droplet_tears_once_and_the_number_is_what_is_made(done):
    run, _ = done
    summary, grains = run.ledger.summary(), run.case.grains
    third = bursting.raw_moments(grains.diameter, grains.diameter_std**2)[1]
    number = run.ledger.first["particle_mass_kg"] / (grains.density * math.pi / 6.0 * third)
    assert summary["torn_droplets"] == pytest.approx(number, rel=1e-12)
    assert summary["made_droplets"] > number


def test_metrics_tell_number_size_and_whole_shells(done, tmp_path):
    """Before: all whole, the log-normal's Sauter diameter; after: none whole, no more droplets than were made."""
    run, _ = done
    before, after = (metrics.metrics(own) for own in (started(bursting_case(std=0.01), tmp_path), run))
    grains, summary = run.case.grains, run.ledger.summary()
    assert before["whole_share"] == 1.0 and after["whole_share"] == 0.0
    sauter = bursting.sauter(grains.diameter, grains.diameter_std**2)
    assert before["sauter_diameter_m"] == pytest.approx(sauter, rel=1e-5)
    assert before["droplets"] == pytest.approx(summary["torn_droplets"], rel=1e-5)
    assert 0.0 < after["droplets"] <= (summary["torn_droplets"] + summary["made_droplets"]) * (1.0 + 1e-5)
    with pytest.raises(CaseError, match="add micro_explosion to effects"):
        refuse_unknown(cases.from_table(table(run={"metrics": ["bursts"]})))


def test_flash_keeps_the_number(tmp_path):
    """What torn droplets throw shrinks all alike; superheat is gone when they are done, and pays for the vapour."""
    run = started(bursting_case(), tmp_path)
    own, s = run.parameters["micro_explosion"].own, run.state
    s.temperature[:], s.throwing[:] = own.boiling + 60.0, 1e-3
    before, count = s.mass[0], len(s.x)

    def number(s):
        found = [np.empty(count) for _ in range(3)]
        metrics.moments(run.case.grains.density, s, *found)
        return found[0][0]

    first = number(s)
    parts = []
    for dt in (2e-4, 5e-4, 9e-4):
        thrown = bursts.throw(own, s, dt)
        energy = own.heat_capacity * s.mass[0] * s.temperature[0]
        bursts.take(s, thrown)
        energy -= own.heat_capacity * (s.mass[0] * s.temperature[0] + thrown.warmth[0])
        assert energy == pytest.approx(own.latent_heat * thrown.mass[0], rel=1e-9)
        assert own.boiling < thrown.warmth[0] / thrown.mass[0] < own.boiling + 60.0
        assert number(s) == pytest.approx(first, rel=1e-12)
        parts.append(thrown.mass[0])
    assert s.temperature[0] == pytest.approx(own.boiling, rel=1e-14) and s.sealed[0] == 0.0 == s.throwing[0]
    share = bursting.flashed_share(own.heat_capacity, 60.0, own.latent_heat)
    assert sum(parts) / before == pytest.approx(share, rel=1e-12)
    assert bursts.throw(own, s, 1e-3) is None


def test_a_torn_droplet_that_is_cold_throws_nothing_and_is_open(tmp_path):
    run = started(bursting_case(), tmp_path)
    own, s = run.parameters["micro_explosion"].own, run.state
    s.throwing[:] = 1e-4
    thrown = bursts.throw(own, s, 1e-3)
    assert (thrown.mass == 0.0).all() and (thrown.after["temperature"] == 300.0).all()
    bursts.take(s, thrown)
    assert (s.sealed == 0.0).all()


def test_windows_follow_bubbles_that_grow(tmp_path):
    """None without heat; with a bubble a twentieth of the time in which it comes from boiling to tearing, before it as
    long again as it takes to boil."""
    run = started(bursting_case(), tmp_path)
    limits = effects.window_limits(run.parameters, run.case, run.state)
    assert limits["micro_explosion"] == math.inf
    p, s = run.parameters["micro_explosion"], run.state
    s.bubble_void[:], s.warming[:] = 1e-14, 7.0
    found = effects.window_limits(run.parameters, run.case, run.state)["micro_explosion"]
    rise = micro_explosion.tearing_temperature(p) - p.own.boiling
    assert found == pytest.approx(0.05 * rise / 7.0, rel=0.05)  # but for surface tension
    s.bubble_void[:] = 0.0
    first = effects.window_limits(run.parameters, run.case, run.state)["micro_explosion"]
    assert first - found == pytest.approx((p.own.boiling - 300.0) / 7.0, rel=0.02)  # the same


def test_heat_of_radiation_swells_a_bubble_too(tmp_path):
    """In gas too cold to boil anything, a shell tears by the heat of its surroundings; windows follow it, and give the
    time of the tear."""
    times = []
    for window in (8.0 * WINDOW, WINDOW):
        hot = bursting_case(
            on=("radiation",), gas={"temperature_K": 300.0},
            radiation={"emissivity": 1.0, "surroundings_temperature_K": 3000.0},
            coupling={"window_largest_s": window}, end=0.08,
        )  # fmt: skip
        folder = tmp_path / str(window)
        folder.mkdir()
        run = started(hot, folder)
        while run.ledger.sums["torn_droplets"] == 0.0 and run.time < hot.run.end_time:
            run.window()
        assert run.clock.limit == "micro_explosion"
        times.append(run.time)
    assert times[0] == pytest.approx(times[1], rel=0.01) and times[0] < 0.08


@pytest.mark.parametrize(("yields", "diameter"), [(2e4, 0.02), (5e3, 0.05)])
def test_a_soft_shell_asks_for_no_window_below_0(tmp_path, yields, diameter):
    """A small bubble boils hotter than such a shell bears, and tears it hotter still: both feel surface tension."""
    soft = {"micro_explosion": {"yield_stress_Pa": yields}, "grains": {"diameter_mm": diameter}}
    run = started(bursting_case(**soft), tmp_path)
    run.state.bubble_void[:], run.state.warming[:] = 1e-14, 7.0
    assert effects.window_limits(run.parameters, run.case, run.state)["micro_explosion"] > 0.0


def test_a_run_goes_on_bit_for_bit_with_bubbles_that_grow(tmp_path):
    """Stopped when the bubbles are there and nothing has torn."""
    whole, part = bursting_case(end=0.0175, alpha_p=1e-7), bursting_case(end=0.0125, alpha_p=1e-7)
    reporter = Reporter(quiet=True)
    one = driver.run(whole, "x", tmp_path / "whole", None, reporter)
    half = driver.run(part, "x", tmp_path / "part", None, reporter)
    assert half["torn_droplets"] == 0.0 < one["torn_droplets"]
    two = driver.resume(tmp_path / "part", ("run.end_time_s=0.0175",), reporter)
    timed = ("wall", "_per_", "start_to")
    assert {key for key in one if one[key] != two[key] and not any(part in key for part in timed)} == set()
    ends = [(tmp_path / name / "ledger.csv").read_text().splitlines()[-1] for name in ("whole", "part")]
    assert ends[0] == ends[1]


@pytest.mark.parametrize(("more", "said"), [
    ({"evaporation": {"saturation": "constant", "saturation_pressure_Pa": 1e3}}, "a bubble needs 'antoine'"),
    ({"gas": {"operating_pressure_Pa": 2e6}}, "above it nothing boils"),
    ({"gas": {"operating_pressure_Pa": 1.7e6}}, "with what the shell bears = 1.9.*above it nothing boils"),
    ({"micro_explosion": {"bubble_ratio": 0.9, "shell_ratio": 0.2}}, "less bubble or less shell"),
    ({"micro_explosion": {"thrown_share": 1.5}}, "thrown_share"),
])  # fmt: skip
def test_bad_input_is_told_in_one_line(more, said):
    with pytest.raises(CaseError, match=said) as error:
        case = bursting_case(**more)
        micro_explosion.kernel(case)
    assert "\n" not in str(error.value)


def test_it_needs_heat_and_evaporation():
    for lacks in ("heat", "evaporation"):
        own = table("micro_explosion")
        own["effects"].remove(lacks)
        del own[lacks]
        with pytest.raises(CaseError, match=f"without {lacks}"):
            micro_explosion.kernel(cases.from_table(own))


def test_explain_tells_whether_a_droplet_tears():
    """Hot and long enough or not; the temperature at which a shell gives way is that of its plastic limit."""
    hot, short, cold = judgement(), judgement(end=0.01), judgement(gas={"temperature_K": 540.0})
    assert hot.number > 1.0 > short.number > 0.0 == cold.number
    assert hot.error_if_off > 0.5 and short.error_if_off == 0.0


def judgement(**more):
    return judge.judgements(bursting_case(**more))["micro_explosion"]


def test_off_it_leaves_nothing(tmp_path):
    case = cases.from_table(table())
    run = started(case, tmp_path)
    assert run.parameters["micro_explosion"] == OFF and sizes.kernel(case) == OFF
    fresh = particles.empty(1, effects.arrays(case))
    assert not any(len(getattr(fresh, name)) for name in ("sealed", "throwing", "bubble_void", "shell_flow"))
    run.window()
    assert run.ledger.last["thrown_kg"] == 0.0 and "thrown_kg" not in run.ledger.summary()
