"""Grains that several processes share go as by one process, and end as by one."""

import csv
import json
import os
import re
import shutil
import signal
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest
import pyvista

from tests.effects.around.test_by_nozzle import SECOND
from tests.of_ranks import SDPH, WITH_MPI, assert_same_bits, fine, particles, shared_by

pytestmark = WITH_MPI


def on(*effects: str) -> tuple[str, str]:
    """Options of a run with these effects."""
    return "--set", f"effects={json.dumps(effects)}"


EMBEDDED = ("--gas", "embedded")
BED = ("bubbling_bed", *EMBEDDED, "--set", "resolution.spacing_mm=10", "--set", "resolution.cell_mm=10")
BEDDED = (
    "drag", "gas_pressure", "gravity", "granular_pressure", "friction", "granular_viscosity", "granular_temperature",
    "artificial_viscosity", "walls", "heat", "conduction",
)  # fmt: skip
SPRAY, SPRAYED = ("spray_cone", *EMBEDDED), ("inflow", "outflow", "gravity", "drag", "heat", "evaporation")
CASES = {  # name -> processes, scene and options: each effect at least once, in 2-D and 3-D
    "bed: walls, contacts, theta, heat, tracks": (2, *BED, "--until", "0.004"),
    "disc at rest, heated, probes": (2, "disc_cluster", *EMBEDDED, "--until", "2e-4"),
    "jet of a nozzle": (2, "evaporating_jet", *EMBEDDED, "--until", "0.02"),
    "spray: evaporates, leaves": (2, *SPRAY, "--until", "0.02", "--set", "domain.size_m=[0.3,0.3,0.1]", "--set",
                                  "nozzles.cone.centre_m=[0.15,0.15,0.1]", "--set", SECOND),
    "drops that break": (2, *SPRAY, "--until", "0.002", *on(*SPRAYED, "break_up"), "--set",
                         "grains.surface_tension_N_m=0.02", "--set", "break_up.liquid_viscosity_Pa_s=1e-3", "--set",
                         "break_up.products=chi_squared", "--set", "nozzles.cone.speed_m_s=100"),
    "gel droplets": (2, "gel_spray", *EMBEDDED, "--until", "0.004"),
    "char that burns": (2, "burning_char", *EMBEDDED, "--until", "0.01"),
    "two materials": (2, "segregation", *EMBEDDED, "--until", "0.004"),
    "walls that heat, shifting": (2, *BED, "--until", "0.002", "--set", "boundaries.walls.temperature_K=400",
                                  *on(*BEDDED, "wall_heat", "grain_shifting")),
    "cylinder of an OpenFOAM mesh": (2, "cylindrical_bed", "--gas", "openfoam", "--np", "2", "--until", "0.004"),
    "tube with a force": (2, "bed_with_tube", "--gas", "openfoam", "--until", "0.004", "--set",
                          'run.forces=["tube"]'),
}  # fmt: skip
GAS = 1e-9  # of the largest of a field: the gas solves its equations to a tolerance
UNITS = re.compile(r"_(J|kg_m_s|kg|N|Nm)$")  # columns of one of these add up, and cancel, together


def columns(file: Path) -> dict[str, list[str]]:
    """Cells of a table by column."""
    head, *rows = csv.reader(file.read_text().splitlines())
    return dict(zip(head, zip(*rows)))


def table_alike(found: dict, one: dict) -> None:
    """Numbers of tables differ by round-off: shares by a few particles that round-off decides about."""
    assert list(found) == list(one)
    numbers = {name: np.array(cells, float) for name, cells in one.items() if name not in ("limit", "outlet")}
    largest = {}
    for name, values in numbers.items():
        unit = UNITS.search(name)
        key = unit[1] if unit else name
        largest[key] = max(largest.get(key, 0.0), np.nanmax(np.abs(values), initial=0.0))
    for name, values in numbers.items():
        unit, own = UNITS.search(name), np.array(found[name], float)
        bar = 0.01 if name.endswith("_share") else 1e-9 * largest[unit[1] if unit else name]
        # of temperatures that differ in the last digit, and what is left of equations when they hold well enough
        bar = 1e-10 if name.endswith(("_conductive_heat_W", "_rel", "gas_misfit_kg_m_s")) else bar
        np.testing.assert_allclose(own, values, rtol=0.0, atol=bar, equal_nan=True, err_msg=name)
    for name in one.keys() - numbers.keys():
        assert found[name] == one[name]


def alike(found: Path, one: Path, bar: float = 1e-11) -> None:
    """Particles, gas, history, ledger and summary are those of one process."""
    ours, theirs = particles(found), particles(one)
    np.testing.assert_array_equal(ours["ident"], theirs["ident"])
    gas = [pyvista.read(sorted(folder.glob("fields/gas_*"))[-1]) for folder in (found, one)]
    pairs = [(name, ours[name], values, bar) for name, values in theirs.items()]
    pairs += [(name, gas[0][name], gas[1][name], GAS) for name in gas[1].array_names]
    for name, own, values, most in pairs:
        assert np.abs(own - values).max() <= most * max(np.abs(values).max(), 1e-7), name
    for table in ("history.csv", "ledger.csv"):
        table_alike(columns(found / table), columns(one / table))
    left = [columns(folder / "outflow.csv") for folder in (found, one) if (folder / "outflow.csv").is_file()]
    assert not left or sorted(left[0].get("particle", ())) == sorted(left[1].get("particle", ()))
    a, b = (json.loads((folder / "summary.json").read_text()) for folder in (found, one))
    assert a.keys() == b.keys()
    for key in ("sub_steps", "windows", "particles", "wall_contacts", "outflow_particles", "detachment_time_s"):
        assert a.get(key) == b.get(key), key
    for key in ("exchange_energy_mismatch_rel", "exchange_momentum_mismatch_rel", "motion_drift_rel"):
        assert a[key] < 1e-12, key
    assert a["mass_drift_rel"] < 1e-12


@pytest.mark.parametrize("name", CASES)
def test_shared_grains_go_as_one_process_takes_them(tmp_path, name):
    ranks, *options = CASES[name]
    one = fine(tmp_path / "one", *options)  # which compiles most of what both need
    alike(fine(tmp_path / "shared", *options, ranks=ranks), one)
    told = json.loads((tmp_path / "shared/summary.json").read_text())
    assert told["ranks"] == ranks and 1.0 <= told["imbalance"] < 1.5 and told["halo_share"] > 0.0
    assert told.get("broken_kg", 1.0) > 0.0  # or the effect was compared with nothing
    assert "leaves" not in name or told["outflow_particles"] > 0


def test_a_run_repeats_and_goes_on_by_other_processes_or_by_one(tmp_path):
    whole = fine(tmp_path / "whole", *BED, "--until", "0.004")
    shutil.copytree(whole, tmp_path / "one")
    first, again = (fine(tmp_path / f"r{n}", *BED, "--until", "0.004", ranks=2) for n in range(2))
    assert_same_bits(first, again)
    fine(whole, "--resume", whole, "--until", "0.008")
    for cut, several in ((first, 3), (again, 1), (tmp_path / "one", 2)):
        alike(fine(cut, "--resume", cut, "--until", "0.008", ranks=several), whole)


BALL = (
    "bubbling_bed_3d", *EMBEDDED, "--set", "resolution.spacing_mm=10", "--set", "resolution.cell_mm=20", "--set",
    "particles={ball={shape='sphere',centre_m=[0.05,0.05,0.02],radius_m=0.012,volume_fraction=0.5,temperature_K=300}}",
)  # fmt: skip


def test_grains_that_one_process_made_are_shared_and_go_on(tmp_path):
    """Of the lattice around eight grains in space the first of three processes has a corner without any."""
    whole = fine(tmp_path / "whole", *BALL, "--until", "0.002")
    fine(whole, "--resume", whole, "--until", "0.004")
    cut = fine(tmp_path / "three", *BALL, "--until", "0.002", ranks=3)
    alike(fine(cut, "--resume", cut, "--until", "0.004", ranks=3), whole)


def test_when_the_gas_or_a_process_dies_all_end_and_the_run_says_which(tmp_path):
    options = ("cylindrical_bed", "--gas", "openfoam", "--set", "run.checkpoint_windows=1", "--ranks", "2")
    for part, told in (("gas", "sdphGasFoam"), ("rank", "was ended by signal 9")):
        folder = tmp_path / part
        going = subprocess.Popen((*SDPH, *options, "--out", str(folder)), stderr=subprocess.PIPE, text=True)
        end = time.monotonic() + 240.0
        while not list(folder.glob("checkpoints/00000000[1-9]")):
            assert time.monotonic() < end and going.poll() is None
            time.sleep(0.05)
        os.kill(solver(folder) if part == "gas" else max(shared_by(folder)), signal.SIGKILL)
        said = going.communicate(timeout=20.0)[1]
        assert going.returncode == 3 and told in said and "go on with: sdph run --resume" in said, said
        assert "Traceback" not in said and not shared_by(folder)


def solver(folder: Path) -> int:
    """Number of the gas solver's process of a run."""
    for entry in Path("/proc").glob("[0-9]*"):
        words = (entry / "cmdline").read_bytes().decode().split("\0")
        if words[0].endswith("sdphGasFoam") and str(folder / "gas") in words:
            return int(entry.name)
    raise AssertionError("there is no solver")
