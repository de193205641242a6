"""Runs of the OpenFOAM gas under paths that OpenFOAM does not take: begun, gone on with, moved."""

import filecmp
import tempfile
from pathlib import Path

import pytest

from coupling.openfoam.links import PREFIX, Links
from sdph import cli

FINE = ("--set", "resolution.spacing_mm=20", "--set", "resolution.cell_mm=50", "--set", "run.output_interval_s=0.0005")
ODD = 'it\'s a "run" with\tblanks'


def sdph(*words) -> None:
    assert cli.main([*map(str, words)]) == 0


def left() -> set[Path]:
    return set(Path(tempfile.gettempdir()).glob(f"{PREFIX}*"))


@pytest.mark.parametrize("transport", ["socket", "file"])
def test_a_run_begins_goes_on_and_is_moved_under_any_path(tmp_path, monkeypatch, transport):
    """The run that was stopped, moved from one such path to another and gone on with is the one that was not; from a
    working directory of such a name, as a shell tells of it."""
    before, odd, whole = left(), tmp_path / ODD, tmp_path / "whole"
    odd.mkdir()
    monkeypatch.chdir(odd)
    monkeypatch.setenv("PWD", str(odd))
    begun = ("run", "disc_cluster", "--gas", "openfoam", "--transport", transport, *FINE)
    sdph(*begun, "--until", 0.001, "--out", odd / "part")
    (odd / "part").rename(odd / "moved here")
    sdph("run", "--resume", odd / "moved here", "--until", 0.0015)
    sdph(*begun, "--until", 0.0015, "--out", whole)
    assert filecmp.cmp(odd / "moved here" / "history.csv", whole / "history.csv", shallow=False)
    assert left() == before


def test_a_path_that_openfoam_takes_is_left_alone(tmp_path):
    links = Links()
    assert links.plain(tmp_path) == links.place(tmp_path) == tmp_path.resolve() and not links._names
    assert links.address("tcp:127.0.0.1:80") == "tcp:127.0.0.1:80"
