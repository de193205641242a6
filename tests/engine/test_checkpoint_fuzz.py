"""Whatever is in `RUN/checkpoints`, to go on ends in time: with one line and exit code 2, or from an older checkpoint.

The short form harms 40 runs; `SDPH_FUZZ=13 SDPH_FUZZ_SEED=1` harms 520, in another way.
"""

import os
import shutil
import time
from pathlib import Path

import numpy as np
import pytest
from checkpoint_harm import FILE_HARMS, HARMS, TEXTS, certify, checkpoints, harm_gas
from fuzzing import FACTOR, SEED
from test_restart import COARSE, Cut, Reporter

from sdph import cli, scenes
from sdph.case import read as cases
from sdph.running import driver

COUNT = 40 * FACTOR
WORK, PATIENCE = 10.0, 60.0  # s of processor and of waiting, on a machine that others use too
MEMORY = 2**30  # bytes that this process may grow by
SMALL = {
    "disc_cluster": ((*COARSE["disc_cluster"], "run.end_time_s=0.0002"), "embedded"),
    "evaporating_jet": ((*COARSE["evaporating_jet"], "run.end_time_s=0.02"), "embedded"),
    "dam_break": (("resolution.spacing_mm=8", "run.output_interval_s=0.01", "run.end_time_s=0.02"), None),
}


@pytest.fixture(scope="module")
def cut_runs(tmp_path_factory):
    """Runs with two checkpoints each, cut before their end."""
    runs = tmp_path_factory.mktemp("cut")
    for scene, (overrides, gas) in SMALL.items():
        chosen = (f"coupling.gas='{gas}'",) if gas else ()
        case = cases.load(scenes.HERE / scene / "case.toml", (*overrides, *chosen, "run.checkpoint_windows=2"))
        with pytest.raises(Cut):
            driver.run(case, scene, runs / scene, None, Reporter(7))
        assert len(checkpoints(runs / scene)) == 2
    return runs


@pytest.fixture
def copied(cut_runs, tmp_path):
    def copy(scene, name="run"):
        return shutil.copytree(cut_runs / scene, tmp_path / name, symlinks=True)

    return copy


def went_on(run, capsys):
    """Exit code and what was said of `sdph run --resume`, in time and without a traceback."""
    begun, worked = time.monotonic(), time.process_time()
    code = cli.main(["run", "--resume", str(run)])
    spent, said = time.process_time() - worked, capsys.readouterr().err
    assert spent < WORK and time.monotonic() - begun < PATIENCE, said
    assert code in (0, 2), said
    if code:
        assert said.splitlines()[-1].startswith("sdph: ") and "Traceback" not in said
    return code, said


def memory(field):
    """Bytes of this process: what it holds now (VmRSS), or the most since `forget_the_most` (VmHWM)."""
    lines = Path("/proc/self/status").read_text().splitlines()
    return next(1024 * int(line.split()[1]) for line in lines if line.startswith(field))


def forget_the_most():
    Path("/proc/self/clear_refs").write_text("5")


def files_of(folder):
    return {
        path.relative_to(folder): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file() and not path.is_symlink()
    }


@pytest.mark.parametrize("scene", SMALL)
def test_unharmed_it_goes_on(copied, capsys, scene):
    run = copied(scene)
    for folder in checkpoints(run):
        certify(folder)
    code, said = went_on(run, capsys)
    assert code == 0, said


def test_harmed_it_ends_in_time_and_with_a_line(cut_runs, tmp_path, capsys):
    rng, codes = np.random.default_rng(31 + SEED), []
    forget_the_most()
    held = memory("VmRSS")
    for number in range(COUNT):
        scene, harm = list(SMALL)[rng.integers(len(SMALL))], HARMS[rng.integers(len(HARMS))]
        run = shutil.copytree(cut_runs / scene, tmp_path / "run")
        harm(rng, run)
        try:
            codes.append(went_on(run, capsys)[0])
        except BaseException as error:
            raise AssertionError(f"harm {number} of seed {31 + SEED}: {harm.__name__} of {scene}") from error
        shutil.rmtree(run)
    assert memory("VmHWM") - held < MEMORY
    assert codes.count(2) > 0.2 * COUNT


@pytest.mark.openfoam
def test_a_harmed_gas_of_openfoam_ends_with_a_line(tmp_path, capsys):
    """Its files hold messages; sdphGasFoam says what is wrong with them."""
    rng, case = np.random.default_rng(32 + SEED), scenes.HERE / "disc_cluster" / "case.toml"
    overrides = (*SMALL["disc_cluster"][0], "coupling.gas='openfoam'", "run.checkpoint_windows=2")
    with pytest.raises(Cut):
        driver.run(cases.load(case, overrides), "disc_cluster", tmp_path / "cut", None, Reporter(7))
    codes = []
    for number in range(8 * FACTOR):
        run = shutil.copytree(tmp_path / "cut", tmp_path / "run")
        harm_gas(rng, run)
        try:
            codes.append(went_on(run, capsys)[0])
        except BaseException as error:
            raise AssertionError(f"harm {number} of seed {32 + SEED}") from error
        shutil.rmtree(run)
    assert codes.count(2) > 0.2 * len(codes)


@pytest.mark.parametrize("number", range(len(FILE_HARMS)))
def test_files_that_are_no_arrays_are_refused(copied, capsys, number):
    run = copied("disc_cluster")
    for folder in checkpoints(run):
        FILE_HARMS[number](folder / "arrays.npz")
        certify(folder)
    before = files_of(run)
    assert went_on(run, capsys)[0] == 2
    assert files_of(run) == before


@pytest.mark.parametrize("name", ["manifest.json", "numbers.json"])
@pytest.mark.parametrize("number", range(len(TEXTS)))
def test_files_that_are_no_tables_are_refused(copied, capsys, name, number):
    run = copied("dam_break")
    for folder in checkpoints(run):
        (folder / name).write_text(TEXTS[number])
        if name == "numbers.json":
            certify(folder)
    before = files_of(run)
    assert went_on(run, capsys)[0] == 2
    assert files_of(run) == before


def linked_checkpoints(run, outside):
    shutil.copytree(run / "checkpoints", outside / "checkpoints")
    (outside / "checkpoints" / "000000001").mkdir()
    shutil.rmtree(run / "checkpoints")
    (run / "checkpoints").symlink_to(outside / "checkpoints")


def linked_folder(run, outside):
    newest = checkpoints(run)[-1]
    shutil.move(newest, outside / newest.name)
    newest.symlink_to(outside / newest.name)


def linked_file(name):
    def link(run, outside):
        file = checkpoints(run)[-1] / name
        shutil.move(file, outside / file.name)
        file.symlink_to(outside / file.name)

    return link


def linked_table(name):
    def link(run, outside):
        shutil.move(run / name, outside / name)
        (run / name).symlink_to(outside / name)

    return link


LINKS = {
    "checkpoints": linked_checkpoints, "folder": linked_folder, "manifest": linked_file("manifest.json"),
    "arrays": linked_file("arrays.npz"), "gas of it": linked_file("gas/embedded_gas.npz"),
    "ledger": linked_table("ledger.csv"), "history": linked_table("history.csv"), "fields": linked_table("fields"),
}  # fmt: skip


@pytest.mark.parametrize("link", LINKS)
def test_links_are_refused_and_nothing_outside_changes(copied, capsys, tmp_path, link):
    run, outside = copied("disc_cluster"), tmp_path / "outside"
    outside.mkdir()
    LINKS[link](run, outside)
    (outside / "000000009").mkdir()
    (outside / "000000009" / "mine").touch()
    before = files_of(outside), sorted(outside.rglob("*"))
    code, said = went_on(run, capsys)
    assert code == 2 and "is a link" in said
    assert (files_of(outside), sorted(outside.rglob("*"))) == before


def test_a_link_without_any_whole_checkpoint_is_refused_too(copied, capsys, tmp_path):
    """Where a run would begin again, and clear its folder."""
    run, outside = copied("disc_cluster"), tmp_path / "outside"
    shutil.rmtree(run / "checkpoints")
    outside.mkdir()
    linked_table("fields")(run, outside)
    before = files_of(outside)
    assert went_on(run, capsys)[0] == 2
    assert files_of(outside) == before


@pytest.mark.parametrize(
    "name", ["manifest.json", "numbers.json", "arrays.npz", "gas/embedded_gas.npz", "another", "gas/another"]
)
def test_pipes_are_not_waited_for(copied, capsys, name):
    run = copied("disc_cluster")
    for folder in checkpoints(run):
        (folder / name).unlink(missing_ok=True)
        os.mkfifo(folder / name)
    assert went_on(run, capsys)[0] == 2


def test_a_file_that_is_a_hole_is_not_read(copied, capsys):
    """A manifest can promise any length."""
    import json

    run = copied("disc_cluster")
    for folder in checkpoints(run):
        os.truncate(folder / "arrays.npz", 2**42)
        manifest = json.loads((folder / "manifest.json").read_text())
        manifest["bytes"]["arrays.npz"] = 2**42
        (folder / "manifest.json").write_text(json.dumps(manifest))
    assert went_on(run, capsys)[0] == 2


@pytest.mark.parametrize("named", ["../../../outside", "/etc/passwd", "gas/../../x", "a/b/c", ""])
def test_names_that_lead_out_are_refused(copied, capsys, named):
    import json

    run = copied("disc_cluster")
    for folder in checkpoints(run):
        manifest = json.loads((folder / "manifest.json").read_text())
        manifest["files"][named], manifest["bytes"][named] = "0" * 64, 10
        (folder / "manifest.json").write_text(json.dumps(manifest))
    assert went_on(run, capsys)[0] == 2


def test_a_folder_of_a_later_window_does_not_push_out_the_run(copied, capsys):
    """Two damaged ones of windows that the run has not come to: its own checkpoints stay."""
    run = copied("disc_cluster")
    for number in ("999999998", "999999999"):
        (run / "checkpoints" / number).mkdir()
    code, said = went_on(run, capsys)
    assert code == 0, said
    assert len(checkpoints(run)) == 2 and all(int(folder.name) < 10**6 for folder in checkpoints(run))


def test_what_is_not_of_the_checkpoints_stays(copied, capsys):
    run = copied("disc_cluster")
    others = [run / "checkpoints" / name for name in ("notes", ".mine.part", "12")]
    for other in others:
        other.mkdir()
    code, said = went_on(run, capsys)
    assert code == 0, said
    assert all(other.is_dir() for other in others)
