"""Particles of several processes are written in pieces and read as one, whatever was in the folder before."""

import shutil

import numpy as np
import pytest
import pyvista

from sdph.cli import main
from sdph.running.fields import ENTRY, Fields
from sdph.schema import CaseError
from sdph.show import timeline
from tests.of_ranks import WITH_MPI, Among, fine, together

BED = ("bubbling_bed", "--gas", "embedded", "--set", "resolution.spacing_mm=10", "--set", "resolution.cell_mm=10")
LIQUID = ("dam_break", "--set", "resolution.spacing_mm=5.715")


def cloud(first: int, count: int):
    """Particles with numbers from `first` on."""
    number = first + np.arange(count)
    points = pyvista.PolyData(np.stack([number, 0.5 * number, 0.1 * number], axis=1).astype(float))
    if count:
        points["velocity"], points["ident"] = np.array(points.points) / 3.0, number
        points["kind"], points["mass"], points["density"] = np.zeros(count, np.int8), 1.0 / (1 + number), 2.0 * number
    return points


def written(folder, counts, fields=None):
    """Fields that so many processes wrote, with so many particles each; `fields` go on where they are given."""
    (folder / "fields").mkdir(parents=True, exist_ok=True)
    firsts, fields = np.cumsum([0, *counts]), fields or [Fields(folder, own) for own in Among.several(len(counts))]

    def write(rank):
        fields[rank].write(1.0 * len(fields[rank].entries), {"particles": cloud(int(firsts[rank]), counts[rank])})

    together(write, range(len(counts)))
    return fields


@pytest.mark.parametrize("counts", [(3, 4), (5, 0, 2), (0, 6), (0, 0, 0)])
def test_pieces_are_read_as_one_in_the_order_of_the_ranks(tmp_path, counts):
    fields = written(tmp_path / "run", counts)
    shutil.move(tmp_path / "run", tmp_path / "moved")
    _, found, gas = timeline.state_at(timeline.read(tmp_path / "moved"))
    whole = cloud(0, sum(counts))
    foreign = pyvista.read(tmp_path / "moved/fields/particles_00000.pvtu")
    assert isinstance(found, pyvista.PolyData) and gas is None and foreign.n_points == sum(counts)
    assert sorted(found.array_names) == sorted(whole.array_names) == sorted(foreign.array_names)
    assert found.n_verts == whole.n_verts
    for values, ours, theirs in ((whole.points, found.points, foreign.points), *(
        (whole[name], found[name], foreign[name]) for name in whole.array_names
    )):  # fmt: skip
        np.testing.assert_array_equal(ours, values)
        np.testing.assert_array_equal(theirs, values)
    assert sum(counts) == 0 or all(found[name].dtype == whole[name].dtype for name in whole.array_names)
    assert ENTRY.fullmatch(fields[0].entries[0])
    names = {path.name for path in (tmp_path / "moved/fields/pieces").iterdir()}
    assert names == {f"particles_00000_{rank:04d}.vtu" for rank, count in enumerate(counts) if count}


@pytest.mark.parametrize(
    ("before", "after"), [((2, 3, 4), (4, 5)), ((3, 3), (6,)), ((6,), (3, 0, 3)), ((2, 3), (5, 0))]
)
def test_an_instant_that_is_written_again_leaves_nothing_of_what_was_there(tmp_path, before, after):
    written(tmp_path, before)
    written(tmp_path, after)
    files = sorted(path.name for path in tmp_path.rglob("particles_*"))
    pieces = [f"particles_00000_{rank:04d}.vtu" for rank, count in enumerate(after) if count]
    assert files == sorted(["particles_00000.pvtu", *pieces] if len(after) > 1 else ["particles_00000.vtp"])
    assert timeline.state_at(timeline.read(tmp_path))[1]["ident"].tolist() == list(range(sum(after)))


def test_an_instant_is_named_once_all_pieces_are_there(tmp_path, monkeypatch):
    """Where one process does not get to the end, readers find the instants before it."""
    fields = written(tmp_path, (2, 2))
    fail = fields[1].world
    monkeypatch.setattr(fail, "gather", lambda value: fail.barrier.abort())
    with pytest.raises(Exception, match="^$"):  # the barrier is broken
        written(tmp_path, (2, 2), fields)
    assert not (tmp_path / "fields/particles_00001.pvtu").exists()
    assert timeline.read(tmp_path).time_values == [0.0]


HARM = {
    "no piece": lambda folder: (folder / "pieces/particles_00000_0001.vtu").unlink(),
    "cut": lambda folder: (folder / "pieces/particles_00000_0001.vtu").write_text("<VTKFile>"),
    "outside": lambda folder: _put(folder, "pieces/particles_00000_0001.vtu", "../../particles_00000_0001.vtu"),
    "absolute": lambda folder: _put(folder, "pieces/particles_00000_0001.vtu", "/etc/passwd"),
    "no XML": lambda folder: (folder / "particles_00000.pvtu").write_text("<VTKFile"),
    "another's": lambda folder: _without_arrays(folder),
    "not there": lambda folder: (folder / "particles_00000.pvtu").unlink(),
}


def _without_arrays(folder) -> None:
    pyvista.PolyData(np.ones((1, 3))).cast_to_unstructured_grid().save(folder / "pieces/particles_00000_0001.vtu")


def _put(folder, old: str, new: str) -> None:
    file = folder / "particles_00000.pvtu"
    file.write_text(file.read_text().replace(old, new))


@pytest.mark.parametrize("harm", HARM)
def test_damaged_pieces_are_told_in_one_line(tmp_path, harm):
    written(tmp_path, (2, 3))
    HARM[harm](tmp_path / "fields")
    with pytest.raises(CaseError, match="particles_00000.pvtu is damaged or missing") as told:
        timeline.state_at(timeline.read(tmp_path))
    assert "\n" not in str(told.value)


def read_by_all(folder) -> None:
    """Commands and Python read the particles of a run."""
    assert main(["view", str(folder), "--png", str(folder.with_suffix(".png"))]) == 0
    assert main(["report", str(folder), "--out", str(folder.with_suffix(".html"))]) == 0


@WITH_MPI
@pytest.mark.parametrize(("options", "ranks", "ends"), [(BED, 2, ("0.002", "0.004")), (LIQUID, 3, ("0.01", "0.02"))])
def test_a_run_in_pieces_is_read_as_that_of_one_process_wherever_it_is(tmp_path, options, ranks, ends):
    interval = ("--set", f"run.output_interval_s={ends[0]}")
    shared = fine(tmp_path / "shared", *options, *interval, "--until", ends[0], ranks=ranks)
    assert not list(shared.glob("fields/particles_*.vtp")) and len(list(shared.glob("fields/pieces/*"))) == 2 * ranks
    fine(shared, "--resume", shared, "--until", ends[1])
    one = fine(tmp_path / "one", *options, *interval, "--until", ends[1])
    ours, theirs = timeline.read(shutil.move(shared, tmp_path / "moved")), timeline.read(one)
    assert ours.time_values == theirs.time_values
    assert [ours.files[time][0].suffix for time in ours.time_values] == [".pvtu", ".pvtu", ".vtp"]
    for time in ours.time_values:
        (_, found, gas), (_, known, other) = (timeline.state_at(own, time) for own in (ours, theirs))
        order, like = np.argsort(found["ident"]), np.argsort(known["ident"])
        assert sorted(found.array_names) == sorted(known.array_names) and (gas is None) == (other is None)
        for name in known.array_names:
            largest = np.abs(known[name]).max()
            assert np.abs(found[name][order] - known[name][like]).max() <= 1e-9 * max(largest, 1e-7), name
    read_by_all(tmp_path / "moved")
