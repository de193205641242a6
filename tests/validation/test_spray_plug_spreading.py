"""Short form of `spray_plug.spreading`: its equations are those of the plug where all is even, both codes follow them
with coarse cells, and what is read off runs."""

import math

import numpy as np
import pytest

from coupling.transfer import gather
from sdph.running.progress import Reporter
from sdph.study import validate

COARSE = 25e-3  # m


def study(name="spreading"):
    return validate.part("spray_plug", name)


def test_rates_in_the_middle_are_those_of_the_plug(monkeypatch):
    """Even droplets of 3 m/s in even gas with some vapour; the middle, where the vapour of both sides holds still."""
    plug, across, own = study("plug"), study("across"), study().case(COARSE)
    monkeypatch.setattr(plug, "MIDDLE", plug.BODY[0])
    values = [3.0, 295.0, 340.0, 0.01, 2.8e-4**2]
    speed, warm, square = (value * np.ones(200) for value in (*values[:2], values[4]))
    hot, fraction = (value * np.ones(50) for value in values[2:4])
    band = across.Band((np.arange(200) + 0.5) * across.CELL / 4.0, speed, warm, square, hot, fraction)
    count = plug.ALPHA_P * across.CELL / 4.0 * 6.0 / (math.pi * own.grains.diameter**3)
    rates = across.change(own, study().traits(study().OWN, plug.ONSET), band, count, across.CELL)
    found = [rates.speed[0], rates.warm[0], rates.hot[0], rates.fraction[0], rates.square[0]]
    assert found == pytest.approx(plug.change(own, 0.0, values), rel=1e-4)  # vapour moves the gas half a cell on


def test_the_band_of_the_equations_keeps_liquid_and_vapour():
    """What its points lose is in its cells: to the slope of the gas, which carries vapour by its rate, not its flux."""
    own = study().case(COARSE)
    band = study().exact(study().OWN, study("plug").ONSET)[-1]
    gone = study("across").evaporated(own, band) * study().ALPHA_P * own.grains.density * study().HALF
    vapour = band.fraction.sum() * study("across").CELL * own.gas.density
    assert vapour == pytest.approx(gone, rel=1e-3)


def test_order_and_limit_of_four_cells():
    values = [9.0] + [3.0 + 7.0 * cell**1.7 for cell in (0.4, 0.2, 0.1)]
    assert study().towards(values) == pytest.approx((1.7, 3.0))
    assert np.isnan(study().towards([1.0, 2.0, 1.0])).all()


def test_what_is_measured_of_a_band():
    """One row out of two is twice as far out as at the start, a tenth of its mass gone; vapour is that of both
    halves."""
    own = study().case(COARSE)
    lattice = study().at_start(own)
    middle = 0.5 * study().HEIGHT
    place = middle + 2.0 * (lattice.place[:, 1] - middle)
    centres = (np.arange(16) + 0.5) * COARSE
    found = study().measured(place, 0.9 * lattice.mass, centres, centres, own)
    assert found["evaporated"] == pytest.approx(0.1)
    assert found["width"] == pytest.approx(2.0)
    assert found["vapour"] == pytest.approx(np.full(8, middle))


def test_a_kernel_of_one_cell_is_the_cell_that_a_particle_is_in(box_of_cells):
    weights = study().OneCell(box_of_cells, 0.3).weights(np.array([[0.1, 0.1, 0.0], [2.6, 1.2, 0.0]]))
    assert gather(weights, box_of_cells.centres[:, :2]).tolist() == [[0.5, 0.5], [2.5, 1.5]]


@pytest.fixture
def box_of_cells():
    """Four by three cells of 1 m."""
    from coupling.gas import Mesh

    y, x = (index.ravel() + 0.5 for index in np.mgrid[0:3, 0:4])
    return Mesh(np.column_stack((x, y, 0.0 * x)), np.ones(12), 2, 1.0)


def off(code, folder, onset):
    """By what `code` is off its equations in what evaporated, relative, with coarse cells; its balances hold."""
    found, closed = study().run(code, COARSE, onset, folder, Reporter(quiet=True))
    assert [row for row in closed if not row["ok"]] == []
    own, band = study().case(COARSE), study().exact(code, onset)[-1]
    assert found[-1]["width"] == pytest.approx(study().grown(band), rel=study().BAR)
    return found[-1]["evaporated"] / study("across").evaporated(own, band) - 1.0


def test_the_kernel_makes_a_band_with_an_onset_evaporate_more(tmp_path):
    """Four cells: 23 % off, a third of it with a kernel of one cell."""
    kernel, cell = (off(code, tmp_path / code[-4:], 298.0) for code in (study().OWN, study().CELL))
    assert 0.2 < kernel < 0.27
    assert 0.06 < cell < 0.11


@pytest.mark.openfoam
def test_droplet_solver_follows_equations_of_its_own(tmp_path):
    """2 % off with four cells, and as far again from SDPH's, whose diffusivity does not go with the film."""
    assert off(study().DROPS, tmp_path / "drops", study("plug").ONSET) == pytest.approx(0.02, abs=0.005)
