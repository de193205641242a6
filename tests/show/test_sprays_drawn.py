"""Thin sprays are dots, between which the gas is seen; lone particles and small gaps have no line around them; none is
drawn across a wall."""

import numpy as np
import pytest
import pyvista

from sdph import scenes
from sdph.case import read as cases
from sdph.show import flat, raster, shot, style, timeline
from sdph.show.look import Look


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


@pytest.mark.parametrize("field", ["temperature", "alpha_p"])
def test_gas_is_paler_than_grains_of_its_temperature(field):
    case = cases.load(scenes.find("disc_cluster")[1])
    spacing, density = case.resolution.spacing, 0.3 * case.grains.density
    x, y = (ticks.ravel() for ticks in np.meshgrid(*[(np.arange(10) + 0.5) * spacing] * 2))
    block = pyvista.PolyData(np.stack([x, y, 0.0 * x], axis=1))
    block["mass"], block["density"] = np.full(100, density * spacing**2), np.full(100, density)
    block["temperature"], block["alpha_p"] = np.full(100, 300.0), np.full(100, 0.3)
    gas = pyvista.RectilinearGrid(*[np.linspace(0.0, 20.0 * spacing, 21)] * 2, np.zeros(1))
    gas.cell_data["temperature"], gas.cell_data["alpha_p"] = np.full(400, 300.0), np.full(400, 0.3)
    whole = shot.of_state(timeline.Instant(0.0, block, gas), case, None)
    grid, scale = raster.pixels(whole, 200), style.scale(field, [np.array([0.0, 600.0])])
    colours, bulk, _ = flat.painted(whole, grid, field, scale, Look())
    assert bulk.mean() == pytest.approx(0.25, abs=0.03)
    alike = np.abs(colours[150, 150] - colours[50, 50]).max() < 1e-9
    assert alike == (field == "alpha_p") and colours[150, 150].min() >= colours[50, 50].min()


def test_no_disc_crosses_the_wall_where_the_gas_ends():
    """A particle 0.1 of its size off a wall that leans is cut there; one outside the gas is drawn whole."""
    case = cases.load(scenes.find("disc_cluster")[1])
    spacing, density = case.resolution.spacing, 0.6 * case.grains.density
    corners = np.array([[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [10.0, 10.0, 0.0]]) * spacing  # the gas: below y = x
    gas = pyvista.UnstructuredGrid({pyvista.CellType.TRIANGLE: np.array([[0, 1, 2]])}, corners)
    wall = pyvista.PolyData(corners[[0, 2]], lines=[2, 0, 1])
    covered = {}
    for name, lines, off in (("cut", wall, 0.1), ("whole", None, 0.1), ("outside", wall, -0.1)):
        place = np.array([[5.0 + off / np.sqrt(2.0), 5.0 - off / np.sqrt(2.0), 0.0]]) * spacing
        particle = pyvista.PolyData(place)
        particle["mass"], particle["density"] = np.array([density * spacing**2]), np.array([density])
        particle["temperature"] = np.array([300.0])
        whole = shot.of_state(timeline.Instant(0.0, particle, gas), case, lines)
        grid = raster.pixels(whole, 500)
        covered[name] = raster.particles(whole, grid, "temperature", smooth=False)[1].sum() * np.prod(grid.step)
    radius, off = 0.55, 0.1
    segment = radius**2 * np.arccos(off / radius) - off * np.sqrt(radius**2 - off**2)
    assert covered["whole"] / spacing**2 == pytest.approx(np.pi * radius**2, rel=0.05)
    assert covered["cut"] / covered["whole"] == pytest.approx(1.0 - segment / (np.pi * radius**2), abs=0.03)
    assert covered["outside"] == pytest.approx(covered["whole"], rel=0.05)
