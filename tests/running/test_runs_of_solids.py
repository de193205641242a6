"""Solids are run by the driver as liquids are: they go on bit for bit, and what bursts or makes no sense is refused."""

import numpy as np
import pandas as pd
import pytest
from blocks import table
from test_restart import Cut, Reporter, same_run

from sdph import cli, scenes
from sdph.case import read as cases
from sdph.engine.guard import Unstable
from sdph.laws.solids import cantilever_period
from sdph.methods.solids.method import SolidStepper
from sdph.methods.solids.scales import SolidScales
from sdph.running import driver
from sdph.schema import CaseError
from sdph.show import timeline
from sdph.study.explain import solids

# a bar that tears while it is pulled: contact, cuts and plastic flow
TORN = {
    "yield_stress_Pa": 1e4, "hardening_Pa": 1e4, "failure": [0.02, 0.0, 0.0, 0.0, 0.0],
    "history_interval_s": 2e-3,
}  # fmt: skip
SHORT = {"end_time_s": 0.03, "output_interval_s": 0.01, "checkpoint_windows": 2}


def torn():
    half = {"shape": "box", "lower_m": [0.4, 0.4], "upper_m": [0.46, 0.46], "velocity_m_s": [1.0, 0.0]}
    held = {"held_lower_m": [0.0, 0.0], "held_upper_m": [0.42, 1.0]}
    other = {"shape": "box", "lower_m": [0.47, 0.41], "upper_m": [0.51, 0.45], "velocity_m_s": [-0.5, 0.0]}
    return cases.from_table(table(solid=TORN, bodies={"left": half | held, "right": other}, run=SHORT))


def ring():
    own = ("run.end_time_s=2e-6", "run.output_interval_s=1e-6", "resolution.spacing_mm=0.025")
    return cases.load(scenes.HERE / "thick_ring" / "case.toml", (*own, "run.checkpoint_windows=2"))


@pytest.mark.parametrize("made", [torn, ring])
def test_resumed_run_is_the_uninterrupted_one_bit_for_bit(tmp_path, made):
    whole = driver.run(made(), "", tmp_path / "whole", None, Reporter(None))
    assert made is ring or whole["free_particles"] > 0
    with pytest.raises(Cut):
        driver.run(made(), "", tmp_path / "cut", None, Reporter(whole["windows"] // 2 + 1))
    driver.resume(tmp_path / "cut", (), Reporter())
    same_run(tmp_path / "whole", tmp_path / "cut")


def test_fields_and_history_tell_the_stress(tmp_path):
    driver.run(ring(), "", tmp_path / "run", None, Reporter(None))
    _, cloud, gas = timeline.state_at(timeline.read(tmp_path / "run"), None)
    assert gas is None
    for name in ("equivalent_stress", "stress_xx", "plastic_strain", "damage", "free", "pressure"):
        assert np.isfinite(cloud[name]).all()
    assert cli.main(["view", str(tmp_path / "run"), "--png", str(tmp_path / "ring.png")]) == 0


def test_what_bursts_is_caught(tmp_path):
    bent = table(run=SHORT | {"step_factor": 30.0})
    bent["bodies"]["block"]["velocity_m_s"] = [1.0, 0.0]
    bent["bodies"]["block"] |= {"held_lower_m": [0.0, 0.0], "held_upper_m": [0.43, 1.0]}
    with pytest.raises(Unstable, match=r"run\.step_factor"):
        driver.run(cases.from_table(bent), "", tmp_path / "run", None, Reporter(None))


def test_particles_are_followed_and_must_be_there(tmp_path):
    followed = cases.from_table(cases.to_table(ring()) | {"track": {"particles": [1]}})
    driver.run(followed, "", tmp_path / "run", None, Reporter(None))
    row = np.genfromtxt(tmp_path / "run" / "history.csv", delimiter=",", names=True)[0]
    assert (row["particle_1_x_m"], row["particle_1_y_m"]) == pytest.approx((6e-4 + 4.625e-4, 6e-4))  # the first circle
    nobody = cases.from_table(cases.to_table(ring()) | {"track": {"particles": [100000]}})
    with pytest.raises(CaseError, match="counted from 1"):
        driver.run(nobody, "", tmp_path / "other", None, Reporter(None))


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"solid": {"failure": [0.1]}}, "five numbers"),
        ({"solid": {"failure": [0.1] * 5}}, "yield_stress_Pa"),
        ({"bodies": {"a": {"shape": "ring", "centre_m": [0.5, 0.5], "radius_m": 0.1}}}, "inner_radius_m"),
        ({"bodies": {"a": {"shape": "box", "lower_m": [0.4, 0.4], "upper_m": [0.3, 0.5]}}}, "must lie above"),
        ({"bodies": {"a": {"shape": "box", "lower_m": [0.4, 0.4], "upper_m": [0.4001, 0.5]}}}, "is wide"),
        ({"bodies": {"a": {"shape": "box", "lower_m": [0.9, 0.4], "upper_m": [1.1, 0.5]}}}, "out of the domain"),
        ({"bodies": {"a": {"shape": "disc", "centre_m": [0.5, 0.5], "radius_m": 0.1, "motion": "cantilever"}}}, "held"),
        ({"dimensions": 3, "bodies": {"a": {"shape": "disc", "centre_m": [0.5] * 3, "radius_m": 0.1}}}, "dimensions"),
        ({"effects": ["gas_pressure"]}, "does not act on a solid"),
        ({"liquid": {"density_kg_m3": 1000.0, "sound_speed_m_s": 10.0, "periodic": [1, 0]}}, "beside a liquid"),
        ({"domain": {"size_m": [1.0, 1.0], "gravity_m_s2": [0.0, 0.0], "periodic": ["x"]}}, "periodic"),
    ],
)
def test_what_makes_no_sense_is_refused(change, told):
    with pytest.raises(CaseError, match=told):
        cases.from_table(table(**change))


@pytest.mark.parametrize(
    ("own", "told"),
    [
        ({"effects": ["inflation"], "inflation": {"body": "block"}}, "must be a ring"),
        ({"effects": ["rigid_sides"], "rigid_sides": {"sides": ["front"]}}, "allowed"),
        ({"effects": ["rigid_sides"], "rigid_sides": {"sides": []}}, "empty list; it holds sides out of left, right"),
        ({"bodies": {"a": {"shape": "box", "lower_m": [0.4, 0.4], "upper_m": [0.6, 0.411]}}}, "too few neighbours"),
    ],
)
def test_what_cannot_be_made_is_refused(tmp_path, own, told):
    with pytest.raises(CaseError, match=told):
        driver.run(cases.from_table(table(**own)), "", tmp_path / "run", None, Reporter(None))


def test_explain_tells_what_the_run_obeys(capsys):
    assert cli.main(["explain", "oscillating_plate", "--set", "resolution.spacing_mm=5"]) == 0
    shown = capsys.readouterr().out
    assert "waves" in shown and "solid particles" in shown and "slender body / spacing" in shown


@pytest.mark.parametrize("layers", [4, 6])
def test_thin_bodies_bend_too_far_by_what_explain_says(layers):
    """Period of a beam ten times as long as thick, from rest under its weight, over that of thin theory: its square is
    by how much it bends too far; 2.7 % is what a thick beam does."""
    high, long, held = 0.02, 0.2, 0.02
    spacing = high / layers
    beam = {
        "shape": "box", "lower_m": [held - 4.0 * spacing, 0.1], "upper_m": [held + long, 0.1 + high],
        "held_lower_m": [0.0, 0.0], "held_upper_m": [held, 1.0],
    }  # fmt: skip
    case = cases.from_table(table(
        bodies={"beam": beam}, effects=["gravity"], domain={"size_m": [0.4, 0.4], "gravity_m_s2": [0.0, -9.81]},
        resolution={"spacing_mm": 1e3 * spacing, "smoothing_ratio": 1.3}, solid={"youngs_modulus_Pa": 1e7},
    ))  # fmt: skip
    own, period = SolidStepper(case), cantilever_period(long, high, 1e7, 0.3, 1000.0)
    end, time, place = own.state.x > held + long - spacing, [], []
    while own.time < 0.85 * period:
        own.step(1e-2 * period)
        time.append(own.time)
        place.append(own.state.y[end].mean())
    bottom = np.array(place) < 0.97 * min(place) + 0.03 * place[0]
    a, b, _ = np.polyfit(np.array(time)[bottom], np.array(place)[bottom], 2)
    too_far = (-b / a / period) ** 2 - 1.0
    scales = SolidScales(case)
    assert too_far == pytest.approx(1.027 * (1.0 + solids.SOFT * (case.smoothing_length / high) ** 2) - 1.0, abs=0.04)
    (line,) = solids.warnings(scales)
    assert line.startswith(f"slender body / spacing = {layers}, safe from 10.1 on: too few layers bend too easily")


def test_a_block_that_does_not_bend_is_not_warned_of():
    assert not solids.warnings(SolidScales(cases.from_table(table())))


def test_a_probe_goes_along_with_a_body(tmp_path):
    """Displacement and velocity of a block in free flight; of stress what the fields have."""
    stress = {"at_m": [0.45, 0.44], "fields": ["equivalent_stress"]}
    flying = table(probes={"tip": {"at_m": [0.519, 0.44]}, "mid": stress})
    flying["bodies"]["block"]["velocity_m_s"] = [2.0, -1.0]
    flying["run"] = {"end_time_s": 0.02, "output_interval_s": 0.01}
    driver.run(cases.from_table(flying), "", tmp_path / "run", None, Reporter(None))
    last = pd.read_csv(tmp_path / "run" / "history.csv").iloc[-1]
    told = ("displacement_x_m", "displacement_y_m", "velocity_x_m_s", "velocity_y_m_s")
    found = [last[f"tip_{name}"] for name in told]
    assert found == pytest.approx([0.04, -0.02, 2.0, -1.0], rel=1e-9)
    assert last["mid_equivalent_stress_Pa"] == pytest.approx(0.0, abs=1.0)


@pytest.mark.parametrize(
    ("probe", "told"),
    [
        ({"at_m": [0.8, 0.8]}, "goes along with the particle that is nearest"),
        ({"at_m": [0.45, 0.44], "fields": ["temperature"]}, "there are: damage, density, displacement"),
    ],
)
def test_a_probe_beside_the_bodies_is_refused(probe, told):
    with pytest.raises(CaseError, match=told):
        cases.from_table(table(probes={"tip": probe}))


# rho g L = 2000 kg/m3 x 9.81 m/s2 x 0.01 m = 196 Pa
HEAVY = (
    "solid.youngs_modulus_Pa=70", "solid.density_kg_m3=2000", "effects=['gravity']", "domain.gravity_m_s2=[0,-9.81]",
    "bodies.left.velocity_m_s=[0,0]", "bodies.right.velocity_m_s=[0,0]",
)  # fmt: skip


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ((), None),
        (("bodies.left.velocity_m_s=[9000,0]",), "sound in them at"),
        (HEAVY, "it collapses"),
    ],
)
def test_bodies_that_a_run_would_be_stopped_for_are_told(change, told):
    lines = solids.warnings(SolidScales(cases.load(scenes.HERE / "colliding_rings" / "case.toml", change)))
    assert [told in line for line in lines if "sound" in line or "collapses" in line] == [True] * bool(told)
