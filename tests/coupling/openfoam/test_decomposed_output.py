"""`run.pvd` of runs on two ranks: particles and gas on one timeline, on a box and on a mesh that is none."""

import shutil

import numpy as np
import pytest
from gas_boxes import TEMPLATE
from test_restart import Reporter, load

from sdph.running import driver
from sdph.show import timeline, view

pytestmark = pytest.mark.openfoam

SLANTED = """FoamFile { version 2.0; format ascii; class dictionary; object blockMeshDict; }
scale 1;
vertices ((0 0 0) (0.5 0 0) (0.5 0.4 0) (0 0.5 0) (0 0 1) (0.5 0 1) (0.5 0.4 1) (0 0.5 1));
blocks (hex (0 1 2 3 4 5 6 7) (20 20 1) simpleGrading (1 1 1));
edges ();
boundary
(
    walls { type wall; faces ((0 1 5 4) (1 2 6 5) (2 3 7 6) (3 0 4 7)); }
    frontAndBack { type empty; faces ((0 3 2 1) (4 5 6 7)); }
);
mergePatchPairs ();
"""


@pytest.mark.parametrize(("mesh", "kind", "area"), [(None, "RectilinearGrid", 0.25), (SLANTED, "PolyData", 0.225)])
def test_particles_and_gas_of_two_ranks_are_on_one_timeline(tmp_path, mesh, kind, area):
    shutil.copytree(TEMPLATE, tmp_path / "gas")
    if mesh:
        (tmp_path / "gas" / "system" / "blockMeshDict").write_text(mesh)
    case = load("disc_cluster", "openfoam", "coupling.gas_ranks=2", "resolution.cell_mm=25")
    driver.run(case, "disc_cluster", tmp_path / "run", tmp_path / "gas", Reporter())
    assert (tmp_path / "run" / "gas" / "processor1").is_dir()
    reader = timeline.read(tmp_path / "run")
    assert list(reader.time_values) == [0.0, 2e-4, 4e-4]
    for time in reader.time_values:
        _, particles, gas = timeline.state_at(reader, time)
        assert type(gas).__name__ == kind and gas.n_cells == 400 and particles.n_points == 80
        volumes = np.abs(gas.compute_cell_sizes()["Area"])
        assert volumes.sum() == pytest.approx(area, rel=1e-6)
        solid = gas["alpha_p"] * volumes
        # VTK reads places in single precision
        assert solid.sum() == pytest.approx((particles["mass"] / 3060.0).sum(), rel=1e-6)
        centre = solid @ gas.cell_centers().points[:, :2] / solid.sum()  # each cell has its own value
        assert centre == pytest.approx([0.25, 0.25], abs=5e-3)
    assert np.ptp(gas["temperature"]) > 1.0  # the gas among the grains has cooled
    view.show(tmp_path / "run", tmp_path / "run.png")
    assert (tmp_path / "run.png").stat().st_size > 10_000
