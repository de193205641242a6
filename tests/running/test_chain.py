"""A run whose nozzle records another run: the sheet first, then the spray of its drops."""

import csv
import dataclasses
import shutil
import tomllib
from pathlib import Path

import numpy as np
import pytest
import tomli_w

from sdph import scenes
from sdph.case import read as cases
from sdph.effects.around import drops
from sdph.running import chain, driver, inputs, output
from sdph.running.progress import Reporter
from sdph.schema import CaseError

SHEET = (
    "domain.size_m=[0.02,0.02,0.003]", "nozzles.mouth.centre_m=[0.01,0.01,0.0]", "run.end_time_s=3e-4",
    "resolution.spacing_mm=0.1",
)  # fmt: skip
SPRAY = ("coupling.gas='embedded'", "run.end_time_s=2e-3", "run.output_interval_s=2e-3", "nozzles.mouth.table_from_s=0")


@pytest.fixture(scope="module")
def sheet(tmp_path_factory):
    """A finished run of a short sheet."""
    folder = tmp_path_factory.mktemp("sheet") / "run"
    driver.run(cases.load(scenes.HERE / "swirl_sheet" / "case.toml", SHEET), "swirl_sheet", folder, None, Reporter())
    return folder


def spray(record, *more):
    own = (f"nozzles.mouth.record={str(record)!r}", "nozzles.mouth.record_set=[]")
    return cases.load(scenes.HERE / "swirl_spray" / "case.toml", (*SPRAY, *own, *more))


def rows(file):
    with open(file, newline="", encoding="utf-8") as told:
        return list(csv.DictReader(told))


def test_a_case_that_is_named_is_run_first(sheet, tmp_path):
    """The case of the sheet is run into the folder of the spray, and gives the drops that the sheet gave alone."""
    own = spray(sheet.parent / "case.toml")
    (sheet.parent / "case.toml").write_text((sheet / "case.toml").read_text(encoding="utf-8"), encoding="utf-8")
    summary = driver.run(own, "swirl_spray", tmp_path / "run", None, Reporter())
    alone, made = (folder / "droplets.csv" for folder in (sheet, tmp_path / "run" / "record.mouth"))
    assert made.read_bytes() == alone.read_bytes()
    assert summary["injected_kg"] > 0.0 and abs(summary["energy_drift_rel"]) < 1e-10
    for row in rows(tmp_path / "run" / chain.HANDOVER):
        assert abs(float(row["difference_rel"])) < 1e-12, row
    # mass through the plane and along the axis, as the sheet told of it
    made = rows(tmp_path / "run" / "inputs" / "nozzles.mouth.table" / "drops.csv")
    told = rows(alone)
    assert sum(float(r["mass_kg"]) for r in made) == pytest.approx(sum(float(r["mass_kg"]) for r in told), rel=1e-14)
    assert float(made[0]["z_m"]) == pytest.approx(float(told[0]["z_m"]), rel=1e-12)
    assert float(made[0]["velocity_z_m_s"]) == pytest.approx(float(told[0]["velocity_z_m_s"]), rel=1e-12)


def test_diameters_and_energy_of_the_surface_are_told_of(tmp_path):
    """Drops of 100 and 200 um in one particle: the sum of d is told as lost; energy sigma times surface."""
    size = np.array([1e-4, 2e-4])
    own = spray("swirl_sheet")
    mass = own.grains.density * np.pi / 6.0 * size**3
    lines = [",".join(drops.COLUMNS)]
    lines += [
        f"{1e-6 * (k + 1)},1e-3,1e-3,0,1,2,20,{m!r},{d!r}" for k, (m, d) in enumerate(zip(mass.tolist(), size.tolist()))
    ]
    (tmp_path / "drops.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    nozzle = dataclasses.replace(own.nozzles["mouth"], table=str(tmp_path / "drops.csv"))
    told = {row["quantity"]: row for row in chain.handed_over(own, nozzle, 0.0, 0.024)}
    assert told["diameters_m"]["drops"] == pytest.approx(3e-4, rel=1e-12)
    assert told["diameters_m"]["particles"] == pytest.approx(3e-4, rel=0.02)  # by mean and spread of one particle
    assert told["diameters_m"]["lost"] == pytest.approx(3e-4 - told["diameters_m"]["particles"], rel=1e-9)
    assert told["energy_of_surface_J"]["particles"] == pytest.approx(0.024 * np.pi * 5e-8, rel=1e-9)
    assert "energy_of_surface_J" not in {row["quantity"] for row in chain.handed_over(own, nozzle, 0.0)}


def test_a_run_that_is_named_is_taken_as_it_is(sheet, tmp_path):
    driver.run(spray(sheet), "swirl_spray", tmp_path / "run", None, Reporter())
    assert not (tmp_path / "run" / "record.mouth").exists()
    again = cases.load(tmp_path / "run" / "case.toml")
    assert Path(again.nozzles["mouth"].table).is_file()
    # the folder's own case has the table and runs without the sheet
    driver.run(again, "swirl_spray", tmp_path / "again", None, Reporter())
    assert (tmp_path / "again" / "ledger.csv").read_bytes() == (tmp_path / "run" / "ledger.csv").read_bytes()


@pytest.mark.parametrize(("many", "told"), [(9, True), (10, False)])
def test_drops_whose_sizes_are_of_the_spacing_are_told_of(sheet, tmp_path, many, told, capsys):
    """All of fewer than ten particles, and all of ten."""
    shutil.copytree(sheet, tmp_path / "sheet")
    found = rows(sheet / "droplets.csv")
    output.write_rows(tmp_path / "sheet" / "droplets.csv", [row | {"particles": many} for row in found])
    chain.made(spray(tmp_path / "sheet"), tmp_path / "run", None, None, Reporter())
    assert ("unresolved_mass_share = 1: more than half" in capsys.readouterr().err) == told


def test_what_was_cut_while_it_recorded_goes_on(sheet, tmp_path, monkeypatch):
    """The run of the sheet stops half way: `--resume` of the spray's folder goes on with it."""
    own = spray(sheet.parent / "case.toml")
    (sheet.parent / "case.toml").write_text((sheet / "case.toml").read_text(encoding="utf-8"), encoding="utf-8")
    begun = driver.Flight.go

    def cut(self, gas, checkpoint, wish):
        raise RuntimeError("the power failed")

    monkeypatch.setattr(driver.Flight, "go", cut)
    with pytest.raises(RuntimeError, match="power"):
        driver.run(own, "swirl_spray", tmp_path / "run", None, Reporter())
    monkeypatch.setattr(driver.Flight, "go", begun)
    summary = driver.resume(tmp_path / "run", (), Reporter())
    assert summary["injected_kg"] > 0.0


def disc(folder, more=""):
    """A case of a jet from a round hole along x, and `more` of its text."""
    text = (scenes.HERE / "swirl_sheet" / "case.toml").read_text(encoding="utf-8")
    for before, after in (
        ('shape = "annulus"', 'shape = "disc"'), ("inner_radius_m = 0.0013\n", ""), ("swirl = 1.0", ""),
        ("direction = [0.0, 0.0, 1.0]", "direction = [1.0, 0.0, 0.0]"),
    ):  # fmt: skip
        assert before in text
        text = text.replace(before, after)
    folder.mkdir()
    (folder / "case.toml").write_text(text + more, encoding="utf-8")
    return folder / "case.toml"


def test_drops_of_a_jet_are_told_about_its_axis(tmp_path):
    """Of a nozzle of any shape: 2 mm along the axis and 1 mm aside, at 20 and 3 m/s."""
    recorded, _ = inputs.recorded("nozzles.mouth", spray(disc(tmp_path / "jet")).nozzles["mouth"])
    told = dict.fromkeys(drops.COLUMNS, 1e-9) | {
        "x_m": 0.032, "y_m": 0.031, "z_m": 0.0, "velocity_x_m_s": 20.0, "velocity_y_m_s": 3.0, "velocity_z_m_s": 0.0,
    }  # fmt: skip
    chain._write(recorded, {name: np.array([value]) for name, value in told.items()}, tmp_path / "made" / "drops.csv")
    (row,) = rows(tmp_path / "made" / "drops.csv")
    assert float(row["z_m"]) == pytest.approx(2e-3) and float(row["velocity_z_m_s"]) == pytest.approx(20.0)
    assert np.hypot(float(row["x_m"]), float(row["y_m"])) == pytest.approx(1e-3)
    assert np.hypot(float(row["velocity_x_m_s"]), float(row["velocity_y_m_s"])) == pytest.approx(3.0)


def test_drops_of_a_plane_are_none(tmp_path):
    table = tomllib.loads(disc(tmp_path / "jet").read_text(encoding="utf-8"))
    table["dimensions"] = 2
    table["domain"] = {"size_m": [0.06, 0.06], "gravity_m_s2": [0.0, 0.0]}
    slot = {"shape": "slot", "centre_m": [0.0, 0.03], "direction": [1.0, 0.0], "width_m": 0.003, "speed_m_s": 20.0}
    table["nozzles"] = {"mouth": slot}
    (tmp_path / "jet" / "case.toml").write_text(tomli_w.dumps(table), encoding="utf-8")
    with pytest.raises(CaseError, match="has nozzles, 1, in 2 dimensions"):
        inputs.check(spray(tmp_path / "jet" / "case.toml"))


def test_two_nozzles_have_no_axis(tmp_path):
    second = """
[nozzles.other]
shape = "disc"
centre_m = [0.03, 0.01, 0.0]
direction = [0.0, 0.0, 1.0]
radius_m = 0.0015
speed_m_s = 20.0
"""
    with pytest.raises(CaseError, match="has nozzles, 2, in 3 dimensions; drops are told about the axis of one"):
        inputs.check(spray(disc(tmp_path / "jets", second)))


@pytest.mark.parametrize(
    ("record", "more", "told"),
    [
        ("no_such_scene", (), "no scene, folder or case file called"),
        ("dam_break", (), 'tells of no drops: it must have method.name = "mps"'),
    ],
)
def test_what_tells_of_no_drops_is_refused(record, more, told):
    with pytest.raises(CaseError, match=told):
        inputs.check(spray(record, *more))


def test_a_run_takes_no_overrides(sheet):
    with pytest.raises(CaseError, match="has been run already; leave"):
        inputs.check(spray(sheet, "nozzles.mouth.record_set=['run.end_time_s=1.0']"))


def test_a_sheet_that_gave_no_drops_is_told(sheet, tmp_path):
    own = cases.load(scenes.HERE / "swirl_sheet" / "case.toml", (*SHEET[:2], SHEET[3], "run.end_time_s=2e-5"))
    driver.run(own, "swirl_sheet", tmp_path / "early", None, Reporter())
    with pytest.raises(CaseError, match="let the run go on until drops leave"):
        driver.run(spray(tmp_path / "early"), "swirl_spray", tmp_path / "run", None, Reporter())
    assert not (tmp_path / "run").exists()
