"""The level of a liquid over a place: of columns of known heights, at walls, tilted, under drops, of none."""

import numpy as np
import pytest
import pyvista
from tank_cases import tank_case

from sdph.engine.state import GAS, LIQUID
from sdph.engine.world import ALONE
from sdph.running import level

DX = 0.01


def cloud(places, kind=LIQUID):
    found = pyvista.PolyData(np.column_stack([places, np.zeros(len(places))])) if len(places) else pyvista.PolyData()
    if len(places):
        found["kind"] = np.full(len(places), kind, np.int8)
        found["mass"], found["density"] = np.full(len(places), 1000.0 * DX**2), np.full(len(places), 1000.0)
    return found


def pool(height, width=0.6):
    x, y = (np.arange(DX / 2.0, size, DX) for size in (width, height(0.0) + 0.2))
    grid = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    return grid[grid[:, 1] < height(grid[:, 0])]


@pytest.mark.parametrize(("x", "bar"), [(0.3, 1e-3), (0.0, 2e-3), (0.59, 2e-3)])
def test_of_a_pool_at_rest_to_a_tenth_of_a_spacing(x, bar):
    found = level.of(tank_case(), cloud(pool(lambda x: 0.0 * x + 0.12)), (x, 0.05), ALONE)
    assert found == pytest.approx(0.12, abs=bar)


def test_of_a_tilted_surface_its_height_there():
    for x in (0.2, 0.3, 0.4):
        found = level.of(tank_case(), cloud(pool(lambda x: 0.12 + 0.2 * (x - 0.3))), (x, 0.0), ALONE)
        assert found == pytest.approx(0.12 + 0.2 * (x - 0.3), abs=0.3 * DX)


def test_what_flies_alone_is_no_surface_and_gas_is_no_liquid():
    lonely = np.concatenate([pool(lambda x: 0.0 * x + 0.12), [[0.3, 0.25]]])
    assert level.of(tank_case(), cloud(lonely), (0.3, 0.05), ALONE) == pytest.approx(0.12, abs=1e-3)
    assert np.isnan(level.of(tank_case(), cloud(pool(lambda x: 0.0 * x + 0.12), GAS), (0.3, 0.05), ALONE))
    assert np.isnan(level.of(tank_case(), cloud(np.zeros((0, 2))), (0.3, 0.05), ALONE))
