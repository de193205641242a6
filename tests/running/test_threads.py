"""Two threads share the loops of a run and find what one finds."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from of_ranks import particles, run

ROUND_OFF = 1e-9  # of the largest value of a field: sums are taken in another order, and a few steps make it grow
# One of each method, two of liquids: the scene, its end [s], coarse.
RUNS = {
    "grains": ("bubbling_bed", "--until", "2e-3", "--gas", "embedded", "--set", "resolution.spacing_mm=10"),
    "liquids": ("dam_break", "--until", "4e-3", "--set", "resolution.spacing_mm=5.715"),
    "liquids with a surface": ("drop_on_plate", "--until", "1e-4"),
    "moving particles": ("swirl_sheet", "--until", "6e-5"),
    "solids": ("colliding_rings", "--until", "2e-5", "--set", "resolution.spacing_mm=2.5"),
}


@pytest.mark.parametrize("method", RUNS)
def test_two_threads_find_what_one_finds(method, tmp_path):
    found = []
    for threads in ("1", "2"):
        folder = tmp_path / threads
        done = run(*RUNS[method], "--out", folder, env=os.environ | {"NUMBA_NUM_THREADS": threads})
        assert done.returncode == 0, done.stderr
        found.append(particles(folder))
    one, two = found
    assert len(one["ident"]) > 50
    for name in one:
        largest = np.max(np.abs(one[name]))
        np.testing.assert_allclose(two[name], one[name], rtol=0.0, atol=ROUND_OFF * largest, err_msg=name)


def test_what_loops_take_and_sum_holds_with_two_threads():
    own = os.environ | {"NUMBA_NUM_THREADS": "2"}
    tests = [str(Path(__file__).parents[1] / name) for name in ("laws/test_by_reference.py", "engine/test_linear.py")]
    command = (sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *tests)
    done = subprocess.run(command, env=own, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout
