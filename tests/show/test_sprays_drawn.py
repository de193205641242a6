"""Thin sprays are dots, between which the gas is seen; lone particles and small gaps have no line around them."""

import numpy as np
import pytest
import pyvista

from sdph import scenes
from sdph.case import read as cases
from sdph.show import raster, shot, timeline


def drawn(scene, alpha_p):
    """Pixels [of a spacing squared] that one particle of a scene's grains covers, alone in its box."""
    case = cases.load(scenes.find(scene)[1])
    spacing, density = case.resolution.spacing, alpha_p * case.grains.density
    particle = pyvista.PolyData(np.array([[5.5 * spacing, 5.5 * spacing, 0.0]]))
    particle["mass"], particle["density"] = np.array([density * spacing**2]), np.array([density])
    particle["temperature"] = np.array([300.0])
    gas = pyvista.RectilinearGrid(*[np.linspace(0.0, 11.0 * spacing, 12)] * 2, np.zeros(1))
    gas.cell_data["temperature"] = np.full(gas.n_cells, 350.0)
    whole = shot.of_state(timeline.Instant(0.0, particle, gas), case, None)
    grid = raster.pixels(whole, 1100)
    return raster.particles(whole, grid, "temperature", smooth=False)[1].sum() * np.prod(grid.step) / spacing**2


def test_droplets_of_a_thin_spray_are_dots_and_grains_are_not():
    """0.3 of the size where a nozzle throws them and they fill less than 1 %; a heated disc is no spray."""
    whole = np.pi * 0.55**2
    assert drawn("evaporating_jet", 2e-4) == pytest.approx(0.3**2 * whole, rel=0.1)
    assert drawn("evaporating_jet", 0.02) == pytest.approx(whole, rel=0.05)
    assert drawn("disc_cluster", 2e-4) == pytest.approx(whole, rel=0.05)


def test_islands_and_gaps_that_are_small_go():
    mask = np.zeros((40, 40), bool)
    mask[5:25, 5:25] = True
    expected = mask.copy()
    mask[10:12, 10:12] = False  # a gap of four
    mask[30:32, 30:32] = True  # an island of four
    mask[15:20, 15:20] = expected[15:20, 15:20] = False  # a gap of 25
    assert np.array_equal(raster.bulk(mask, 9), expected)
    assert not raster.bulk(np.zeros((4, 4), bool), 9).any() and raster.bulk(np.ones((4, 4), bool), 9).all()
