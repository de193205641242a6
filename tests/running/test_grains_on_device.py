"""Grains in a gas whose particles are on a device, which numba's simulator plays, go as on the processor; what is not
taken there is refused in one line."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest
import pyvista

from sdph.cli import main
from sdph.running import on_device as taken
from tests.of_ranks import particles
from tests.on_simulator import on_cpu, on_device, there_and_back

EMBEDDED = 'coupling.gas="embedded"'
FEW = ("resolution.neighbour_skin=0.01", "friction.onset=0.55")  # rows hold for a millimetre
SETS = {  # name -> scene, end [s], keys: of some twenty sub-steps in some windows
    "bed": ("bubbling_bed", "1.2e-3", "resolution.spacing_mm=62.5", "resolution.cell_mm=125",
            "boundaries.jet.span_m=[0.125, 0.375]", "particles.bed.velocity_m_s=[8.0, -4.0]",
            "particles.bed.temperature_K=330", "particles.bed.volume_fraction=0.58", "particles.bed.disorder=0.2",
            "coupling.window_tolerance=0.5", "track.particles=[20, 60]", *FEW),
    "bed in space": ("bubbling_bed_3d", "1e-3", "resolution.spacing_mm=62.5", "resolution.cell_mm=125",
                     "domain.size_m=[0.5, 1.0, 0.125]", "boundaries.jet.span_m=[[0.125, 0.375], [0.0, 0.125]]",
                     "particles.bed.upper_m=[0.5, 0.25, 0.125]", "particles.bed.velocity_m_s=[8.0, -4.0, 4.0]",
                     "particles.bed.temperature_K=330", "particles.bed.volume_fraction=0.58",
                     "particles.bed.disorder=0.2", "coupling.window_tolerance=0.5", "walls.specularity=0.1",
                     'boundaries.front.kind="wall"', 'conduction.law="zehner_schluender"', *FEW),
    "two materials": ("segregation", "1e-3", "resolution.spacing_mm=25", "resolution.cell_mm=50",
                      "particles.small.velocity_m_s=[6.0, 0.0]", "particles.large.velocity_m_s=[-6.0, -6.0]",
                      "particles.large.disorder=0.2", *FEW),
}  # fmt: skip
NEAR = 1e-12  # of the largest of a field
OF_DEVICE = {"launches_per_step", "bytes_from_device_per_step", "bytes_to_device_per_step"}


def words(name: str, *more: str) -> list[str]:
    scene, end, *keys = SETS[name]
    keys += [EMBEDDED, f"run.output_interval_s={end}"]
    return ["run", scene, "--until", end, *(word for key in keys for word in ("--set", key)), *more]


def last_row(folder: Path, name: str) -> dict[str, float]:
    with (folder / name).open(encoding="utf-8") as file:
        return {key: float(value) for key, value in list(csv.DictReader(file))[-1].items() if key != "limit"}


def alike(ours: Path, theirs: Path) -> None:
    """Particles in the same order, their fields, the sums of the last window, and what limiters hold."""
    one, other = particles(ours), particles(theirs)
    for name, values in other.items():
        assert np.abs(one[name] - values).max() <= NEAR * max(np.abs(values).max(), 1e-300), name
    a, b = (json.loads((folder / "summary.json").read_text()) for folder in (ours, theirs))
    assert a.keys() - b.keys() <= OF_DEVICE and b.keys() - a.keys() == set()
    for name in ("sub_steps", "windows", "wall_contacts"):
        assert a[name] == b[name], name
    assert a["sub_steps"] > a["windows"]
    ledgers = [last_row(folder, "ledger.csv") for folder in (ours, theirs)]
    for unit in ("_J", "_kg_m_s"):
        of_unit = [key for key in ledgers[1] if key.endswith(unit) and not key.endswith("drift_J")]
        scale = max(abs(ledgers[1][key]) for key in of_unit)
        assert all(abs(ledgers[0][key] - ledgers[1][key]) <= NEAR * scale for key in of_unit)
    rows = [last_row(folder, "history.csv") for folder in (ours, theirs)]
    for key, value in rows[1].items():
        assert rows[0][key] == pytest.approx(value, rel=1e-9, abs=1e-12, nan_ok=True), key


def order(folder: Path, which: int) -> list[int]:
    """Numbers of the particles in the order of the run, in its first or last file."""
    return pyvista.read(sorted(folder.glob("fields/particles_*"))[which])["ident"].tolist()


@pytest.mark.parametrize("name", SETS)
def test_grains_go_on_a_device_as_on_the_processor(tmp_path, name):
    ours, theirs = on_device(tmp_path / "cuda", *words(name)), on_cpu(tmp_path / "cpu", *words(name))
    alike(ours, theirs)
    assert order(ours, -1) == order(theirs, -1)
    told = json.loads((ours / "summary.json").read_text())
    assert 10.0 < told["launches_per_step"] < 500.0 and min(told[key] for key in OF_DEVICE) > 0.0


def test_a_run_goes_on_from_the_processor_on_a_device_and_back(tmp_path):
    there_and_back(tmp_path, words("bed"), "1.5e-3", alike)


@pytest.mark.parametrize(
    "scene, keys, why",
    [
        ("evaporating_jet", (), "evaporation is not taken"),
        ("radiating_grains", (), "radiation is not taken"),
        ("bubbling_bed", ('run.forces=["bottom"]',), "run.forces"),
        ("disc_cluster", (), "stay where they are"),
        pytest.param("bed_with_tube", (), "outflow is not taken", marks=pytest.mark.openfoam),
    ],
)
def test_what_is_not_taken_to_a_device_is_refused_in_one_line(capsys, tmp_path, scene, keys, why):
    given = [word for key in keys for word in ("--set", key)]
    assert main(["run", scene, *given, "--out", str(tmp_path / "run"), "--device", "cuda"]) == 2
    told = [line for line in capsys.readouterr().err.splitlines() if not line.startswith("warning")]
    told = "\n".join(told)
    assert "\n" not in told and why in told and "run.device = 'cuda'" in told and 'give "cpu"' in told
    assert not (tmp_path / "run").exists()


def test_what_is_taken_is_what_is_tested():
    """Each effect of grains that is taken to a device is in one of the runs above."""
    from sdph.case import read
    from sdph.scenes import paths

    ran = set()
    for scene, _, *keys in SETS.values():
        ran |= set(read.load(paths.PACKAGE / "scenes" / scene / "case.toml", tuple(keys)).effects)
    assert ran == set(taken.EFFECTS["grains"])
