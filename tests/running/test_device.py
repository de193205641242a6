"""A liquid whose particles are on a device goes as on the processor; what is not taken there is refused in one line.
Where there is no device numba's simulator plays one."""

import functools
import json
import os
from pathlib import Path

import numpy as np
import pytest

from sdph.cli import main
from sdph.engine.gpu import found
from sdph.running import on_device as taken
from tests import on_simulator
from tests.of_ranks import particles
from tests.on_simulator import on_cpu, on_device, there_and_back

SETS = {  # name -> scene, end [s] of five to fifteen steps, keys
    "front": ("dam_break", "2e-3", "resolution.spacing_mm=9.525", "domain.size_m=[0.13335, 0.13335]",
              "pools.column.velocity_m_s=[2.0, 0.5]"),
    "shaken": ("sloshing_box", "0.01", "resolution.spacing_mm=75", "pools.water.velocity_m_s=[1.0, 0.0]"),
    "two phases": ("dam_break_gas", "1.5e-3", "resolution.spacing_mm=19.05", "domain.size_m=[0.17145, 0.17145]",
                   "pools.air.upper_m=[0.17145, 0.17145]"),
    "periodic, shifted, viscous": ("taylor_green", "0.012", "resolution.spacing_mm=100"),
    "in space": ("dam_break_3d", "1.2e-3", "resolution.spacing_mm=14.2875", "resolution.smoothing_ratio=1.0",
                 "domain.size_m=[0.08, 0.12, 0.028575]", "pools.column.velocity_m_s=[2.0, 0.0, 0.0]"),
    "corrected, xsph": ("square_patch", "0.05", "resolution.spacing_mm=125", 'liquid.pressure_gradient="corrected"',
                        'effects=["density_diffusion", "shifting", "xsph"]'),
}  # fmt: skip
NEAR = 1e-12  # of the largest of a field
OF_DEVICE = {"launches_per_step", "bytes_from_device_per_step", "bytes_to_device_per_step"}
KEYS = ("work_of_gravity_J", "work_of_walls_J", "kinetic_energy_J", "dissipated_J", "work_of_frame_J", "shifting_J")


def words(name: str, *more: str) -> list[str]:
    scene, end, *keys = SETS[name]
    keys += [f"run.output_interval_s={end}", f"liquid.history_interval_s={end}"]
    return ["run", scene, "--until", end, *(word for key in keys for word in ("--set", key)), *more]


def alike(ours: Path, theirs: Path) -> None:
    """Particles in the same order, their fields, and the sums of the run."""
    one, other = particles(ours), particles(theirs)
    for name, values in other.items():
        assert np.abs(one[name] - values).max() <= NEAR * max(np.abs(values).max(), 1e-300), name
    a, b = (json.loads((folder / "summary.json").read_text()) for folder in (ours, theirs))
    assert a.keys() - b.keys() <= OF_DEVICE and b.keys() - a.keys() == set()
    assert a["sub_steps"] == b["sub_steps"] > 4
    scale = max(abs(b[key]) for key in KEYS)
    for key in KEYS:
        assert abs(a[key] - b[key]) <= NEAR * scale, key
    assert a["mass_drift_rel"] == 0.0 and a["momentum_drift_rel"] < 1e-12
    shares = [key for key in b if key.endswith("_share")]
    assert all(a[key] == b[key] for key in shares)


@pytest.fixture(scope="module")
def pair(tmp_path_factory):
    """Folders of a run on a device and of the same on the processor, made once."""

    @functools.cache
    def made(name: str) -> tuple[Path, Path]:
        folder = tmp_path_factory.mktemp("pair")
        return on_device(folder / "cuda", *words(name)), on_cpu(folder / "cpu", *words(name))

    return made


@pytest.mark.parametrize("name", SETS)
def test_a_liquid_goes_on_a_device_as_on_the_processor(pair, name):
    alike(*pair(name))
    told = json.loads((pair(name)[0] / "summary.json").read_text())
    assert 10.0 < told["launches_per_step"] < 200.0 and min(told[key] for key in OF_DEVICE) > 0.0


def test_rows_are_made_anew_on_the_device_and_particles_stand_as_on_the_processor(pair):
    """The front runs as far as rows hold more than once; files have the particles in the order of the run."""
    import pyvista

    found = [[pyvista.read(file)["ident"].tolist() for file in sorted(folder.glob("fields/particles_*"))]
             for folder in pair("front")]  # fmt: skip
    assert found[0][-1] == found[1][-1] != sorted(found[1][-1])
    assert found[1][0] != found[1][-1]


def test_a_run_goes_on_from_the_processor_on_a_device_and_back(tmp_path):
    there_and_back(tmp_path, words("front"), "2.6e-3", alike)


@pytest.mark.skipif(bool(found.missing()), reason=f"1000 steps are too long for the simulator ({found.missing()})")
@pytest.mark.parametrize("name", ("dam_break_3d", "taylor_green"))
def test_a_thousand_steps_on_a_device_lose_nothing_and_repeat(tmp_path, name):
    given = ("run", name, "--until", "0.06" if name == "dam_break_3d" else "0.27")
    one, other = (on_device(tmp_path / part, *given) for part in ("one", "other"))
    told = json.loads((one / "summary.json").read_text())
    assert told["sub_steps"] >= 1000 and told["mass_drift_rel"] == 0.0 and told["momentum_drift_rel"] < 1e-11
    assert told["energy_made_rel"] < 0.02
    for field, values in particles(one).items():
        assert np.array_equal(values, particles(other)[field]), field


def refusal(capsys, *given: str) -> str:
    assert main([*given, "--device", "cuda"]) == 2
    told = capsys.readouterr().err.strip()
    assert "\n" not in told
    return told


@pytest.mark.parametrize(
    "scene, keys, why",
    [
        ("channel_bore", (), "inflow is not taken"),
        ("capillary_wave", (), "surface_tension is not taken"),
        ("dam_break", ('run.forces=["tank"]',), "run.forces"),
    ],
)
def test_what_is_not_taken_to_a_device_is_refused_in_one_line(capsys, tmp_path, scene, keys, why):
    given = [word for key in keys for word in ("--set", key)]
    told = refusal(capsys, "run", scene, *given, "--out", str(tmp_path / "run"))
    assert why in told and "run.device = 'cuda'" in told and 'give "cpu"' in told
    assert not (tmp_path / "run").exists()


def test_without_numba_cuda_or_a_device_one_line_says_what_to_do(capsys, tmp_path, monkeypatch):
    monkeypatch.setattr(found.importlib.util, "find_spec", lambda name: None)
    told = refusal(capsys, "run", "dam_break", "--out", str(tmp_path / "run"))
    assert "pip install 'sdph[cuda]'" in told and "numba-cuda" in told
    monkeypatch.setattr(found.importlib.util, "find_spec", lambda name: object())
    if found.missing():  # no device here
        told = refusal(capsys, "run", "dam_break", "--out", str(tmp_path / "run"))
        assert "there is no CUDA device here" in told
    assert not (tmp_path / "run").exists()


def test_a_device_is_of_one_process(capsys, tmp_path):
    told = refusal(capsys, "run", "dam_break", "--ranks", "2", "--out", str(tmp_path / "run"))
    assert "a device is of one process" in told


def test_doctor_tells_of_the_device(capsys):
    main(["doctor"])
    line = next(line for line in capsys.readouterr().out.splitlines() if line.startswith("CUDA device"))
    assert found.described() in line
    done = on_simulator.simulated("doctor")
    assert "simulator" in next(line for line in done.stdout.splitlines() if line.startswith("CUDA device"))


def test_what_is_taken_is_what_is_tested():
    """Each effect that is taken to a device is in one of the runs above."""
    from sdph.case import read
    from sdph.scenes import paths

    ran = set()
    for scene, _, *keys in SETS.values():
        ran |= set(read.load(paths.PACKAGE / "scenes" / scene / "case.toml", tuple(keys)).effects)
    assert ran == set(taken.EFFECTS["liquid"]) and "NUMBA_ENABLE_CUDASIM" not in os.environ
