"""Forces of grains on named walls: the ledger's, split; a bed's weight, tubes in it, patches, what nothing touches."""

import dataclasses
import math

import meshio
import numpy as np
import pytest
from grain_boxes import DENSITY, box, go, started, windows

from sdph.case import forces
from sdph.engine.walls import facets
from sdph.methods.grains import account
from sdph.schema import CaseError

BED = ("gravity", "granular_pressure", "friction", "granular_viscosity", "artificial_viscosity", "walls")
SIDES = ["left", "right", "bottom", "top", "back", "front"]


def bed(size, names, count=4, end=2e-3, **more):
    """A bed that begins to fall onto the floor of a closed box."""
    d = len(size)
    run = windows(end, count)
    given = {"boundaries": {"all": {"kind": "wall"}}, "gravity": (*[0.0] * (d - 1), -9.81), "alpha_p": 0.62} | more
    case = box(BED, size=size, periodic=(), fill=given.pop("fill", size), **run, **given)
    return asked(case, names)


def asked(case, names):
    return dataclasses.replace(case, run=dataclasses.replace(case.run, forces=tuple(names)))


def given(simulation):
    """(3,) [kg m/s] that the walls gave the grains since the start, by the ledger."""
    return np.array([simulation.ledger.sums[f"impulse_of_walls_{a}_kg_m_s"] for a in "xyz"])


def on(simulation, *names):
    """(3,) [kg m/s] that these walls got."""
    own = simulation.grains.pushed
    return sum(own.sums[1, own.names.index(name), :2].sum(axis=0) for name in names)


@pytest.mark.parametrize("size", [(0.03, 0.03), (0.03, 0.03, 0.03)])
def test_forces_on_all_sides_are_what_the_ledger_has(tmp_path, size):
    sides = SIDES[: 2 * len(size)]
    simulation = go(started(bed(size, [*sides, "all"]), tmp_path))
    total = np.abs(given(simulation)).max()
    assert total > 0.0
    for names in (sides, ["all"]):
        np.testing.assert_allclose(on(simulation, *names), -given(simulation), atol=1e-12 * total)
    row, ledger, up = simulation.row(), simulation.ledger.last, "xyz"[len(size) - 1]
    of_row = sum(row[f"{name}_grain_{kind}_force_{up}_N"] for name in sides for kind in ("pressure", "friction"))
    assert of_row * ledger["window_s"] == pytest.approx(-ledger[f"impulse_of_walls_{up}_kg_m_s"], rel=1e-10)


def test_a_bed_at_rest_bears_on_its_floor_less_what_the_side_walls_carry(tmp_path):
    """Mean of the last 50 ms: the column of grains stands still, so that all walls carry its weight. Where it sprang
    back from its fall the sides hold it down."""
    size, fill = (0.03, 0.06), (0.03, 0.04)
    case = bed(size, SIDES[:4], count=80, end=0.4, fill=fill)
    simulation = started(case, tmp_path)
    while simulation.time < 0.35:
        simulation.window()
    before, moving, begun = simulation.grains.pushed.sums[1].copy(), momentum(simulation), simulation.time
    go(simulation)
    force = (simulation.grains.pushed.sums[1] - before) / (simulation.time - begun)
    weight = float(simulation.state.mass.sum()) * 9.81
    left, right, floor, lid = (own[:2].sum(axis=0)[1] / weight for own in force)
    gained = (momentum(simulation) - moving) / (simulation.time - begun) / weight
    print(f"of the weight: floor {-floor:.4f}, sides {-left:.4f} and {-right:.4f}, lid {-lid:.4f}, motion {gained:.1e}")
    assert -(left + right + floor + lid) - gained == pytest.approx(1.0, abs=1e-10)
    assert 0.7 < -floor < 1.3 and abs(left) > 0.01 and left == pytest.approx(right, rel=1e-3) and abs(lid) < 1e-6
    pressed, rubbed, turned = force[0]
    assert pressed[0] < 0.0  # the left wall is pushed to the left, in the lower half of the bed
    place = turned[2] / -(pressed[0] + rubbed[0])
    assert 0.0 < place < 0.5 * fill[1]


def momentum(simulation):
    return float(simulation.state.mass @ simulation.state.v)


def tubes(path):
    """Two tubes of 24 lines each, with their normals outwards."""
    angle = -2.0 * np.pi * np.arange(24) / 24
    circle = 0.012 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    places = np.concatenate([circle + np.array(middle) for middle in ((0.03, 0.03), (0.09, 0.03))])
    lines = np.concatenate([np.stack([np.arange(24), np.roll(np.arange(24), -1)], axis=1) + k for k in (0, 24)])
    meshio.write_points_cells(path, np.pad(places, ((0, 0), (0, 1))), {"line": lines})
    return str(path)


def of_tubes(folder, names):
    mesh = {"walls": {"source": "mesh", "mesh": tubes(folder / "tubes.vtk")}}
    parts = {"first": {"lower_m": [0.018, 0.018], "upper_m": [0.042, 0.042]},
             "second": {"lower_m": [0.078, 0.018], "upper_m": [0.102, 0.042]},
             "far": {"lower_m": [0.12, 0.0], "upper_m": [0.12, 0.06]}}  # fmt: skip
    return bed((0.12, 0.06), names, parts=parts, fill=(0.06, 0.05), alpha_p=0.55, **mesh)


def test_of_two_tubes_each_has_its_own_force_and_one_that_nothing_touches_none(tmp_path):
    """Grains lie about the first one alone."""
    simulation = go(started(of_tubes(tmp_path, ["first", "second", "mesh", *SIDES[:4], "far"]), tmp_path))
    np.testing.assert_allclose(on(simulation, "mesh", *SIDES[:4]), -given(simulation), atol=1e-12)
    assert np.abs(on(simulation, "first")).max() > 0.0
    np.testing.assert_allclose(on(simulation, "first"), on(simulation, "mesh"), rtol=1e-12)
    untouched = {key: value for key, value in simulation.row().items() if key.startswith(("second_", "far_"))}
    assert len(untouched) == 10 and not any(untouched.values())


def test_facets_of_a_patch_are_those_of_its_boundary(tmp_path):
    """The mesh of a vessel, as it is kept in a run: floor, side and side, the second boundary of no facet of it."""
    corners = np.array([[[0.0, 0.0], [0.03, 0.0]], [[0.03, 0.0], [0.03, 0.03]], [[0.0, 0.03], [0.0, 0.0]]])
    of = facets.Facets(corners, np.zeros(3, bool), np.zeros(3, bool), np.array([0, 2, -1]))
    facets.save(tmp_path / "patches.vtk", of)
    walls = {"walls": {"source": "gas", "mesh": str(tmp_path / "patches.vtk")}}
    held = {"floor": {"kind": "wall"}, "lid": {"kind": "wall"}, "side": {"kind": "wall"}}
    simulation = started(bed((0.03, 0.03), ["floor", "lid", "side"], boundaries=held, **walls), tmp_path)
    shares, own = simulation.stepper.parts, simulation.stepper.boundary.dummies
    assert list(shares) == ["floor", "side"]
    in_corner = (own.normal_x == 0.0) & (own.normal_y == 0.0)
    right = in_corner & (own.x > 0.015)  # of floor and side; on the left of the floor and of no boundary
    assert right.any() and (in_corner & ~right).any()
    np.testing.assert_array_equal(shares["floor"][:, 1] == 1.0, (own.normal_y == 1.0) | in_corner)
    np.testing.assert_array_equal(shares["floor"][:, 0] == 1.0, own.normal_y == 1.0)
    np.testing.assert_array_equal(shares["side"][:, 0] == 1.0, (own.normal_x == -1.0) | right)
    np.testing.assert_array_equal(shares["side"][:, 1] == 1.0, own.normal_x == -1.0)
    with pytest.raises(CaseError, match="'left', which is no boundary or wall of the case; it has floor, lid, side$"):
        forces.check(asked(simulation.case, ["left"]))


def test_what_stops_a_grain_is_among_the_forces(tmp_path):
    """One row that is thrown at the floor, faster than pressure could hold it."""
    case = bed((0.03, 0.03), SIDES[:4], fill=(0.03, 0.005), alpha_p=0.01, end=5e-3)
    simulation = started(case, tmp_path)
    simulation.state.v[:] = -4.0
    go(simulation)
    assert simulation.stepper.contacts > 0
    np.testing.assert_allclose(on(simulation, *SIDES[:4])[1], -given(simulation)[1], rtol=1e-12)
    assert -on(simulation, "bottom")[1] > 0.9 * 4.0 * 0.01 * DENSITY * 0.03 * 0.005


def test_without_names_there_is_no_column_and_nothing_to_add_to(tmp_path):
    simulation = started(bed((0.03, 0.03), []), tmp_path)
    simulation.window()
    assert simulation.stepper.account.felt == () == account.opened().felt
    assert not [key for key in simulation.row() if "_grain_" in key]
    assert math.isfinite(simulation.time)
