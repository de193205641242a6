"""Bubble metrics of fields made up: a round void in a bed, once free and once on the floor, plane and as a slab."""

import numpy as np
import pytest

from sdph import bubble

CELL, SIZE = 0.01, (0.5, 1.0)  # m


def bed(middle, radius, depth=None):
    """Centres, volumes, alpha_p, temperature and pressure of a bed 0.6 m high with a round void; `depth` cells along z."""
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
