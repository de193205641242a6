"""Bubble metrics of fields made up: a round void in a bed, once free and once on the floor, plane and as a slab."""

import numpy as np
import pytest

from sdph.running.metrics import bubble
from sdph.schema import CaseError

CELL, SIZE = 0.01, (0.5, 1.0)  # m


def bed(middle, radius, depth=None):
    """Centres, volumes, alpha_p, temperature and pressure of a bed 0.6 m high with a round void; `depth` cells along
    z."""
    ticks = [(np.arange(round(length / CELL)) + 0.5) * CELL for length in SIZE] + [(np.arange(depth or 1) + 0.5) * CELL]
    centres = np.stack([a.ravel() for a in np.meshgrid(*ticks, indexing="ij")], axis=1)
    inside = np.hypot(centres[:, 0] - middle[0], centres[:, 1] - middle[1]) < radius
    alpha_p = np.where(inside | (centres[:, 1] > 0.6), 0.0, 0.6)
    volumes = np.full(len(centres), CELL**2 * (CELL if depth else 1.0))
    return centres, volumes, alpha_p, 288.0 + 50.0 * inside, 9e3 * (1.0 - centres[:, 1])


def test_a_round_bubble_is_measured():
    found = bubble.metrics(*bed((0.25, 0.3), 0.1))
    assert found["bubble_area_m2"] == pytest.approx(np.pi * 0.01, rel=0.02)
    assert found["bubble_diameter_m"] == pytest.approx(0.2, rel=0.01)
    assert found["bubble_centroid_m"] == pytest.approx(0.3, abs=1e-12)
    assert found["attached"] == 0.0
    assert found["gas_temperature_max_K"] == 338.0
    assert found["bed_height_m"] == pytest.approx(0.6, abs=CELL)
    assert found["pressure_drop_Pa"] == pytest.approx(9e3 * (SIZE[1] - CELL))


def test_a_block_that_the_gas_goes_through_is_no_bubble():
    """Nor a part of one: the void beside it is measured."""
    cells, block = bed((0.25, 0.3), 0.1), bed((0.25, 0.2), 0.06)[2] == 0.0
    block &= cells[0][:, 1] < 0.6
    assert bubble.metrics(*bed((0.25, 0.2), 0.06), walled=block * 1.0)["bubble_area_m2"] == 0.0
    left = bubble.metrics(*cells, walled=block * 1.0)["bubble_area_m2"]
    assert left == pytest.approx(float(cells[1] @ ((cells[2] == 0.0) & (cells[0][:, 1] < 0.6) & ~block)))


def test_the_freeboard_is_no_bubble():
    assert bubble.metrics(*bed((0.25, 0.3), 0.0))["bubble_area_m2"] == 0.0
    assert bubble.metrics(*bed((0.25, 0.6), 0.1))["bubble_area_m2"] == 0.0  # it has burst


def test_a_bubble_lets_go_of_the_floor():
    rows = [bubble.metrics(*bed((0.25, height), 0.08)) for height in (0.05, 0.07, 0.09, 0.11)]
    assert [row["attached"] for row in rows] == [1.0, 1.0, 0.0, 0.0]
    assert rows[0]["neck_width_m"] > rows[1]["neck_width_m"] > 0.0
    assert bubble.detachment((0.1, 0.2, 0.3, 0.4), rows) == 0.3
    assert np.isnan(bubble.detachment((0.1, 0.2), rows[:2]))


def test_a_slab_has_the_bubble_of_its_mean():
    plane, slab = bed((0.25, 0.3), 0.1), bed((0.25, 0.3), 0.1, depth=4)
    assert bubble.metrics(*bubble.through_depth(4 * CELL, *slab)) == pytest.approx(bubble.metrics(*plane), rel=1e-12)


def tapered(middle, radius, cut):
    """The bed of `bed` in a vessel 0.3 m wide below and 0.5 m above, its cells cut into two triangles where `cut`."""
    ticks = [np.arange(round(length / CELL) + 1) * CELL for length in SIZE]
    x, y = np.meshgrid(*ticks, indexing="ij")
    corners = np.stack((0.25 + (x - 0.25) * (0.6 + 0.4 * y), y), axis=2)
    a, b, c, d = corners[:-1, :-1], corners[1:, :-1], corners[1:, 1:], corners[:-1, 1:]
    shapes = [(a, b, c), (a, c, d)] if cut else [(a, b, c, d)]
    centres = np.concatenate([np.mean(shape, axis=0).reshape(-1, 2) for shape in shapes])
    rings = [list(zip(shape, shape[1:] + shape[:1])) for shape in shapes]
    area = np.concatenate(
        [0.5 * abs(sum(np.linalg.det(np.stack(edge, axis=-1)) for edge in ring)).ravel() for ring in rings]
    )
    inside = np.hypot(centres[:, 0] - middle[0], centres[:, 1] - middle[1]) < radius
    alpha_p = np.where(inside | (centres[:, 1] > 0.6), 0.0, 0.6)
    return np.pad(centres, ((0, 0), (0, 1))), area, alpha_p, 288.0 + 50.0 * inside, 9e3 * (1.0 - centres[:, 1])


@pytest.mark.parametrize("cut", [False, True])
def test_any_cells_have_a_bubble(cut):
    found = bubble.metrics(*tapered((0.25, 0.3), 0.1, cut))
    assert found["bubble_area_m2"] == pytest.approx(np.pi * 0.01, rel=0.02)
    assert found["bubble_centroid_m"] == pytest.approx(0.3, abs=0.2 * CELL)  # centres do not tell where the floor is
    assert found["attached"] == 0.0
    assert found["bed_height_m"] == pytest.approx(0.6, abs=CELL)
    assert found["pressure_drop_Pa"] == pytest.approx(9e3 * (SIZE[1] - CELL), rel=0.01)
    assert bubble.metrics(*tapered((0.25, 0.05), 0.08, cut))["attached"] == 1.0
    assert bubble.metrics(*tapered((0.25, 0.6), 0.1, cut))["bubble_area_m2"] == 0.0  # it has burst


def test_two_voids_that_touch_at_a_corner_are_two():
    """On cells of any kind as on a grid: neighbours share a face."""
    centres, _volumes, *_ = bed((0.25, 0.3), 0.0)
    grid = bubble.neighbours(centres)
    holed = np.ones(len(centres), bool)
    holed[-1] = False  # a grid with a hole is none, and takes the other way
    found = bubble.neighbours(centres[holed])
    expected = {frozenset(pair) for pair in grid.tolist() if len(centres) - 1 not in pair}
    assert {frozenset(pair) for pair in found.tolist()} == expected


def test_a_slab_one_cell_deep_is_no_wall_of_round_off():
    """OpenFOAM's centres of such cells differ in their last digit along z."""
    centres, *rest = bed((0.25, 0.3), 0.1, depth=1)
    rough = centres + 1e-17 * np.random.default_rng(2).standard_normal(centres.shape)
    assert bubble.metrics(*bubble.through_depth(CELL, rough, *rest)) == pytest.approx(
        bubble.metrics(*bubble.through_depth(CELL, centres, *rest)), rel=1e-12
    )


def test_up_is_not_always_y():
    upright = bubble.metrics(*bed((0.25, 0.3), 0.1))
    centres, *rest = bed((0.25, 0.3), 0.1)
    turned = bubble.metrics(centres[:, [1, 0, 2]] * [-1, 1, 1], *rest, up=(-1.0, 0.0, 0.0))
    assert turned == pytest.approx(upright, rel=1e-9)


def test_a_vessel_that_is_no_slab_is_refused():
    slab = bed((0.25, 0.3), 0.1, depth=4)
    with pytest.raises(CaseError, match="run.metrics holds bubble, which is of a plane bed"):
        bubble.through_depth(4 * CELL, *slab, up=(0.0, 0.0, 1.0))
    with pytest.raises(CaseError, match="run.metrics holds bubble, which is of a plane bed"):
        bubble.through_depth(4 * CELL, *(values[:-1] for values in slab))
