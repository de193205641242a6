"""Tanks of a mesh whose surface folds around a plate that stands in them."""

import numpy as np
import pytest
import pyvista

from sdph.case import read as cases
from sdph.effects.around import tank
from sdph.engine.state import LIQUID
from sdph.methods.liquids.start import fill
from sdph.schema import CaseError

SPACING, WIDTH = 0.025, 0.15  # m


def with_plate(path, thickness: float):
    """A tank of 1 x 0.15 x 0.6 m with a plate 0.15 m high in its middle."""
    a, b = 0.5 - 0.5 * thickness, 0.5 + 0.5 * thickness
    outline = [(0.0, 0.0), (a, 0.0), (a, 0.15), (b, 0.15), (b, 0.0), (1.0, 0.0), (1.0, 0.6), (0.0, 0.6)]
    face = pyvista.PolyData([(x, 0.0, z) for x, z in outline], [len(outline), *range(len(outline))])
    solid = face.triangulate().extrude((0.0, WIDTH, 0.0), capping=True).triangulate().clean()
    solid.compute_normals(auto_orient_normals=True, inplace=True)
    solid.save(path)
    return path


def case_of(mesh):
    return cases.from_table({
        "title": "baffle", "dimensions": 3, "effects": ["gravity", "density_diffusion", "tank"],
        "run": {"end_time_s": 1.0, "output_interval_s": 1.0},
        "domain": {"size_m": [1.0, WIDTH, 0.6], "gravity_m_s2": [0.0, 0.0, -9.81]},
        "resolution": {"spacing_mm": 1e3 * SPACING},
        "liquid": {"density_kg_m3": 1000.0, "sound_speed_m_s": 25.0},
        "tank": {"shape": "mesh", "mesh": str(mesh)},
        "pools": {"water": {"shape": "tank", "fill": 0.5}},
    })  # fmt: skip


@pytest.mark.parametrize("spacings", [0.16, 1.0, 1.9])
def test_a_plate_that_holds_nothing_is_refused(tmp_path, spacings):
    with pytest.raises(CaseError, match="thinner than two spacings, 50 mm") as error:
        tank.shape_of(case_of(with_plate(tmp_path / "plate.stl", spacings * SPACING)))
    assert "\n" not in str(error.value)


def test_a_plate_of_two_spacings_has_particles_and_no_liquid_within(tmp_path):
    case = case_of(with_plate(tmp_path / "plate.stl", 2.0 * SPACING))
    shape, state = tank.shape_of(case), fill(case)
    places = np.stack([state.x, state.y, state.z], axis=1)
    liquid = places[state.kind == LIQUID]
    print(len(liquid), shape.distance(liquid).max() / SPACING)
    assert shape.distance(liquid).max() < 0.0
