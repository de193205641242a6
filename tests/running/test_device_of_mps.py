"""Moving particles on a device go as on the processor: a sheet whose pieces leave, pools with walls and without,
pressure without its equations; what is not taken there is refused in one line. Without a device numba's simulator plays
one."""

import json

import numpy as np
import pytest
from test_device import OF_DEVICE, refusal

from sdph.methods.mps.method import WORKS
from sdph.running import on_device as taken
from tests.of_ranks import particles
from tests.on_simulator import on_cpu, on_device, there_and_back

# a nozzle of two rings, and a drop that flies out of the domain, whose end the sheet passes
SHEET = (
    "resolution.spacing_mm=0.2", "nozzles.mouth.inner_radius_m=3e-4", "nozzles.mouth.radius_m=7e-4",
    "domain.size_m=[0.008, 0.008, 0.0004]", "nozzles.mouth.centre_m=[0.004, 0.004, 0.0]",
)  # fmt: skip
DROP = (
    'pools.drop.shape="sphere"', "pools.drop.centre_m=[0.0079, 0.004, 0.0004]", "pools.drop.radius_m=2.5e-4",
    "pools.drop.velocity_m_s=[40.0, 0.0, 0.0]",
)  # fmt: skip
DISC = "{shape='disc', centre_m=[0.03, 0.03, 0.0], direction=[0.0, 0.0, 1.0], radius_m=0.0015, speed_m_s=20.0}"
MPS = 'method.name="mps"'
SETS = {  # name -> scene, end [s] of a few steps, keys
    "sheet": ("swirl_sheet", "4.5e-5", *SHEET, *DROP),
    "without equations": ("swirl_sheet", "2e-5", *SHEET, 'method.pressure="weakly_compressible"'),
    "in a tank": ("dam_break", "0.02", MPS, "resolution.spacing_mm=9.525", "domain.size_m=[0.13335, 0.13335]",
                  "pools.column.velocity_m_s=[2.0, 0.5]"),
    "periodic": ("taylor_green", "0.07", MPS, "resolution.spacing_mm=100", "pools.square.lower_m=[0.0, 0.3]",
                 "pools.square.upper_m=[1.0, 0.9]"),
    "in space": ("dam_break_3d", "0.01", MPS, "resolution.spacing_mm=14.2875", "domain.size_m=[0.08, 0.12, 0.028575]",
                 "pools.column.velocity_m_s=[2.0, 0.0, 0.0]"),
}  # fmt: skip
NEAR = 1e-12  # of the largest of a field
SUMS = [f"work_of_{name}_J" for name in WORKS] + ["kinetic_energy_J", "injected_J", "left_J"]
WHOLE = ("sub_steps", "liquid_particles", "poisson_iterations_mean", "droplets", "cut_particles")


def words(name: str, until: str = "") -> list[str]:
    scene, end, *keys = SETS[name]
    end = until or end
    keys += [f"run.output_interval_s={end}", f"liquid.history_interval_s={end}"]
    return ["run", scene, "--until", end, *(word for key in keys for word in ("--set", key))]


def summary(folder) -> dict:
    return json.loads((folder / "summary.json").read_text())


def alike(ours, theirs) -> None:
    """Particles, their fields, numbers of pieces and of iterations, and the sums of the run."""
    one, other = particles(ours), particles(theirs)
    for name, values in other.items():
        assert len(one[name]) == len(values)
        assert np.abs(one[name] - values).max() <= NEAR * max(np.abs(values).max(), 1e-300), name
    a, b = summary(ours), summary(theirs)
    assert a.keys() - b.keys() <= OF_DEVICE and b.keys() - a.keys() == set()
    assert all(a[key] == b[key] for key in WHOLE if key in b) and b["sub_steps"] > 4
    scale = max(abs(b[key]) for key in SUMS)
    for key in SUMS:
        assert abs(a[key] - b[key]) <= NEAR * scale, key
    assert max(a[key] for key in ("mass_drift_rel", "momentum_drift_rel", "energy_drift_rel")) < 1e-12
    assert all(a[key] == pytest.approx(b[key], rel=1e-9) for key in b if key.endswith("_share"))


@pytest.mark.parametrize("name", SETS)
def test_moving_particles_go_on_a_device_as_on_the_processor(tmp_path, name):
    cpu, cuda = on_cpu(tmp_path / "cpu", *words(name)), on_device(tmp_path / "cuda", *words(name))
    alike(cuda, cpu)
    assert min(summary(cuda)[key] for key in OF_DEVICE) > 0.0
    if name == "sheet":
        told = summary(cpu)
        assert told["droplets"] > 0 and told["cut_particles"] > 0 and told["work_of_collisions_J"] < 0.0
        assert (cuda / "droplets.csv").read_text().count("\n") == (cpu / "droplets.csv").read_text().count("\n") > 1


def test_a_run_goes_on_from_the_processor_on_a_device_and_back(tmp_path):
    there_and_back(tmp_path, words("sheet", "1.5e-5"), "2.5e-5", alike)


@pytest.mark.parametrize(
    "keys, why",
    [
        ((f"nozzles.mouth={DISC}",), "nozzles.mouth is no annulus"),
        (('effects=["laminar_viscosity","free_energy_tension","inflow","outflow","suction"]',
          "suction.gas_density_kg_m3=1.2"), "suction is not taken"),
        (('effects=["laminar_viscosity","free_energy_tension","inflow","outflow","perforation"]',
          "perforation.thickness_um=100.0", "perforation.spacing_mm=0.4"), "perforation is not taken"),
    ],
)  # fmt: skip
def test_what_is_not_taken_to_a_device_is_refused_in_one_line(capsys, tmp_path, keys, why):
    given = [word for key in keys for word in ("--set", key)]
    told = refusal(capsys, "run", "swirl_sheet", *given, "--out", str(tmp_path / "run"))
    assert why in told and "run.device = 'cuda'" in told and 'give "cpu"' in told
    assert not (tmp_path / "run").exists()


def test_what_is_taken_is_what_is_tested():
    from sdph.case import read
    from sdph.scenes import paths

    ran = set()
    for scene, _, *keys in SETS.values():
        ran |= set(read.load(paths.PACKAGE / "scenes" / scene / "case.toml", tuple(keys)).effects)
    assert ran == set(taken.EFFECTS["mps"])
