"""The choice of windows: landmarks are hit exactly, limits rule by name, growth and shrinking are bounded."""

import math

import numpy as np
import pytest
from builders import FULL_BOX, disc, fixed_windows, simulation
from fakes import StillGas
from hypothesis import given
from hypothesis import strategies as st

from coupling.gas import GasError, Unfinished
from sdph import effects
from sdph.case import judge
from sdph.engine import state as particles
from sdph.engine.clock import Stalled
from sdph.exchange import window
from sdph.study.explain import estimate

GROWTH, SHRINK = window.GROWTH, window.SHRINK


def clock(*overrides, rate=0.0, scale=0.0):
    chooser = window.Window(disc(*overrides))
    chooser.begin(rate, scale)
    return chooser


def learn(chooser, dt, courant=0.0):
    """Three particles at rest exchanged 1 W each for `dt`."""
    chooser.learn(dt, 3.0 * dt, 0.0, courant, 0.0)


def times(chooser, end):
    """All times at which windows end."""
    found = [0.0]
    while found[-1] < end:
        found.append(chooser.choose(found[-1]))
        learn(chooser, found[-1] - found[-2])
        assert len(found) < 10**5
    return np.array(found)


@given(
    end=st.floats(1e-6, 1e3),
    parts=st.floats(0.3, 40.0),
    reports=st.lists(st.floats(1e-4, 1.5), max_size=4),
    largest=st.floats(1e-3, 2.0),
)
def test_landmarks_are_hit_exactly_and_windows_are_no_longer_than_allowed(end, parts, reports, largest):
    asked = [share * end for share in reports]
    chooser = clock(
        f"run.end_time_s={end!r}",
        f"run.output_interval_s={end / parts!r}",
        f"run.report_at_s={asked!r}",
        f"coupling.window_largest_s={largest * end!r}",
    )
    found = times(chooser, end)
    assert found[-1] == end
    assert set(chooser.outputs) <= set(found)
    for time in asked:
        assert time >= end or np.abs(found - time).min() <= 1e-9 * end
    steps = np.diff(found)
    assert (steps > 0.0).all() and steps.max() <= largest * end * (1.0 + 1e-6)


def test_outputs_are_every_interval_and_the_end():
    np.testing.assert_allclose(
        clock("run.end_time_s=1.0", "run.output_interval_s=0.3").outputs, [0.3, 0.6, 0.9, 1.0], rtol=1e-15
    )
    np.testing.assert_allclose(
        clock("run.end_time_s=0.3", "run.output_interval_s=0.1").outputs, [0.1, 0.2, 0.3], rtol=1e-15
    )
    np.testing.assert_array_equal(clock("run.end_time_s=0.1", "run.output_interval_s=5.0").outputs, [0.1])


def test_report_time_that_differs_from_an_output_by_round_off_makes_no_window():
    """3 * 0.1 is not 0.3: a window of 5e-17 s between them would set back the control."""
    found = times(clock("run.end_time_s=1.0", "run.output_interval_s=0.1", "run.report_at_s=[0.3,0.6,0.7]"), 1.0)
    assert np.diff(found).min() > 1e-4


def test_limits_are_named():
    largest = ("coupling.window_largest_s=1e-3", "coupling.window_tolerance=1e-2")
    chooser = clock(*largest, rate=1.0, scale=1.0)
    chooser.choose(0.0)
    assert chooser.limit == "largest"
    chooser = clock(*largest, rate=1e6, scale=1.0)
    end = chooser.choose(0.0)
    assert chooser.limit == "heat exchange"
    assert end <= math.sqrt(2.0 * 1e-2) / 1e6  # backward Euler errs by (rate dt)^2/2
    chooser = clock(*largest, "coupling.courant=0.5")
    learn(chooser, 1e-4, courant=2.0)
    end = chooser.choose(0.0)
    assert chooser.limit == "courant"
    assert end == pytest.approx(1e-4 * 0.5 / 2.0, rel=0.01)


@given(dt=st.floats(1e-5, 1.0), courant=st.floats(1e-6, 1e3))
def test_courant_limit_grows_no_faster_than_allowed(dt, courant):
    chooser = clock(
        "coupling.window_largest_s=10", "run.end_time_s=10", "run.output_interval_s=10", "run.report_at_s=[]"
    )
    learn(chooser, dt, courant)
    assert chooser.choose(0.0) <= dt * min(GROWTH, 1.0 / courant) * (1.0 + 1e-6)


@given(
    tolerance=st.floats(1e-9, 1e-1),
    dts=st.lists(st.floats(1e-6, 1e-2), min_size=2, max_size=6),
    seed=st.integers(0, 2**32 - 1),
)
def test_control_grows_and_shrinks_within_bounds(tolerance, dts, seed):
    control, rng = window.Control(tolerance), np.random.default_rng(seed)
    control.begin(1.0, 10.0)
    for dt in dts:
        following = control.learn(dt, *rng.exponential(size=2) * (dt, 1.0) * 10.0 ** rng.uniform(-6, 3, 2))
        assert SHRINK * dt * (1.0 - 1e-12) <= following <= GROWTH * dt * (1.0 + 1e-12)


def test_control_holds_the_error_at_the_tolerance():
    """A rate that relaxes as exp(-t): the estimated error of every window is near the tolerance, whatever the start."""
    tolerance = 1e-4
    control = window.Control(tolerance)
    dt, time, errors, before = control.begin(1.0, 1.0), 0.0, [], 0.0
    for _ in range(60):
        taken = math.exp(-time) - math.exp(-time - dt)
        following = control.learn(dt, taken, abs(taken / dt - before))
        before = taken / dt
        errors.append(control.error)
        time, dt = time + dt, following
    assert max(errors[2:]) < 1.1 * tolerance
    assert min(errors[5:]) > 0.5 * tolerance


def test_steady_exchange_lets_windows_grow():
    control = window.Control(1e-5)
    dt = control.begin(100.0, 1.0)
    control.learn(dt, 4.0 * dt, 4.0)
    assert control.learn(dt, 4.0 * dt, 0.0) == GROWTH * dt


@given(order=st.permutations(range(8)), gone=st.integers(0, 7))
def test_the_change_is_of_particles_that_are_sorted_anew_or_leave(order, gone):
    """Each particle exchanges at its own rate; of those that were not in the gas before there is no change to tell."""
    state = particles.empty(8, effects.REGISTRY["heat"].arrays)
    state.received[:], state.exchanged[:] = np.linspace(1.0, 1e3, 8), [1, 1, 1, 1, 1, 1, 1, 0]
    rates = state.received + np.array([0.0, 0, 5, 0, 0, 0, 0, 70])
    left = np.array([k for k in order if k != gone])
    state = particles.take(state, left)
    heat, change = window.learned(state, 0.5 * rates[left], 0.5)
    assert heat == pytest.approx(0.5 * rates[left].sum()) and change == pytest.approx(0.0 if gone == 2 else 5.0)
    assert state.received == pytest.approx(rates[left]) and state.exchanged.all()


def test_fast_particles_rule_by_name():
    chooser = clock("coupling.courant=0.5")
    chooser.learn(1e-3, 0.0, 0.0, 0.0, 10.0)
    assert chooser.choose(0.0) <= 0.5 * 5e-3 / 10.0
    assert chooser.limit == "particles"


@pytest.mark.parametrize("gas", ["288", "288.00000001"])
def test_grains_and_gas_in_equilibrium_take_few_windows(tmp_path, gas):
    """What is left to exchange is round-off, which is not to be resolved."""
    case = disc(*FULL_BOX, f"gas.temperature_K={gas}", "run.report_at_s=[]")
    simulated = simulation(case, tmp_path)
    while simulated.time < case.run.end_time:
        simulated.window()
        assert simulated.windows < 200


def test_no_exchange_is_no_limit(tmp_path):
    """Without particles the windows are those of the outputs."""
    case = disc("particles={}", "run.report_at_s=[]", "coupling.window_largest_s=1.0")
    simulated = simulation(case, tmp_path)
    while simulated.time < case.run.end_time:
        simulated.window()
    assert simulated.windows <= 12


BLOWN = (
    "boundaries.jet.kind='velocity_inlet'", "boundaries.jet.side='left'", "boundaries.jet.velocity_m_s=[3.0,4.0]",
    "particles.disc.velocity_m_s=[0.0,20.0]", "particles.disc.volume_fraction=0.5",
)  # fmt: skip


def test_the_first_window_obeys_what_enters_and_what_is_thrown():
    """Gas of 5 m/s is twice as fast between grains of 0.5; grains that nothing moves do not count, whatever speed they
    are given."""
    resting = disc(*BLOWN, "resolution.cell_mm=10", "coupling.courant=0.5")
    assert window.opening(resting) == pytest.approx({"courant": 0.5 * 0.01 / 10.0})
    moving = disc(*BLOWN, "resolution.cell_mm=10", "effects=['gravity','heat','conduction']")
    assert window.opening(moving) == pytest.approx({"courant": 1e-3, "particles": 0.01 / 20.0})
    assert window.Window(moving).choose(0.0) <= 0.01 / 20.0


def test_explain_shows_what_the_first_window_obeys():
    case = disc(*BLOWN, "effects=['gravity','heat','conduction']")
    rows = {
        row["cause"]: row["largest [s]"]
        for row in estimate.limits(case, judge.scales_of(case))
        if row["of"] == "window"
    }
    assert window.opening(case).items() <= rows.items()


class Fragile(StillGas):
    """A gas that cannot finish windows longer than `most` [s]."""

    most = 1e-6

    def advance(self, dt, sources):
        state = super().advance(dt, sources)
        if dt > self.most:
            raise Unfinished("the gas is fragile")
        return state


def test_a_window_that_the_gas_cannot_finish_is_taken_again_and_counted(tmp_path):
    (tmp_path / "short").mkdir()
    case = disc(*FULL_BOX, *fixed_windows(2e-5), "run.report_at_s=[]", "run.end_time_s=1e-4")
    run = simulation(case, tmp_path, gas=Fragile)
    short = simulation(
        disc(*FULL_BOX, *fixed_windows(2e-5 / 64.0), "run.report_at_s=[]", "run.end_time_s=3.125e-7"),
        tmp_path / "short",
    )
    run.window()
    short.window()
    assert run.time == run.gas.time == short.time == 2e-5 / 64.0
    assert run.gas.temperature.tobytes() == short.gas.temperature.tobytes()
    assert run.state.temperature.tobytes() == short.state.temperature.tobytes()
    assert run.repeated == len(run.notices) == 3
    assert "window 1, t = 0 s: taken again, a quarter of 2e-05 s long, because the gas is fragile" in run.notices[0]


def test_a_gas_that_finishes_nothing_ends_the_run_with_the_keys_to_change(tmp_path):
    case = disc(*FULL_BOX, "coupling.window_largest_s=1e-3", "coupling.window_tolerance=1e30", "run.report_at_s=[]")
    run = simulation(case, tmp_path, gas=Fragile)
    with pytest.raises(
        GasError,
        match="cannot finish window 1 at t = 0 s, not even 3.91e-06 s of it: the gas is fragile; lower "
        "coupling.window_largest_s",
    ):
        run.window()


def test_sub_steps_that_get_nowhere_end_the_run(tmp_path):
    run = simulation(disc(*FULL_BOX), tmp_path)
    run.stepper.shortest = 1e3
    with pytest.raises(Stalled, match="sub-step's limit 'conduction' .times run.step_factor"):
        run.window()
