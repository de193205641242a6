"""Outlets of a vessel's mesh that lie in no side of the box around it: who went through one has left, by its name."""

import dataclasses

import numpy as np
import pytest
from builders import cloud
from grain_boxes import SPACING, bed_of_patches

from sdph.effects.around import outflow
from sdph.engine.state import GRAIN
from sdph.engine.walls import facets, openings

LOW, HIGH = 0.03, 0.06  # m


def l_shape(path):
    """An L, 60 mm by 60 mm, less its upper right quarter: a chute in the step, the lid open."""
    corners = [(0.0, 0.0), (HIGH, 0.0), (HIGH, LOW), (LOW, LOW), (LOW, HIGH), (0.0, HIGH)]
    lines = np.array([(a, b) for a, b in zip(corners, [*corners[1:], corners[0]])])
    open_ = np.isin(np.arange(6), [3, 4])  # from (30, 30) to (30, 60), and the lid
    facets.save(path, facets.Facets(lines, np.zeros(6, bool), open_, np.array([0, 0, 0, 1, 2, 0])))
    return str(path)


def grains(places, velocities):
    state = cloud(np.array(places))._replace(kind=np.full(len(places), GRAIN, np.int8))
    state.u[:], state.v[:] = np.array(velocities).T
    return state


def test_who_is_behind_an_outlet_within_the_box_has_left(tmp_path):
    case = bed_of_patches(l_shape(tmp_path / "patches.vtk"), (HIGH, HIGH), "walls chute lid")
    places = [(0.031, 0.045), (0.031, 0.045), (0.029, 0.045), (0.045, 0.015), (0.059, 0.059), (0.015, 0.061)]
    moves = [(1.0, 0.0), (-1.0, 0.0), (1.0, 0.0), (1.0, 0.0), (1.0, 0.0), (0.0, 1.0)]
    state = grains(places, moves)
    gone = outflow.leaving(case, state)
    assert gone.tolist() == [True, False, False, False, False, True]  # the fifth is 29 mm behind: further than a window
    assert outflow.leaving(case, state, foreseen=True).tolist() == gone.tolist()
    names = [outflow.exits(case)[k] for k in outflow.through(case, state)[gone]]
    assert names == ["chute", "lid"]


@pytest.mark.parametrize("dimensions", [2, 3])
def test_an_outlet_ends_at_its_edges_and_is_whole_where_two_facets_meet(tmp_path, dimensions):
    """A square across x at 0, open towards +x, of two triangles (of one line in the plane)."""
    if dimensions == 2:
        corners = np.array([[(0.0, 0.0), (0.0, 1.0)]])[:, ::-1]
    else:
        a, b, c, d = (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 1.0, 1.0), (0.0, 0.0, 1.0)
        corners = np.array([(a, b, c), (a, c, d)])
    of = np.zeros(len(corners), bool), np.ones(len(corners), bool), np.full(len(corners), 4)
    facets.save(tmp_path / "patch.vtk", facets.Facets(corners, *of))
    normal = facets.normals(corners)[0, 0]
    found = openings.read(str(tmp_path / "patch.vtk"), dimensions)
    rng = np.random.default_rng(1)
    places = rng.uniform(-0.5, 1.5, (400, dimensions))
    places[0, 1:] = 0.5  # on the edge that the triangles share
    state = cloud(places)
    state.u[:] = -normal
    inside = ((places[:, 1:] >= 0.0) & (places[:, 1:] <= 1.0)).all(axis=1)
    height = places[:, 0] * normal
    expected = inside & (height < 0.0) & (height >= -0.3)
    assert (openings.behind(found, state, 0.3) == np.where(expected, 4, -1)).all() and 10 < expected.sum() < 390
    state.u[:] = normal
    assert (openings.behind(found, state, 0.3) == -1).all()


def test_a_box_has_no_openings_of_a_mesh(tmp_path):
    case = bed_of_patches(l_shape(tmp_path / "patches.vtk"), (HIGH, HIGH), "walls chute lid")
    walls = dataclasses.replace(case.parameters["walls"], source="mesh")
    case = dataclasses.replace(case, parameters=case.parameters | {"walls": walls})
    assert not outflow.leaving(case, grains([(0.031, 0.045)], [(1.0, 0.0)])).any()


def test_a_belt_of_a_vessel_slides_along_its_facets(tmp_path):
    """Dummies behind the floor alone have its velocity, less what is across it."""
    from sdph.engine.walls import sides

    path = l_shape(tmp_path / "patches.vtk")
    case = bed_of_patches(path, (HIGH, HIGH), "walls chute lid")
    belt = dataclasses.replace(case.boundaries["walls"], side="bottom", velocity=(0.5, 0.0))
    table = sides.dummies(dataclasses.replace(case, boundaries=case.boundaries | {"walls": belt})).table
    across = np.abs(table[:, 4]) == 1.0  # floor and step; the others stand along y
    assert across.any() and (table[across, 8] == 0.5).all() and not table[~across, 8].any() and not table[:, 9].any()
    assert len(table) >= 3 * (2.0 * HIGH + HIGH) / SPACING - 9
