"""Moving particles that several processes share go as by one process: pressure, pieces, holes, checkpoints."""

import json

import pytest

from tests.of_ranks import WITH_MPI, alike, assert_same_bits, fine

pytestmark = WITH_MPI
AMOUNTS = ("work_of_gravity_J", "kinetic_energy_J", "injected_kg", "left_kg")
MPS = ("--set", "method.name=mps", "--set")
POOL = ("dam_break", *MPS, "resolution.spacing_mm=5.715")
SHEET = (
    "swirl_sheet", "--set", "domain.size_m=[0.01,0.01,0.002]", "--set", "nozzles.mouth.centre_m=[0.005,0.005,0.0]",
    "--set", "resolution.spacing_mm=0.15", "--set",
    'effects=["laminar_viscosity","free_energy_tension","inflow","outflow","suction","perforation"]',
    "--set", "suction.gas_density_kg_m3=5.0", "--set", "perforation.thickness_um=150", "--set",
    "perforation.spacing_mm=0.4", "--set",
)  # fmt: skip
CASES = {  # name -> processes, scene and options: each effect at least once, in two dimensions and in three
    "pool at walls, kept apart": (2, *POOL, "--until", "0.02"),
    "patch that holds together": (3, "square_patch", *MPS, "resolution.spacing_mm=50", "--until", "0.05"),
    "drop that collides": (3, "oscillating_droplet", *MPS, "resolution.spacing_mm=0.1", "--until", "1e-4", "--set",
                           "pools.drop.speed_m_s=1", "--set", "method.collision=0.95"),
    "sheet, holes, pieces that leave": (3, *SHEET, "run.end_time_s=2.5e-4"),
    "sheet, weakly compressible": (2, *SHEET, "run.end_time_s=1e-4", "--set", "method.pressure=weakly_compressible"),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_shared_moving_particles_go_as_one_process_takes_them(tmp_path, name):
    ranks, *options = CASES[name]
    one = fine(tmp_path / "one", *options)
    alike(fine(tmp_path / "shared", *options, ranks=ranks), one, 1e-12, AMOUNTS)
    ours, theirs = (json.loads((tmp_path / who / "summary.json").read_text()) for who in ("shared", "one"))
    assert ours["ranks"] == ranks and 1.0 <= ours["imbalance"] < 1.3 and ours["halo_share"] > 0.0
    for key in ("droplets", "cut_particles", "holes", "poisson_iterations_mean"):
        assert ours.get(key) == theirs.get(key), key
    if "collide" in name:
        assert ours["work_of_collisions_J"] < -1e-5
    if "pieces" in name:
        assert ours["droplets"] > 5 and ours["cut_particles"] > 100 and ours["holes"] > 100
        assert ours["instants"] == theirs["instants"] > 5
        assert ours["half_angle_mean_deg"] == pytest.approx(theirs["half_angle_mean_deg"], rel=1e-9)


def test_a_sheet_goes_on_by_other_processes_or_by_one(tmp_path):
    """Holes, waves that grow, streams and pieces that left are taken up by all."""
    end = "run.end_time_s=2e-4"
    whole = fine(tmp_path / "whole", *SHEET, end)
    for first, then in ((2, 1), (1, 2)):
        part = fine(tmp_path / f"by{first}", *SHEET, end, "--until", "1e-4", ranks=first)
        alike(fine(part, "--resume", part, "--until", "2e-4", ranks=then), whole, 1e-12, AMOUNTS)
        told = [json.loads((folder / "summary.json").read_text()) for folder in (part, whole)]
        assert told[0]["holes"] == told[1]["holes"] > 10


def test_the_same_processes_repeat_it_to_the_last_bit(tmp_path):
    assert_same_bits(*(fine(tmp_path / f"r{n}", *POOL, "--until", "0.005", ranks=3) for n in range(2)))
