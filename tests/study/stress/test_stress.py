"""Hard cases (the fast ones), and that a run which goes unstable is caught in time and leaves what is needed."""

import dataclasses
import math

import numpy as np
import pytest
from builders import cloud, disc, simulation
from grain_boxes import box

from coupling.gas import GasError
from sdph import cli
from sdph.engine.guard import Unstable
from sdph.methods.grains.bounds import Guard
from sdph.running import through_gas
from sdph.schema import CaseError
from sdph.study.explain import estimate
from sdph.study.stress import suite
from sdph.study.stress.measures import Extremes, Measures

FAST = [hard.name for hard in suite.chosen([], True)]
PAST_LIMIT = (
    "resolution.spacing_mm=10", "resolution.cell_mm=25", "grains.conductivity_W_m_K=5e6", "run.step_factor=60.0",
    "coupling.window_tolerance=1e30", "coupling.window_largest_s=0.01",
)  # fmt: skip


def test_there_are_enough_hard_cases():
    assert len(suite.files()) >= 30
    assert len(FAST) >= 8


@pytest.mark.parametrize("name", FAST)
def test_hard_case(name):
    verdict = suite.run(*suite.chosen([name], True))
    assert verdict.ok, suite.line(verdict)


@pytest.mark.parametrize("share, held", [(0.9, True), (1.15, False)])
def test_light_grains_are_held_up_to_the_limit_that_explain_tells(share, held):
    """Lighter and lighter grains, against the weight of the gas that they push aside at alpha_p = 0.3."""
    (hard,) = suite.chosen(["light_grains"], False)
    case = suite.case_of(hard)
    density = 0.3 / 0.7 * case.gas.density / (share * estimate.ADDED_MASS)
    short = {"run": {"end_time_s": 0.002, "output_interval_s": 0.002}, "grains": {"density_kg_m3": density}}
    assert bool(suite.run(hard, short).stopped) is not held
    light = suite.case_of(hard, short)
    assert estimate.pushed_aside(light) == pytest.approx(share * 0.7 / 3.0 / 0.3 * 0.63 / 0.37, rel=1e-12)
    assert any("pushed aside" in line for line in estimate.warnings(light))


def test_a_criterion_that_is_missed_fails():
    hard = suite.load(next(file for file in suite.files() if file.stem == "fast_conduction"))
    broken = suite.Hard(**{**vars(hard), "at_most": {"temperature_K_max": 280.0}})
    verdict = suite.run(broken)
    assert not verdict.ok
    assert "FAIL" in suite.line(verdict) and "temperature_K_max" in suite.line(verdict)


def test_an_unknown_measure_is_told(tmp_path):
    hard = suite.load(next(file for file in suite.files() if file.stem == "fast_conduction"))
    with pytest.raises(CaseError, match="temperature_K_maxx"):
        suite.run(suite.Hard(**{**vars(hard), "at_most": {"temperature_K_maxx": 280.0}}))


def test_a_case_that_its_run_refuses_fails():
    """Grains that leave through a side without `outflow` end one case, not all of them."""
    (hard,) = suite.chosen(["limit_agitation"], False)
    effects = [name for name in hard.case["effects"] if name != "outflow"]
    verdict = suite.run(hard, {"effects": effects, "particles": {"bed": {"velocity_m_s": [0.0, 20.0]}}})
    assert not verdict.ok and "outflow" in verdict.stopped


def test_a_case_is_over_when_its_clock_is(tmp_path):
    """A droplet that has torn ends sooner than its case says."""
    run = simulation(disc("resolution.spacing_mm=10", "resolution.cell_mm=25"), tmp_path)
    run.clock.end = 0.5 * run.case.run.end_time
    suite._go(run, suite._measures(run.case), 10**9)
    assert run.clock.over(run.time) and run.time < 0.9 * run.case.run.end_time


def test_conduction_past_its_limit_is_caught_within_20_sub_steps(tmp_path):
    """From the first sub-step that leaves the temperatures of the case (288 to 350 K) to the stop."""
    run = simulation(disc(*PAST_LIMIT), tmp_path)
    seen = []
    looked = run.stepper.guard.sub_step

    def watch(stepper):
        seen.append((stepper.state.temperature.min(), stepper.state.temperature.max()))
        looked(stepper)

    run.stepper.guard.sub_step = watch
    with pytest.raises(Unstable) as caught:
        while run.time < run.case.run.end_time:
            run.window()
    beyond = [low < 287.9 or high > 350.1 for low, high in seen]
    assert 1 <= len(seen) - beyond.index(True) <= 20
    for part in ("temperature of particle", "t = ", " m is ", "lower run.step_factor", "coupling.window_largest_s"):
        assert part in str(caught.value)


@pytest.mark.parametrize("value", [np.nan, np.inf, 1e6])
def test_a_bad_velocity_is_caught_at_once(tmp_path, value):
    run = simulation(disc("resolution.spacing_mm=10", "resolution.cell_mm=25"), tmp_path)
    run.window()
    run.state.u[7] = value
    with pytest.raises(Unstable, match=f"speed of particle {run.state.ident[7]} "):
        run.window()


def test_bad_gas_is_caught(tmp_path):
    run = simulation(disc("resolution.spacing_mm=10", "resolution.cell_mm=25"), tmp_path)
    run.gas.temperature[3] = -5000.0
    with pytest.raises(
        GasError, match="cannot finish window 1 .*gas temperature of cell 3 .*lower coupling.window_largest_s"
    ):
        run.window()
    assert run.repeated == len(run.notices) == through_gas.REPEATS + 1


def test_nothing_is_caught_in_a_sound_run(tmp_path):
    run = simulation(disc("resolution.spacing_mm=10", "resolution.cell_mm=25"), tmp_path)
    for _ in range(50):
        run.window()
    assert Guard(run.case).coldest < run.state.temperature.min()


def test_an_unstable_run_leaves_its_last_good_state(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    options = [part for override in PAST_LIMIT for part in ("--set", override)]
    assert cli.main(["run", "disc_cluster", "--gas", "embedded", "--out", "burst", *options]) == 5
    said = capsys.readouterr().err.splitlines()[-1]
    assert "went unstable" in said and "last_good" in said
    with np.load(tmp_path / "burst" / "last_good.npz") as last:
        assert np.isfinite(last["temperature"]).all() and len(last["x"]) > 300
        assert last["temperature"].min() > 280.0
    assert (tmp_path / "burst" / "last_good.png").stat().st_size > 10_000


def test_what_is_no_number_meets_no_bound():
    """max(-inf, nan) of Python is -inf, which would be below every bound."""
    taken = Extremes(None)
    for values in ([1.0], [math.nan], [2.0]):
        taken._take("momentum_drift_rel", np.array(values))
    assert math.isnan(taken.high["momentum_drift_rel"]) and math.isnan(taken.low["momentum_drift_rel"])


def test_names_of_which_none_is_fast_are_refused():
    slow = next(file.stem for file in suite.files() if not suite.load(file).fast)
    with pytest.raises(CaseError, match=f"none of {slow} is fast"):
        suite.chosen([slow], True)


@pytest.mark.parametrize("options", [["--map", "thin_wall"], ["--map", "--fast"], ["--faults", "1", "thin_wall"]])
def test_what_map_and_faults_take_no_notice_of_is_refused(options, capsys):
    assert cli.main(["stress", *options]) == 2
    assert "is not of single hard cases" in capsys.readouterr().err


def test_who_is_outside_is_so_of_a_domain_that_begins_elsewhere():
    """A wall lies where the domain ends, not at 0 and its size; through a periodic side nobody gets out."""
    sides = {"walls": {"kind": "wall"}}
    for periodic, out in (((), 2), (("x",), 0)):
        case = box(["walls"], (0.06, 0.06), 0.3, periodic, boundaries=sides, fill=(0.06, 0.06))
        domain = dataclasses.replace(case.domain, lower=(-0.03, 0.0)) if not periodic else case.domain
        low, high = domain.corner[0], domain.upper[0]
        x = [low - 0.01, low + 0.01, low + 0.02, high - 0.01, high + 0.01]
        state = cloud(np.stack([x, np.full(5, 0.03)], axis=1))
        assert Measures(dataclasses.replace(case, domain=domain))._outside(state) == out
