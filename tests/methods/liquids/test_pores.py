"""Voids by flooding: a ring with and without a gap, one flung open, one that is filled."""

import math

import numpy as np
import pytest

from sdph.methods.liquids import pores

SPACING = 0.02


def ring(opening=0.0, wide=0.04):
    """Particles of a ring of radius 1 with a gap [m] on the right."""
    x, y = (axis.ravel() for axis in np.meshgrid(*2 * [np.arange(-100, 100) * SPACING], indexing="ij"))
    kept = (np.abs(np.hypot(x, y) - 1.0) < wide) & ~((x > 0.0) & (np.abs(y) < 0.5 * opening))
    return np.stack([x, y], axis=1)[kept]


def seen(points, place=(0.0, 0.0)):
    grid = pores.find(points, SPACING)
    return grid, pores.pore(grid, pores.start(grid, place, 0.3))


def test_a_closed_void_has_its_area_and_no_way_out():
    grid, pore = seen(ring())
    assert (pore.width, pore.lost) == (0.0, False)
    assert pore.area == pytest.approx(math.pi * (1.0 - 0.04) ** 2, rel=0.03)
    depth = pore.depth[grid.at(np.array([0.96, 1.04]), np.zeros(2))]
    beyond = pore.beyond[grid.at(np.array([0.96, 1.04]), np.zeros(2))]
    assert depth[0] < beyond[0] and beyond[1] < depth[1]


@pytest.mark.parametrize("gap", [0.2, 0.5])
def test_the_way_out_is_as_wide_as_the_gap_and_the_void_ends_there(gap):
    _, pore = seen(ring(gap))
    assert pore.width == pytest.approx(gap - SPACING, abs=1.5 * SPACING) and not pore.lost
    # half a lens of air before the gap is not of the void, or is: no more than that
    assert pore.area == pytest.approx(math.pi * (1.0 - 0.04) ** 2, rel=0.05)
    assert np.hypot(*pore.rim) < 0.1


def test_what_nothing_narrows_is_one_with_the_air():
    _, pore = seen(ring(1.9))
    assert pore.lost


def test_air_goes_on_beyond_the_grid():
    """A gap wider than the margin of the grid leads out."""
    _, pore = seen(ring(1.2))
    assert pore.width == pytest.approx(1.2 - SPACING, abs=3.0 * SPACING)


def test_where_all_is_filled_no_void_begins():
    grid = pores.find(np.stack([axis.ravel() for axis in np.meshgrid(*2 * [np.arange(20) * SPACING])], axis=1), SPACING)
    assert pores.start(grid, (0.2, 0.2), 0.1) is None
