"""Surfaces of liquids in space: they end where the liquid does, or stand on the particles of a sheet."""

import numpy as np
import pytest
from test_pictures import SPACING, cloud, lattice, taken

from sdph.show import surfaces


def test_the_surface_in_space_holds_the_liquid_and_has_its_values():
    places = lattice(16, 3)
    ball = places[np.linalg.norm(places - 0.8, axis=1) < 0.7]
    round_drop = taken(cloud(ball, pressure=ball[:, 2]))
    found, shown = surfaces.of_bulk(round_drop, np.ones(len(ball), bool), "pressure")
    assert shown.all()
    assert found.volume == pytest.approx(len(ball) * SPACING**3, rel=0.05)
    assert np.linalg.norm(found.points - 0.8, axis=1) == pytest.approx(0.7, abs=0.06)
    assert np.asarray(found["pressure"]) == pytest.approx(found.points[:, 2], abs=0.08)


def test_a_thin_sheet_in_a_wide_room_is_drawn_as_triangles(monkeypatch):
    """The grid for its surface would not fit into memory. A layer bent around a pipe, and one particle off it."""
    angle, along = (grid.ravel() for grid in np.meshgrid(np.arange(120) * SPACING / 3.0, np.arange(90) * SPACING))
    pipe = np.stack((3.0 * np.cos(angle), 3.0 * np.sin(angle), along), axis=1)
    pipe += np.random.default_rng(1).normal(0.0, 0.01 * SPACING, pipe.shape)  # four on a circle have two ways
    places = np.vstack((pipe, [[60.0, 60.0, 20.0]]))
    wide = taken(cloud(places, pressure=places[:, 2]))
    liquid = np.ones(len(places), bool)
    assert not surfaces.affordable(wide, liquid)
    assert surfaces.affordable(taken(cloud(lattice(16, 3))), np.ones(16**3, bool))
    found, shown = surfaces.of_liquid(wide, liquid, "pressure")
    assert shown[:-1].all() and not shown[-1]
    assert np.linalg.norm(np.diff(found.points[found.regular_faces], axis=1), axis=2).max() < 2.08 * SPACING
    assert np.asarray(found["pressure"]) == pytest.approx(found.points[:, 2])
    monkeypatch.setattr(surfaces, "MANY", len(places) - 1)
    found, shown = surfaces.of_liquid(wide, liquid, "pressure")
    assert not found.n_points and not shown.any()


def test_particles_that_have_come_near_in_a_wide_room_are_none_the_less_shown():
    """VTK leaves out what is nearer than a thousandth of the room, which is more than a spacing here."""
    places = np.column_stack((lattice(12, 2), np.zeros(144)))
    places[::2] += 0.3 * SPACING * np.array([1.0, 0.0, 0.0])
    sheet = np.vstack([places, places + np.array([90.0, 90.0, 20.0])])
    sheet += np.random.default_rng(1).normal(0.0, 0.05 * SPACING, sheet.shape)
    assert surfaces.of_film(taken(cloud(sheet)), np.ones(len(sheet), bool), "")[1].all()


@pytest.mark.parametrize("count", [2, 4])
def test_particles_far_apart_have_no_surface(count):
    far = np.array([[0.0, 0.0, 0.0], [60.0, 60.0, 20.0], [30.0, 0.0, 20.0], [0.0, 30.0, 5.0]])[:count]
    found, shown = surfaces.of_liquid(taken(cloud(far)), np.ones(count, bool), "")
    assert not found.n_cells and not shown.any()


def test_a_tear_of_three_spacings_stays_open():
    places = lattice(20, 2)
    sheet = np.column_stack((places, np.zeros(len(places))))[np.abs(places[:, 0] - 1.0) > 1.1 * SPACING]
    sheet += np.random.default_rng(1).normal(0.0, 0.05 * SPACING, sheet.shape)
    found, shown = surfaces.of_film(taken(cloud(sheet)), np.ones(len(sheet), bool), "")
    assert shown.all()
    sides = found.points[found.regular_faces][:, :, 0] > 1.0
    assert (sides.all(axis=1) | ~sides.any(axis=1)).all()
