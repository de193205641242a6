"""The hot tube of `sdph validate experiments`: laws of others by hand, verdicts, a short run, none without OpenFOAM."""

from types import SimpleNamespace

import numpy as np
import pytest
from test_experiments import QUIET, verdicts

from sdph.case import read as cases
from sdph.study import validate

TUBE = validate.part(validate.EXPERIMENTS, "hot_tube")
ON = ("effects=['gravity','granular_pressure','walls','conduction','wall_heat']", "boundaries.tube.temperature_K=338")


def scene():
    return cases.load(TUBE.scenes.find(TUBE.SCENE)[1], ON)


def finished(nusselt: float, alpha_p=0.5):
    """A run of a tube with a Nusselt number, once it is late."""
    case, area, dt = scene(), 0.1256, 0.05
    time = np.arange(0.0, case.run.end_time + dt, dt)
    late = nusselt * case.gas.conductivity / case.grains.diameter * area * TUBE.RISE * dt
    heat = np.where(time > TUBE.beds.LATE * case.run.end_time, late, 7.0 * late)
    told = {"time_s": time, "alpha_p_inside": np.full(len(time), alpha_p)}
    ledger = {"time_s": time, "heat_of_walls_J": heat}
    return SimpleNamespace(case=case, ledger=ledger, metrics=told, summary={"tube_area_m2": area})


def test_laws_of_others_by_hand():
    """Ar = 11 720; 0.45 m/s: flow number 0.1051, 47 x 0.45 x 0.481 x 0.905 x 28.7 = 264, over 80. Martin at 0.5, the
    onset at 0.6: Z = 131, Nu_wp = 22.7, N = 0.067."""
    case = scene()
    assert TUBE.archimedes(case) == pytest.approx(11720.0, rel=2e-3)
    assert TUBE.known_at_onset(TUBE.measured.table("zhang_2014"), case) == pytest.approx(0.01 * 11720.0**0.42, rel=1e-3)
    assert TUBE.grewal_saxena(case, 0.45, 0.45) == pytest.approx(264.0 / 80.0, rel=0.02)
    assert TUBE.martin(case, 0.5) == pytest.approx(4.22, rel=0.01)
    assert TUBE.at_onset(case) == pytest.approx(0.213, rel=0.01)


@pytest.mark.parametrize(("onset", "blown", "verdict"), [
    (0.5, 3.9, [True, True, True]), (0.66, 3.9, [False, True, True]), (0.5, 4.9, [True, False, True]),
    (0.5, 5.4, [True, False, False]),
])  # fmt: skip
def test_what_is_far_off_is_told(tmp_path, monkeypatch, onset, blown, verdict):
    made = {None: onset, 0.45: blown}
    monkeypatch.setattr(TUBE, "run", lambda speed, *_: finished(made[speed]))
    monkeypatch.setattr(TUBE.installation, "find", lambda: True)
    checks = TUBE.checks(tmp_path)
    assert [check["value"] for check in checks] == pytest.approx([onset, blown, blown], rel=1e-9)
    assert verdicts(checks) == verdict
    assert (tmp_path / "hot_tube.png").is_file()


def test_without_openfoam_it_is_left_out_and_told(tmp_path, monkeypatch):
    said = []
    monkeypatch.setattr(TUBE.installation, "find", lambda: None)
    assert TUBE.checks(tmp_path, (), SimpleNamespace(status=said.append)) == []
    assert len(said) == 1 and "needs OpenFOAM" in said[0]


@pytest.mark.openfoam
def test_a_moment_of_it_has_what_was_asked_for(tmp_path):
    """40 ms of coarse particles: the tube's area, heat from it, balances."""
    own = TUBE.run(0.45, tmp_path / "run", ("resolution.spacing_mm=8", "run.output_interval_s=0.02"), QUIET, 0.04)
    assert own.summary["tube_area_m2"] == pytest.approx(np.pi * 0.04, rel=0.02)
    assert TUBE.number(own) > 0.0 and own.summary["energy_drift_rel"] < 1e-8
    assert own.summary["mean_tube_grain_heat_W"] == pytest.approx(own.summary["heat_of_walls_J"] / 0.04, rel=1e-12)
    assert own.case.boundaries["tube"].temperature == own.case.gas.temperature + TUBE.RISE
