"""A run whose nozzle records another run: the sheet first, then the spray of its drops."""

import csv
from pathlib import Path

import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.running import chain, driver, inputs
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
    drops = rows(tmp_path / "run" / "inputs" / "nozzles.mouth.table" / "drops.csv")
    told = rows(alone)
    assert sum(float(r["mass_kg"]) for r in drops) == pytest.approx(sum(float(r["mass_kg"]) for r in told), rel=1e-14)
    assert float(drops[0]["z_m"]) == pytest.approx(float(told[0]["z_m"]), rel=1e-12)
    assert float(drops[0]["velocity_z_m_s"]) == pytest.approx(float(told[0]["velocity_z_m_s"]), rel=1e-12)


def test_a_run_that_is_named_is_taken_as_it_is(sheet, tmp_path):
    driver.run(spray(sheet), "swirl_spray", tmp_path / "run", None, Reporter())
    assert not (tmp_path / "run" / "record.mouth").exists()
    again = cases.load(tmp_path / "run" / "case.toml")
    assert Path(again.nozzles["mouth"].table).is_file()
    # the folder's own case has the table and runs without the sheet
    driver.run(again, "swirl_spray", tmp_path / "again", None, Reporter())
    assert (tmp_path / "again" / "ledger.csv").read_bytes() == (tmp_path / "run" / "ledger.csv").read_bytes()


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
