"""What is up in a column is what gravity says: the same vessel along another axis has the same metrics."""

import dataclasses
import tomllib
from types import SimpleNamespace

import numpy as np
import pytest
from grain_boxes import started

from coupling.embedded import EmbeddedGas
from coupling.gas import Mesh
from sdph import scenes
from sdph.case import read as cases
from sdph.case.gas_cells import CellRows
from sdph.engine import state as particles
from sdph.laws import exact
from sdph.running import metrics
from sdph.running.metrics import column
from sdph.schema import CaseError

LENGTH, WIDTH, BED, SPEED, GRAVITY = 0.2, (0.06, 0.08), 0.1, 0.04, 9.81
SIDES = (("left", "right"), ("bottom", "top"), ("back", "front"))


def vessel(axis, sense):
    """A bed blown through along `axis`, upwards along it for `sense` 1, down for -1."""

    def along(length, across=(0.0, 0.0)):
        return [*across[:axis], length, *across[axis:]]

    table = tomllib.loads((scenes.HERE / "bubbling_bed_3d" / "case.toml").read_text())
    lower, upper = (0.0, BED) if sense > 0 else (LENGTH - BED, LENGTH)
    floor, lid = SIDES[axis][::sense]
    bed = {"shape": "box", "lower_m": along(lower), "upper_m": along(upper, WIDTH)}
    return cases.from_table(table | {
        "run": {"end_time_s": 1e-3, "output_interval_s": 1e-3},
        "domain": {"size_m": along(LENGTH, WIDTH), "gravity_m_s2": along(-sense * GRAVITY)},
        "resolution": {"spacing_mm": 10.0, "cell_mm": 20.0},
        "particles": {"bed": bed | {"volume_fraction": 0.6, "temperature_K": 288.0}},
        "boundaries": {
            "inlet": {"kind": "velocity_inlet", "side": floor, "velocity_m_s": along(sense * SPEED)},
            "outlet": {"kind": "pressure_outlet", "side": lid, "pressure_Pa": 0.0},
            "walls": {"kind": "slip_wall"},
        },
    })  # fmt: skip


def measured(case, folder):
    """Metrics of the column at 1 ms, and the mass of its grains [kg]."""
    folder.mkdir()
    simulation = started(case, folder, EmbeddedGas(case))
    while simulation.time < case.run.end_time:
        simulation.window()
    simulation.ledger.table.close()
    return column.metrics(simulation), simulation.state.mass.sum()


def test_up_is_against_gravity(tmp_path):
    upright, mass = measured(vessel(1, 1), tmp_path / "y")
    share = 1.0 - 1.225 / 3060.0
    assert upright["weight_Pa"] == pytest.approx(mass * share * GRAVITY / np.prod(WIDTH), rel=1e-12)
    assert upright["bed_height_m"] == pytest.approx(BED, rel=0.01)
    assert upright["superficial_velocity_m_s"] == pytest.approx(SPEED, rel=0.05)
    for axis, sense in ((0, 1), (2, 1), (2, -1)):
        other, _ = measured(vessel(axis, sense), tmp_path / f"{axis}{sense}")
        assert other == pytest.approx(upright, rel=1e-3), (axis, sense)


def test_the_row_of_the_start_has_no_pressure_and_the_next_has_it(tmp_path):
    """Before its first window the gas has none; the curve of the report and means go by the rest."""
    case = vessel(1, 1)
    case = dataclasses.replace(case, run=dataclasses.replace(case.run, metrics=("column",), average_from=1e-4))
    simulation = started(case, tmp_path, EmbeddedGas(case))
    first = metrics.row(simulation)
    simulation.window()
    simulation.ledger.table.close()
    last, drop = metrics.row(simulation), ("pressure_drop_Pa", "gradient_Pa_m")
    assert [np.isnan(first[name]) for name in drop] == [True, True] and first["bed_height_m"] > 0.0
    assert last == {"time_s": simulation.time} | column.metrics(simulation) and last["pressure_drop_Pa"] > 0.0
    mean = metrics.means([first, last | {"time_s": 1e-3}], case.run.average_from)
    assert mean["mean_pressure_drop_Pa"] == last["pressure_drop_Pa"]


def test_a_bed_of_one_row_has_no_gradient(tmp_path):
    case = cases.from_table(cases.to_table(vessel(1, 1)) | {"resolution": {"spacing_mm": 10.0, "cell_mm": 80.0}})
    found, _ = measured(case, tmp_path / "coarse")
    assert np.isnan(found["gradient_Pa_m"]) and np.isnan(found["alpha_p_inside"])
    assert found["weight_Pa"] > 0.0


def test_without_gravity_nothing_is_up(tmp_path):
    case = vessel(1, 1)
    case = dataclasses.replace(case, domain=dataclasses.replace(case.domain, gravity=(0.0, 0.0, 0.0)))
    with pytest.raises(CaseError, match="run.metrics holds column, but domain.gravity_m_s2 = .* tells of no way up"):
        column.metrics(started(case, tmp_path, EmbeddedGas(case)))


def test_rows_of_cells_in_no_layers():
    """Cells at random, as tetrahedra have their centres: slabs, from which a pressure that falls straight does so."""
    centres = np.random.default_rng(3).uniform(0.0, 1.0, (4000, 3)) * [0.1, 0.1, 0.4]
    rows = CellRows(Mesh(centres, np.full(4000, 1e-6), 3), (0.0, 0.0, 1.0))
    assert len(rows.place) == 40
    assert (rows.floor, rows.top) == pytest.approx((0.0, 0.4), abs=2e-3)
    assert rows.at_ends(rows.mean(5.0 - 10.0 * centres[:, 2])) == pytest.approx((5.0, 1.0), abs=0.02)


def test_cells_that_lean_stand_in_the_rows_of_those_beside_them():
    """Ten rows of straight cells, and in each two at a wall that leans, with their middles 3 % higher: ten rows, not
    twenty, of which every other one would be as wide as those two alone."""
    x, y = (m.ravel() for m in np.meshgrid(np.arange(8.0) + 0.5, np.arange(10.0) + 0.5))
    lean = 0.03 * ((x < 1.0) | (x > 7.0))
    rows = CellRows(Mesh(np.stack([x, y + lean, 0.0 * x], axis=1), np.ones(80), 2), (0.0, 1.0, 0.0))
    assert len(rows.place) == 10 and rows.area == pytest.approx(8.0, rel=0.02)
    assert np.bincount(rows.own).tolist() == [8] * 10


def test_ergun_follows_a_vessel_that_widens():
    """A plane taper, twice as wide above: the gas of the floor is half as fast there. Against the sum over rows; the
    area of the last row is off by half of what it widens, 1.3 %, and Ergun's gradient by up to twice that."""
    count, low, high = 40, 0.1, 0.2
    y = (np.arange(count) + 0.5) / count
    width = low + (high - low) * y
    mesh = Mesh(np.stack([0.0 * y, y, 0.0 * y], axis=1), width / count, 2)
    case = vessel(1, 1)
    flux = 0.3 * low / width
    fields = {"pressure": 0.0 * y, "alpha_p": 0.0 * y + 0.5}
    fields["velocity"] = np.stack([0.0 * y, flux / 0.5, 0.0 * y], axis=1)
    state = particles.empty(2, ("diameter", "diameter_variance"), 3)
    state.mass[:], state.density[:], state.y[:], state.diameter[:] = 1.0, 1.0, 0.1, case.grains.diameter
    case = dataclasses.replace(case, domain=dataclasses.replace(case.domain, gravity=(0.0, -9.81, 0.0)))
    seen = SimpleNamespace(
        case=case, gas=SimpleNamespace(mesh=mesh), cell_fields=lambda: fields, grains=SimpleNamespace(inside=state)
    )
    gas, d = case.gas, case.grains.diameter
    steps = [exact.ergun_gradient(0.5, u, d, gas.density, gas.viscosity) for u in flux]
    found = column.metrics(seen)
    assert found["ergun_Pa"] == pytest.approx(np.mean(steps), rel=0.025)
    over = 2.0 / (low + (high - low) * 0.1)  # both grains stand 0.1 m high
    weight = over * (1.0 - gas.density / case.grains.density) * GRAVITY
    assert found["weight_Pa"] == pytest.approx(weight, rel=0.005)  # over the mean width it is 27 % less


def test_a_vessel_without_grains_has_metrics(tmp_path):
    case = dataclasses.replace(vessel(1, 1), particles={})
    found, mass = measured(case, tmp_path / "empty")
    assert mass == 0.0 and found["weight_Pa"] == 0.0 and found["alpha_p_max"] == 0.0 and found["speed_max_m_s"] == 0.0
    assert (
        np.isnan(found["bed_height_m"]) and np.isnan(found["alpha_p_mean"]) and np.isfinite(found["pressure_drop_Pa"])
    )


def test_the_diameter_of_ergun_is_the_sauter_mean_of_all_grains():
    """Volumes 1 and 3 of grains of 1 mm with a deviation of their mean (D32 = 4 mm), and of 2 mm alike."""
    sizes = {"diameter": np.array([1e-3, 2e-3]), "diameter_variance": np.array([1e-6, 0.0])}
    state = SimpleNamespace(mass=np.array([2.0, 3.0]), grain_density=np.array([2.0, 1.0]), **sizes)
    assert column.sauter(state) == pytest.approx(4.0 / (1.0 / 4e-3 + 3.0 / 2e-3), rel=1e-12)
