"""Short forms of the bed of seeds of `sdph validate experiments`: its case is that of the data, a short run keeps its
balances and its seeds in their column, profiles are those of known fields, and what is off is told."""

import types

import numpy as np
import pytest
import pyvista

from sdph.methods.grains.grains import Grains
from sdph.running import balances, driver
from sdph.running.progress import Reporter
from sdph.study import compare, validate

QUIET = Reporter(quiet=True)
MASS = 9240 * np.pi / 6.0 * 1.2e-3**3 * 1000.0  # kg of all seeds (head of the data)


@pytest.fixture
def beds():
    return validate.part(validate.EXPERIMENTS, "bed_profiles")


@pytest.mark.parametrize(("dimensions", "depth"), [(3, 1.0), (2, 0.01)])
def test_the_bed_has_the_seeds_of_the_data(beds, dimensions, depth):
    """Of two dimensions those of a metre of depth."""
    assert Grains(beds.case(dimensions)).state.mass.sum() * depth == pytest.approx(MASS, rel=1e-4)


def test_seeds_that_rub_lose_more_than_smooth_ones(beds):
    """0.98 - (3/2) 0.1 exp(-0.3), Chialvo & Sundaresan 2013."""
    assert beds.restitution() == pytest.approx(0.8689, abs=1e-4)


@pytest.mark.parametrize("dimensions", [3, 2])
def test_all_walls_are_rubbed_as_in_the_data(beds, dimensions):
    """0.1 on every side that holds seeds (head of the data): none grips without slip, none is smooth."""
    case = beds.case(dimensions)
    assert case.parameters["walls"].friction == 0.1 and case.parameters["walls"].specularity is None
    assert {own.kind for own in case.boundaries.values()} == {"wall", "velocity_inlet", "pressure_outlet"}


def test_a_short_run_keeps_its_balances_and_its_seeds(tmp_path, beds):
    """0.3 s in two dimensions, the first slug: the bed is blown up and stays in its column, air flows as asked; what it
    misses is the numerical work."""
    driver.run(beds.case(2, 0.3), "", tmp_path / "bed", None, QUIET)
    run = compare.open_run(tmp_path / "bed")
    missed = {check["name"]: check["value"] for check in balances.checks(run.summary) if not check["ok"]}
    assert list(missed) == ["numerical_work_rel"] and missed["numerical_work_rel"] < 0.1  # 8 % here, 0.3 % in 11 s
    packed = MASS / 1000.0 / (0.6 * 0.044 * 0.01)
    rows = np.genfromtxt(run.folder / "metrics.csv", delimiter=",", names=True)
    assert packed < 1.1 * rows["bed_height_m"].min() and 1.2 * packed < rows["bed_height_m"].max() < beds.HIGHER
    assert rows["weight_Pa"] == pytest.approx(MASS * 9.80665 * (1.0 - 1.2e-3) / (0.044 * 0.01), rel=1e-3)
    assert np.mean(rows["superficial_velocity_m_s"][1:]) == pytest.approx(0.9, rel=0.15)
    whole = beds.means(run.folder, 0.1, 0.3)
    voidage = np.concatenate([own.values for (name, _), own in whole.items() if name == "voidage"])
    assert 0.37 < voidage.min() < voidage.max() < 1.0


def averages(beds, alpha_p, rise):
    """Averages of a run whose fields are known: functions of x and y [m], nan outside of the box."""
    width, height, depth = beds.SIZE
    gas = pyvista.ImageData(dimensions=(12, 31, 4), spacing=(width / 11, height / 30, depth / 3))
    grid = pyvista.ImageData(dimensions=(24, 56, 10), spacing=(0.002, 0.0024, 0.002), origin=(-0.001, -0.004, -0.004))
    cells, points = gas.cell_centers().points, np.asarray(grid.points)
    gas.cell_data["alpha_p_mean"] = alpha_p(cells[:, 0], cells[:, 1])
    velocity = np.zeros_like(points)
    velocity[:, 1] = np.where(points[:, 1] < 0.06, rise(points[:, 0], points[:, 1]), np.nan)
    grid["velocity_mean"] = velocity
    return types.SimpleNamespace(particles=grid, gas=gas)


def test_profiles_of_known_fields(beds):
    """Linear in height, even or odd about the middle: what is odd vanishes in the mean of both halves; to what straight
    pieces are off."""
    middle = 0.5 * beds.SIZE[0]
    known = averages(beds, lambda x, y: 0.6 - 5.0 * y + (x - middle), lambda x, y: 4.0 * y - 900.0 * (x - middle) ** 2)
    for (name, y), own in beds.profiles(known).items():
        if name == "voidage":
            assert own.values == pytest.approx(np.full(len(own.x), 0.4 + 5.0 * y), abs=1e-6)
            assert own.lean[1:] == pytest.approx(own.x[1:] - middle, abs=1e-6)  # the first is nearer than any cell
            assert beds.leaning({(name, y): own._replace(lean=0.1)}, (name, y)) == pytest.approx(2.0)  # bars of 0.05
        else:
            assert own.values == pytest.approx(4.0 * y - 900.0 * (own.x - middle) ** 2, abs=2e-3)


def test_the_mean_of_both_halves_is_what_was_measured(beds):
    """Voidage at 16.4 mm: by hand from the rows on both sides; beside the left wall the left alone."""
    own = beds.found()["voidage", 0.0164]
    assert own.x[0] == pytest.approx(0.000902866) and own.values[0] == pytest.approx(0.469136)
    right = np.interp(0.044 - 0.00467197, [0.038422, 0.0403137], [0.525253, 0.513281])
    assert own.values[2] == pytest.approx(0.5 * (0.512159 + right), rel=1e-6)
    assert {name: len(found.x) for name, found in beds.found().items()} == {
        ("voidage", 0.0164): 12, ("voidage", 0.0312): 12, ("uy_particle", 0.015): 11, ("uy_particle", 0.025): 12,
        ("uy_particle", 0.035): 12,
    }  # fmt: skip


@pytest.mark.parametrize(("bars", "ok"), [(0.0, True), (0.9, True), (-0.9, True), (1.1, False), (-1.1, False)])
def test_profiles_off_by_more_than_the_bar_are_told(tmp_path, monkeypatch, beds, bars, ok):
    """Bars by hand: 0.05 of voidage; of the speed 0.05 m/s, or 30 % of it where that is more."""
    off = {"voidage": lambda v: 0.05, "uy_particle": lambda v: np.maximum(0.05, 0.3 * np.abs(v))}
    ours = {key: own._replace(values=own.values + bars * off[key[0]](own.values)) for key, own in beds.found().items()}
    shifts = iter([-0.04, 0.0, 0.04] * 2)  # of runs, whose mean counts
    shifted = lambda by: {key: own._replace(values=own.values + by) for key, own in ours.items()}  # noqa: E731
    monkeypatch.setattr(beds, "means", lambda *_: shifted(next(shifts)))
    ran = []
    monkeypatch.setattr(beds.driver, "run", lambda case, *_: ran.append(case.particles["bed"].seed))
    checks = beds.checks(tmp_path)
    assert ran == [1, 2, 3] * 2
    assert [check["ok"] for check in checks] == [ok] * 20
    assert (tmp_path / "bed_profiles.png").is_file()


def test_doubt_is_the_standard_error_of_the_mean_of_runs(beds):
    """Runs off by -1, 0 and 1 bar of voidage: deviation of one bar, over the root of three."""
    key, own = ("voidage", 0.0164), beds.found()["voidage", 0.0164]
    parts = [{key: own._replace(values=own.values + 0.05 * off)} for off in (-1.0, 0.0, 1.0)]
    assert beds.doubt(parts, key) == pytest.approx(3.0**-0.5)
    assert beds.of_all(parts)[key].values == pytest.approx(own.values)
