"""Lines, planes and averages: exact for linear fields and for numbers whose mean and variance are known."""

import numpy as np
import pytest
import pyvista

from sdph.running.fields import Fields
from sdph.schema import CaseError
from sdph.study import sampling

SPACING = 0.1


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A square of particles beside a void, in a gas: three instants, the fields of one growing as 1, 3, 8."""
    made = tmp_path_factory.mktemp("run")
    (made / "fields").mkdir()
    ticks = (np.arange(10) + 0.5) * SPACING
    places = np.stack(np.meshgrid(ticks, ticks, [0.0], indexing="ij"), axis=-1).reshape(-1, 3)
    fields = Fields(made)
    for time, factor in ((0.0, 1.0), (1.0, 3.0), (2.0, 8.0)):
        cloud = pyvista.PolyData(places)
        cloud["mass"], cloud["density"] = np.full(100, 5.0 * SPACING**2), np.full(100, 5.0)
        cloud["kind"], cloud["ident"] = np.full(100, 2), np.arange(100)
        cloud["velocity"] = factor * np.column_stack((places[:, 0], 2.0 * places[:, 1], 0.0 * places[:, 0]))
        gas = pyvista.RectilinearGrid(np.linspace(0.0, 2.0, 9), np.linspace(0.0, 1.0, 5), np.zeros(1))
        for name in ("pressure", "temperature", "density", "alpha_p"):
            gas.cell_data[name] = factor * gas.cell_centers().points[:, 0]
        gas.cell_data["velocity"] = np.tile([factor, 0.0, 0.0], (gas.n_cells, 1))
        fields.write(time, {"particles": cloud, "gas": gas})
    return made


def test_a_line_has_the_fields_along_it(folder):
    found = sampling.line(folder, (0.0, 0.5), (2.0, 0.5), 21, 1.0)
    assert found["distance"] == pytest.approx(found["position_x"])
    inside = (found["distance"] > 0.25) & (found["distance"] < 0.75)
    assert found["velocity_x"][inside] == pytest.approx(3.0 * found["distance"][inside], rel=0.01)
    assert found["velocity_y"][inside] == pytest.approx(3.0 * 2.0 * 0.5, rel=0.01)
    assert found["share"][inside] == pytest.approx(1.0, abs=0.02) and found["share"][-1] == 0.0
    assert np.isnan(found["velocity_x"][found["distance"] > 1.05]).all()
    assert found["gas_pressure"][0] == 3.0 * 0.125 and found["gas_velocity_x"] == pytest.approx(3.0)
    assert not {"ident", "kind"} & found.keys()
    deep = sampling.line(folder, (0.0, 0.5, 0.005), (2.0, 0.5, 0.005), 21, 1.0)  # the middle of a mesh that is deep
    assert all(np.array_equal(values, deep[name], equal_nan=True) for name, values in found.items())


def test_a_plane_is_a_grid_of_points(folder):
    found = sampling.plane(folder, "z", 0.0, 0.05, None)
    one = found.find_closest_point((0.5, 0.5, 0.0))
    assert found["velocity"][one] == pytest.approx(8.0 * found.points[one] * (1.0, 2.0, 0.0), rel=0.01)
    along = sampling.plane(folder, "x", 0.5, 0.05, None)
    assert np.ptp(along.points[:, 0]) == 0.0 and np.ptp(along.points[:, 1]) > 0.9


def test_averages_have_mean_and_variance(folder):
    particles, gas, times = sampling.averages(folder, None, None, 0.05)
    assert times == [0.0, 1.0, 2.0]
    one = particles.find_closest_point((0.5, 0.5, 0.0))
    x = particles.points[one, 0]
    assert particles["velocity_mean"][one, 0] == pytest.approx(4.0 * x, rel=0.01)
    assert particles["velocity_variance"][one, 0] == pytest.approx(np.var([1.0, 3.0, 8.0]) * x**2, rel=0.02)
    assert particles["share_mean"][one] == pytest.approx(1.0, abs=0.02)
    assert np.isnan(particles["velocity_mean"][particles.find_closest_point((1.7, 0.5, 0.0))]).all()
    centres = gas.cell_centers().points[:, 0]
    assert gas["pressure_mean"] == pytest.approx(4.0 * centres)
    assert gas["pressure_variance"] == pytest.approx(np.var([1.0, 3.0, 8.0]) * centres**2)
    assert sampling.averages(folder, 0.5, 1.5, 0.1).gas["pressure_variance"] == pytest.approx(0.0 * centres)


def test_what_comes_and_goes_counts_by_its_share():
    sums = sampling.Sums()
    for value, weight in ((1.0, 1.0), (np.nan, 1.0), (4.0, 0.5)):
        sums.add({"f": np.array([value])}, np.array([weight]))
    told = sums.told()
    assert told["f_mean"] == pytest.approx([2.0]) and told["f_variance"] == pytest.approx([2.0])


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        (lambda run: sampling.line(run, (0.0, 0.0), (0.0, 0.0), 5, None), "give two places"),
        (lambda run: sampling.plane(run, "up", 0.0, None, None), "known: x, y, z"),
        (lambda run: sampling.plane(run, "x", 3.0, None, None), "the run lies from 0 to 2 m"),
        (lambda run: sampling.averages(run, 5.0, 6.0, None), "this run has fields from 0 to 2 s"),
    ],
)
def test_what_cannot_be_sampled_is_told(folder, asked, message):
    with pytest.raises(CaseError, match=message):
        asked(folder)
