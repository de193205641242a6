"""Prices of OpenFOAM's references: those of the runs on record, and said before a run begins."""

import csv
import re

import pytest

from coupling.gas import GasError
from coupling.openfoam.comparators import droplet_numbers, droplet_sources, price, two_fluid_numbers
from coupling.openfoam.comparators import run as references
from coupling.openfoam.programs import run as programs
from sdph import scenes
from sdph.case import read as cases
from sdph.scenes import paths


def load(scene, *overrides):
    return cases.load(scenes.find(scene)[1], overrides)


def recorded(scene, cell):
    """Wall time [s] of OpenFOAM's run with cells [mm] on record."""
    with (paths.data("validation") / scene / "cost.csv").open(encoding="utf-8") as table:
        rows = [row for row in csv.DictReader(table) if row["solver"].endswith("Foam")]
    (row,) = [row for row in rows if row["label"].endswith(f", {cell} mm")]
    return float(row["wall_s"])


def seconds(told):
    return float(re.search(r": about ([\d.e+]+) s, an estimate", told)[1])


@pytest.mark.parametrize("cell", [20, 10, 5])
def test_two_fluids_take_what_they_took_on_record(cell):
    case = load("bubbling_bed", f"resolution.cell_mm={cell}")
    told = price.of_two_fluids(case, two_fluid_numbers.macros(case), None)
    assert seconds(told) == pytest.approx(recorded("bubbling_bed", cell), rel=0.2)
    assert told.startswith(f"{500000 // cell**2} cells, {3000 // cell} steps: about ")


def of_jet(cell):
    case, drops = load("evaporating_jet", f"resolution.cell_mm={cell}"), droplet_sources.none(2)
    step = droplet_numbers.time_step(case, drops, droplet_numbers.COURANT, droplet_numbers.finest(case, None))
    return price.of_droplets(case, droplet_sources.injectors(case, drops, step), step, None)


@pytest.mark.parametrize("cell", [200, 100, 50])
def test_droplets_take_what_they_took_on_record(cell):
    assert seconds(of_jet(cell)) == pytest.approx(recorded("evaporating_jet", cell), rel=0.12)


def test_parcels_are_counted():
    """By hand: 20 a step, 500 steps."""
    assert of_jet(100).startswith("2400 cells, 500 steps, up to 10000 parcels: about ")


def test_a_table_of_steps_is_counted_between_its_rows():
    """By hand: ten of 0.1 s, a second in which the step grows to 0.3 s, of 0.2 s on average, and ten of 0.3 s."""
    numbers = {"time_steps": "((0.0 0.1) (1.0 0.1) (2.0 0.3) (9.0 0.3))"}
    assert price.steps(5.0, numbers) == 25 and price.steps(1.0, numbers) == 10
    assert price.steps(1.0, {"time_step": "0.1"}) == 10 and price.steps(1.0, {"time_step": "0.3"}) == 4


@pytest.mark.openfoam
@pytest.mark.parametrize(
    ("scene", "run", "told"),
    [
        ("bubbling_bed", references.run_two_fluid, "tfm: twoPhaseEulerFoam begins, 5000 cells, 300 steps: about "),
        ("evaporating_jet", references.run_droplets, "tfm: reactingParcelFoam begins, 2400 cells, 500 steps, up to "),
    ],
)
def test_it_is_said_before_the_run_begins(monkeypatch, tmp_path, scene, run, told):
    said = []

    def began(*_):
        assert len(said) == 1
        raise GasError("stopped")

    monkeypatch.setattr(references, "shelf", lambda: tmp_path)
    monkeypatch.setattr(programs, "run", began)
    with programs.told(said.append), pytest.raises(GasError, match="stopped"):
        run(load(scene, f"resolution.cell_mm={10 if scene == 'bubbling_bed' else 100}"), tmp_path / "tfm")
    assert said[0].startswith(told) and said[0].endswith("what is left is told every ten seconds")


@pytest.mark.openfoam
def test_it_is_said_where_a_run_was_made_before(monkeypatch, tmp_path):
    """Whoever changed their OpenFOAM would compare with what it had been, and not know."""
    said = []
    for name in ("run", "run_solver"):
        monkeypatch.setattr(programs, name, lambda *_: None)
    monkeypatch.setattr(references, "shelf", lambda: tmp_path / "kept")
    monkeypatch.setattr(references, "_read", lambda *_: "as it ran")
    monkeypatch.setattr(references, "keep", lambda _, file: (file.parent.mkdir(), file.touch()))
    monkeypatch.setattr(references, "load", lambda _: "as it was kept")
    case = load("bubbling_bed", "resolution.cell_mm=10")
    with programs.told(said.append):
        found = [references.run_two_fluid(case, tmp_path / "tfm") for _ in range(2)]
    assert found == ["as it ran", "as it was kept"] and len(said) == 2
    (file,) = (tmp_path / "kept").iterdir()
    assert said[1] == f"tfm: twoPhaseEulerFoam ran this before; delete {file} to run it anew"
