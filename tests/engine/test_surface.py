"""Surface meshes: what is damaged is refused in one line, before anything is computed from it."""

import meshio
import numpy as np
import pytest

from sdph.engine import surface
from sdph.schema import CaseError

POINTS = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])


@pytest.mark.parametrize("wrong", [4, 10**6, -1])
def test_a_cell_of_points_that_are_not_there_is_refused(tmp_path, wrong):
    meshio.Mesh(POINTS, [("triangle", np.array([[0, 1, 2], [0, 1, wrong]]))]).write(tmp_path / "m.vtk", binary=False)
    with pytest.raises(
        CaseError, match=r"tank.mesh = .*a cell of type triangle names a point that is not there; it has 4"
    ):
        surface.read(str(tmp_path / "m.vtk"), "tank.mesh")


def test_a_mesh_of_gigabytes_is_refused_before_it_is_read(tmp_path):
    with open(tmp_path / "m.stl", "wb") as file:
        file.truncate(3 * 2**30)
    with pytest.raises(CaseError, match="it has 3221225472 bytes; at most 134217728 are allowed"):
        surface.read(str(tmp_path / "m.stl"), "walls.mesh")
