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
    with pytest.raises(CaseError, match=r"tank.mesh = .*a cell of type triangle names a point that is not there; it has 4"):
        surface.read(str(tmp_path / "m.vtk"), "tank.mesh")
