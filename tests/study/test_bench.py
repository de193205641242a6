"""`sdph bench`: every row is measured or says why not, and stands beside a value of ours."""

import json
import math

import pytest

from sdph.cli import main
from sdph.schema import CaseError
from sdph.study import bench, bench_ranks
from tests.of_ranks import WITH_MPI


@pytest.fixture
def small(monkeypatch):
    """Beds and tanks of some hundred particles, each timed once, and no OpenFOAM."""

    def missing(*given, **more):
        raise CaseError("OpenFOAM was not found; get it")

    monkeypatch.setattr(bench, "LARGE", bench.SMALL)
    monkeypatch.setattr(bench, "LIQUIDS", {"liquid_2d_us": (2, 500), "liquid_3d_us": (3, 500)})
    monkeypatch.setattr(bench, "ROUNDS", 1)
    monkeypatch.setattr(bench, "SECONDS", 0.0)
    monkeypatch.setattr(bench, "BED", 1e-4)
    monkeypatch.setattr("coupling.openfoam.comparators.run.run_two_fluid", missing)


def test_all_rows_are_told(small, capsys):
    assert main(["bench", "--json"]) == 0
    rows = {row["name"]: row for row in json.loads(capsys.readouterr().out)["rows"]}
    assert set(rows) == {key for key in bench.ours()["values"] if "_2_" not in key}
    assert rows.pop("bed_over_two_fluids")["value"] is None
    assert all(row["value"] > 0.0 and row["ours"] > 0.0 for row in rows.values())
    assert rows["grains_over_liquid"]["value"] == rows["grains_us"]["value"] / rows["liquid_2d_us"]["value"]


def test_what_was_not_measured_says_why():
    told = bench.table([bench.Row("bed_over_two_fluids", "the bed", math.nan, "OpenFOAM was not found")])
    assert "-" in told.splitlines()[1] and "not measured: OpenFOAM was not found" in told


def test_the_least_of_several_counts(monkeypatch):
    spent = iter([[3.0, 1.0], [2.0, 5.0], [4.0, 4.0], [0.0, 0.0]])
    monkeypatch.setattr(bench, "SECONDS", 0.0)
    assert list(bench.least(lambda: next(spent))) == [2.0, 1.0]
    clock, spent = iter(range(100)), iter([[3.0], [3.0], [3.0], [2.0], [1.0], [0.0]])
    monkeypatch.setattr(bench.time, "monotonic", lambda: next(clock))
    monkeypatch.setattr(bench, "SECONDS", 2.5)  # told after the third, the fourth and the fifth
    assert list(bench.least(lambda: next(spent))) == [1.0]


@WITH_MPI
def test_ranks_are_measured(monkeypatch, capsys):
    monkeypatch.setattr(bench_ranks, "CASES", {"liquid": ("dam_break_3d", 19.05)})
    assert main(["bench", "--ranks", "2", "--json"]) == 0
    rows = {row["name"]: row for row in json.loads(capsys.readouterr().out)["rows"]}
    assert set(rows) == {"liquid_2_ranks", "liquid_2_threads"}
    assert all(math.isfinite(row["value"]) and row["ours"] > 1.0 for row in rows.values())


@pytest.mark.parametrize(("number", "why"), [("1", "at least 2"), ("99999", "room for")])
def test_ranks_that_cannot_be_measured_say_why(number, why, capsys):
    assert main(["bench", "--ranks", number]) == 2
    told = [line for line in capsys.readouterr().err.splitlines() if line.startswith("sdph:")]
    assert len(told) == 1 and why in told[0]
