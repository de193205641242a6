"""A liquid is run by the driver as grains are: it goes on bit for bit, its ledger closes, and what bursts is caught."""

import json

import numpy as np
import pytest
from test_restart import Cut, Reporter, same_run

from sdph import cli, scenes
from sdph.case import read as cases
from sdph.engine import restart
from sdph.engine.clock import Stalled
from sdph.engine.guard import Unstable
from sdph.methods.liquids import totals as ledger
from sdph.running import driver, output
from sdph.running.alone import STRIDE, Alone
from sdph.schema import CaseError
from sdph.show import shot, view

COARSE = {
    "dam_break": ("resolution.spacing_mm=8", "run.end_time_s=0.06", "run.forces=['bottom','tank']"),
    "square_patch": ("resolution.spacing_mm=50", "run.end_time_s=0.1", "run.output_interval_s=0.05"),
    "sloshing_sphere": (
        "resolution.spacing_mm=70", "run.end_time_s=0.2", "run.output_interval_s=0.1", "liquid.history_interval_s=0.05",
        "frame.start_s=0", "drain.start_s=0.02", "drain.end_s=1.0",
    ),
    "free_overfall": ("resolution.spacing_mm=20", "run.end_time_s=0.3", "run.output_interval_s=0.1"),
}  # fmt: skip


def load(scene, *more):
    return cases.load(scenes.HERE / scene / "case.toml", (*COARSE[scene], "run.checkpoint_windows=2", *more))


def start(folder, scene="dam_break", cut_after=None, more=()):
    return driver.run(load(scene, *more), scene, folder, None, Reporter(cut_after))


def begun(tmp_path, scene="dam_break", *more):
    run = Alone(load(scene, *more), tmp_path / "ledger.csv")
    run.start()
    return run


XSPH = ("square_patch", ("effects=['density_diffusion','liquid_damping','xsph']",))  # its velocities are of last step


@pytest.mark.parametrize(("scene", "more"), [*((scene, ()) for scene in COARSE), XSPH])
def test_resumed_run_is_the_uninterrupted_one_bit_for_bit(tmp_path, scene, more):
    whole = start(tmp_path / "whole", scene, more=more)
    cut_after = whole["windows"] // 2 + 1
    with pytest.raises(Cut):
        start(tmp_path / "cut", scene, cut_after, more)
    assert restart.newest(tmp_path / "cut").folder.name == f"{(cut_after - 1) // 2 * 2:09d}"
    resumed = driver.resume(tmp_path / "cut", (), Reporter())
    same_run(tmp_path / "whole", tmp_path / "cut")
    timed = ("wall", "_per_", "start_to")
    assert {k: v for k, v in resumed.items() if not any(t in k for t in timed)} == {
        k: v for k, v in whole.items() if not any(t in k for t in timed)
    }


def test_another_liquid_is_refused(tmp_path):
    start(tmp_path / "run")
    with pytest.raises(CaseError, match="liquid.density_kg_m3 was 1000.0 and is 900"):
        driver.resume(tmp_path / "run", ("liquid.density_kg_m3=900",), Reporter())


def test_a_run_can_be_made_longer(tmp_path):
    start(tmp_path / "long", more=("run.end_time_s=0.08",))
    start(tmp_path / "short")
    driver.resume(tmp_path / "short", ("run.end_time_s=0.08",), Reporter())
    same_run(tmp_path / "long", tmp_path / "short")


@pytest.mark.parametrize(("count", "interval"), [(12, 0.05), (3, 0.1), (7, 0.01)])
def test_a_run_goes_on_past_an_end_that_is_a_landmark_but_for_round_off(tmp_path, count, interval):
    """3 x 0.1 is more than 0.3 in floating point: the instant stood twice in run.pvd."""
    end, later = float(f"{count * interval:.6g}"), float(f"{(count + 0.4) * interval:.6g}")
    coarse = ("resolution.spacing_mm=14.2875", f"run.output_interval_s={interval}", "run.report_at_s=[]")
    whole = start(tmp_path / "whole", more=(*coarse, f"run.end_time_s={later}"))
    start(tmp_path / "cut", more=(*coarse, f"run.end_time_s={end}"))
    resumed = driver.resume(tmp_path / "cut", (f"run.end_time_s={later}",), Reporter())
    same_run(tmp_path / "whole", tmp_path / "cut")
    assert resumed["windows"] == whole["windows"] and resumed["time_s"] == later
    instants = [entry.split('"')[1] for entry in (tmp_path / "cut" / "run.pvd").read_text().split("timestep=")[1:]]
    assert len(set(instants)) == len(instants) == count + 2


def test_an_absurd_limit_ends_with_its_name(tmp_path):
    with pytest.raises(Stalled, match="the step's limit 'sound'"):
        start(tmp_path / "run", more=("run.step_factor=1e-6", "liquid.courant=1e-6"))


@pytest.mark.parametrize("scene", COARSE)
def test_the_ledger_closes(tmp_path, scene):
    summary = start(tmp_path / "run", scene)
    assert (summary["energy_at_hand_J"] > 0.0) == (scene != "square_patch")  # nothing pulls or pushes the patch
    rows = output.read_table(tmp_path / "run" / "ledger.csv")
    assert summary["mass_drift_rel"] < 1e-12
    assert summary["momentum_drift_rel"] < 1e-12
    if scene == "square_patch":  # no walls: pairs give back all that they take
        assert np.abs(rows["impulse_of_walls_x_kg_m_s"]).max() < 1e-12 * rows["mass_kg"][0]
        assert np.abs(rows["impulse_of_shifting_x_kg_m_s"]).max() > 0.0
    else:
        assert np.abs(rows["impulse_of_walls_x_kg_m_s"]).sum() > 1e-3 * rows["mass_kg"][0]
    if scene == "sloshing_sphere":
        commanded = output.read_table(tmp_path / "run" / "history.csv")["commanded_kg"][-1]
        assert rows["drained_kg"].sum() == pytest.approx(commanded, rel=1e-12) and commanded > 1.0


def test_momentum_from_nowhere_shows_in_the_ledger(tmp_path):
    run = begun(tmp_path)
    run.window()
    assert run.ledger.summary()["momentum_drift_rel"] < 1e-12
    run.state.u[run.stepper.active[5]] += 0.1
    run.window()
    assert run.ledger.summary()["momentum_drift_rel"] > 1e-4


def test_energy_from_nowhere_shows_in_the_ledger(tmp_path):
    run = begun(tmp_path)
    run.window()
    before = run.ledger.summary()["energy_made_rel"]
    run.state.u[run.stepper.active] += 0.5
    run.window()
    assert run.ledger.summary()["energy_made_rel"] > before + 0.1


def test_elastic_energy_is_the_work_of_the_pressure(tmp_path):
    """de/drho = p/rho^2, by central differences."""
    run = begun(tmp_path)
    s, own = run.state, run.stepper.active

    def elastic(density):
        s.density[own] = density
        return float(s.mass[own] @ ledger.specific_energies(run.stepper, own)[1])

    for density in (990.0, 1010.0):
        pressure = 1000.0 * 21.2**2 / 7.0 * ((density / 1000.0) ** 7 - 1.0)
        slope = (elastic(density + 0.01) - elastic(density - 0.01)) / 0.02
        assert slope == pytest.approx(s.mass[own].sum() * pressure / density**2, rel=1e-6)


def test_steps_follow_the_step_factor(tmp_path):
    steps = [begun(tmp_path, "dam_break", f"run.step_factor={factor}").stepper.next_step(1.0) for factor in (1.0, 0.5)]
    assert steps[1] == pytest.approx(0.5 * steps[0], rel=1e-2)


@pytest.mark.parametrize(("name", "value"), [("u", np.nan), ("u", np.inf), ("v", 100.0), ("density", -1.0)])
def test_what_is_wrong_is_caught_in_its_window(tmp_path, name, value):
    run = begun(tmp_path)
    run.window()
    ident = run.state.ident[run.stepper.active[7]]
    getattr(run.state, name)[run.stepper.active[7]] = value
    steps = run.stepper.steps
    with pytest.raises(Unstable, match="(speed|density|acceleration) of particle"):
        run.window()
    assert run.stepper.steps - steps <= STRIDE
    assert ident in run.stepper.guard.last["ident"]


def test_a_burst_leaves_its_last_good_state_and_exit_code_5(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    options = [part for override in (*COARSE["dam_break"], "run.step_factor=10") for part in ("--set", override)]
    assert cli.main(["run", "dam_break", "--out", "burst", *options]) == 5
    said = capsys.readouterr().err.splitlines()[-1]
    assert "went unstable" in said and "lower run.step_factor (now 10" in said and "last_good" in said
    with np.load(tmp_path / "burst" / "last_good.npz") as last:
        assert np.isfinite(last["u"]).all()
    assert (tmp_path / "burst" / "last_good.png").stat().st_size > 10_000
    assert json.loads((tmp_path / "burst" / "failure.json").read_text())["kind"] == "Unstable"


def test_a_liquid_too_fast_for_its_sound_is_told(tmp_path):
    reporter = Reporter()
    summary = driver.run(load("dam_break", "liquid.sound_speed_m_s=2.5"), "dam_break", tmp_path / "run", None, reporter)
    assert summary["fastest_over_sound"] > 0.2
    assert any("raise liquid.sound_speed_m_s from 2.5 to" in line for line in reporter.said)


@pytest.mark.parametrize(
    ("override", "told"),
    [("resolution.spacing_mm=100", "along x, which is periodic"), ("liquid.periodic=[1]", "2 numbers")],
)
def test_a_periodic_box_that_is_too_narrow_is_refused(override, told):
    with pytest.raises(CaseError, match=told):
        cases.load(scenes.HERE / "poiseuille" / "case.toml", (override,))


def test_metrics_of_grains_are_refused(tmp_path):
    with pytest.raises(CaseError, match="for liquids: none"):
        start(tmp_path / "run", more=("run.metrics='bubble'",))


def test_its_tank_is_drawn_around_it(tmp_path):
    """Walls lie beside the fields, the picture is of all of the tank, and what falls falls downwards."""
    start(tmp_path / "run")
    taken = shot.of_folder(tmp_path / "run")
    assert taken.box == pytest.approx((0.0, 0.28575, 0.0, 0.17145, 0.0, 0.0))
    (tmp_path / "run" / output.WALLS).write_bytes(b"<VTKFile")
    with pytest.raises(CaseError, match="walls.vtp is damaged"):
        view.show(tmp_path / "run", tmp_path / "a.png")
