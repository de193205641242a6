"""Windows in which grains that a steady force pulls drift as fast as drag lets them, and limits that end."""

import math
from dataclasses import replace

import numpy as np
import pytest
from grain_boxes import DENSITY, VISCOSITY, Row, box, go, started

from sdph.case import judge
from sdph.effects import OFF
from sdph.exchange import pulls
from sdph.exchange.window import settling
from sdph.study.explain import pace

D, G = 1e-4, 9.81  # m, m/s2
TAU = DENSITY * D**2 / (18.0 * VISCOSITY)  # s, of Stokes' drag


def falling(accuracy=0.01, end=8.0 * TAU, on=("drag", "gravity"), **more):
    """Lone grains in gas at rest that feels nothing, and windows as long as the limits let them be."""
    long = {"run": {"end_time_s": end, "output_interval_s": end, "accuracy": accuracy},
            "coupling": {"window_largest_s": end, "courant": 1e30, "one_way": True}}  # fmt: skip
    own = {"grains": {"diameter_mm": D * 1e3}, "drag": {"law": "stokes"}} if "drag" in on else {}
    return box(list(on), alpha_p=1e-3, gravity=(0.0, -G), **(own | long | more))


def still(case):
    """Gas whose weight a gradient of pressure carries."""
    return Row(case, alpha_g=1.0, gradient=(0.0, -G * case.gas.density, 0.0))


@pytest.mark.parametrize("accuracy", [0.1, 0.03, 0.01])
def test_grains_settle_at_their_speed(tmp_path, accuracy):
    """g tau (1 - exp(-t/tau)) whatever the windows; by the drag of a window's start and weight on top of it they would
    fall `run.accuracy` too fast, and twice as fast in windows of 1.6 tau."""
    done = go(started(case := falling(accuracy), tmp_path, still(case)))
    assert done.clock.limit == "settling"
    assert -done.state.v.mean() == pytest.approx(G * TAU * (1.0 - math.exp(-done.time / TAU)), rel=1e-9)


def test_dust_in_a_wind_settles_at_its_speed(tmp_path):
    """Windows of 0.6 drag times, which a wind allows: it fell a third too fast."""
    bed = {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.06, 0.06], "volume_fraction": 1e-3}
    bed |= {"temperature_K": 300.0, "velocity_m_s": [10.0, 0.0]}
    case = falling(accuracy=0.03, end=30.0 * TAU, particles={"bed": bed})
    wind = still(case)
    wind.velocity[:, 0] = 10.0
    done = go(started(case, tmp_path, wind))
    assert done.time / done.windows > 0.6 * TAU
    assert -done.state.v.mean() == pytest.approx(G * TAU, rel=1e-9)


@pytest.mark.parametrize("knows", [True, False])
def test_what_contacts_carry_does_not_follow_its_weight(tmp_path, knows):
    """Drag of packed grains starts from their own velocity; of free ones from what pulls them: weight, less what the
    pressure of the gas carries, of an even suspension where the gas knows of it, and what is held; in between no step
    lets round-off decide."""
    run = started(case := falling(on=("drag", "gravity", "gas_pressure", "friction")), tmp_path, still(case))
    s, count, onset = run.state, len(run.state.x), run.parameters["friction"].onset
    case = replace(case, coupling=replace(case.coupling, one_way=not knows))
    rates, ones = (np.full(count, 1e9), np.tile((0.0, 0.0, 2.0 * s.mass[0]), (count, 1))), np.ones((count, 3))
    for alpha_p, share in ((0.2, 1.0), (onset, 0.0), (onset * (1.0 - 0.5 * pulls.LOOSENING), 0.5), (0.99 * onset, 0.1)):
        s.density[:] = alpha_p * DENSITY
        found = pulls.ahead(case, run.parameters, s, rates, 1.0, ones)
        pull = 0.0, -(1.0 - alpha_p * knows) * G * (1.0 - case.gas.density / DENSITY), 2.0
        np.testing.assert_allclose(found - 1.0, np.tile(share * np.array(pull), (count, 1)), rtol=1e-6)


def test_what_flies_fast_does_not_wait_for_its_weight(tmp_path):
    """Of grains thrown at 10 m/s the error may be as much of that speed; nothing asks where nothing pulls."""
    bed = {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.06, 0.06], "volume_fraction": 1e-3}
    bed |= {"temperature_K": 300.0, "velocity_m_s": [10.0, 0.0]}
    run = started(case := falling(particles={"bed": bed}), tmp_path, still(case))
    assert run.clock.limits["settling"] == pytest.approx(2.0 * 0.01 * 10.0 / G, rel=1e-12)
    for on in (("drag",), ("gravity",)):
        run = started(case := falling(on=on), tmp_path, still(case))
        assert run.clock.limits["settling"] == math.inf


def test_what_moves_nothing_within_the_run_keeps_nobody_waiting():
    """Dust of 1 um settles by less than a smoothing length: windows are those of a speed that just does so."""
    case = falling(grains={"diameter_mm": 1e-3}, end=1.0)
    assert settling(case, G, 1e-5, 0.0) == pytest.approx(2.0 * 0.01 * case.smoothing_length / G)


def test_explain_asks_the_same(tmp_path):
    """Of grains that fall all along; the run is at the speed of its end."""
    case = falling(drag={"law": "gidaspow"})
    done = go(started(case, tmp_path, still(case)))
    assert pace.asked(case, judge.scales_of(case), done.state)["settling"] == pytest.approx(
        done.clock.limits["settling"], rel=0.05
    )


def test_a_limit_that_ends_lets_windows_grow(tmp_path):
    """What bears any window again, gas and grains at rest again, vapour that has gone: none rules by what it was."""
    run = started(case := falling(), tmp_path, still(case))
    clock, end = run.clock, case.run.end_time
    clock.obey({"settling": 1e-6, "break_up": 1e-6})
    clock.hold(1e6)
    clock.thicken(1e-6, 10.0)
    clock.learn(1e-6, 0.0, 0.0, 1e36, 1e36)
    assert clock.longest() < 1e-6
    clock.obey({"settling": math.inf, "break_up": math.inf})
    clock.hold(0.0)
    clock.thicken(1e-6, 0.0)
    for _ in range(80):
        clock.learn(1e-6, 0.0, 0.0, 0.0, 0.0)
    assert clock.longest() == end


def test_the_mean_is_by_mass(tmp_path):
    """Of two kinds of pace the heavier counts for more; grains without drag not at all."""
    run = started(case := falling(), tmp_path, still(case))
    s, at_rest = run.state, np.zeros((len(run.state.x), 3))
    s.mass[:] = np.where(np.arange(len(s.x)) < 1, 3.0, 1.0)
    damping, slip = np.full(len(s.x), 1e9), np.arange(len(s.x)) < 1
    mean = 3.0 / s.mass.sum()
    assert run.exchange.settling(s, damping, OFF, at_rest, slip.astype(float)) == pytest.approx(
        settling(case, G, 1e-9, mean), rel=1e-12
    )
    damping[0] = 0.0
    assert run.exchange.settling(s, damping, OFF, at_rest, slip.astype(float)) == pytest.approx(
        settling(case, G, 1e-9, 0.0)
    )
