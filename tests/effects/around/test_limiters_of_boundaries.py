"""What walls and nozzles hold is told: suction of walls, grains nearer than contact, ways that contact puts grains
back, grains upstream."""

import numpy as np
import pytest
from grain_boxes import DENSITY, SPACING, box, started

from sdph import scenes
from sdph.case import read as cases
from sdph.engine.state import INFLOW
from sdph.methods.grains.account import columns as columns_of
from sdph.study.explain.effect_costs import prepared

PUSH, CONTACT = 10.0, 0.25 * SPACING  # m/s2, m


def floor(folder, theta=1e-12, kind="wall", **more):
    """Grains between two plates, nearly without a pressure of their own."""
    case = box(
        ["gravity", "granular_pressure", "walls"], size=(0.06, 0.06), periodic=("x",), gravity=(0.0, -PUSH),
        boundaries={"plates": {"kind": kind}}, grains={"granular_temperature_m2_s2": theta}, **more,
    )  # fmt: skip
    return started(case, folder).stepper


def move(stepper, dt, push=-PUSH):
    zeros = np.zeros(len(stepper.state.x))
    stepper.force(zeros, np.tile((0.0, push, 0.0), (len(zeros), 1)), zeros)
    stepper.move(dt)


def test_the_suction_of_a_wall_is_held_at_nothing(tmp_path):
    """Between two plates half of the dummies would pull. The second layer sees one row of grains, two spacings away,
    which falls off with rho g over that way; the third sees none. The other half would push with a weight that grains
    without pressure do not bear."""
    stepper = floor(tmp_path)
    assert (stepper.held["walls_held_share"], stepper.held["wall_suction_Pa"]) == (0.0, 0.0)  # no step has gone
    move(stepper, 1e-6)
    assert stepper.held["walls_held_share"] == 1.0
    assert stepper.wall.pressure.max() < 1e-6 * DENSITY * PUSH * SPACING
    assert stepper.held["wall_suction_Pa"] == pytest.approx(0.5 * DENSITY * PUSH * 2.0 * SPACING, rel=1e-6)


def test_a_pressure_that_pushes_is_not_held(tmp_path):
    stepper = floor(tmp_path, theta=1.0)
    move(stepper, 1e-6)
    assert (stepper.held["walls_held_share"], stepper.held["wall_suction_Pa"]) == (0.0, 0.0)


def test_the_penalty_of_the_paper_has_no_such_limiters(tmp_path):
    stepper = floor(tmp_path, walls={"model": "paper"})
    assert stepper.held.keys() == {"alpha_p_capped_share"}


@pytest.mark.parametrize("kind, grips", [("wall", True), ("slip_wall", False)])
def test_grains_nearer_than_contact_to_a_wall_that_grips(tmp_path, kind, grips):
    """Those of the lowest row, and none on the other plate."""
    stepper = floor(tmp_path, walls={"specularity": 0.1}, kind=kind)
    stepper.tell()
    assert stepper.held["grip_held_share"] == 0.0
    row = stepper.state.y < SPACING
    stepper.state.y[row] = 0.9 * CONTACT
    stepper.tell()
    assert row.any() and stepper.held["grip_held_share"] == grips * row.mean()


def test_a_wall_without_specularity_holds_no_grip(tmp_path):
    assert "grip_held_share" not in floor(tmp_path).held


def test_the_way_back_from_a_wall_and_its_energy(tmp_path):
    """The lowest row falls on the floor within a step and is put back to the distance of contact."""
    stepper, dt = floor(tmp_path), 7e-5
    row = stepper.state.y < SPACING
    stepper.state.v[row] = -30.0
    mass, before = stepper.state.mass[row], stepper.state.y[row].copy()
    move(stepper, dt)
    columns = columns_of(stepper.account)
    ways = CONTACT - (before - 30.0 * dt)
    assert stepper.steps == 1 and (ways > 0.0).all()
    assert columns["contact_way_m"] == pytest.approx(ways.sum(), rel=1e-3)
    assert columns["contact_lift_J"] == pytest.approx((mass * PUSH * ways).sum(), rel=1e-3)


def test_who_is_put_down_loses(tmp_path):
    """The uppermost row on the lid: the way counts, the energy is less."""
    stepper = floor(tmp_path)
    stepper.state.v[stepper.state.y > 0.06 - SPACING] = 30.0
    move(stepper, 1e-4)
    columns = columns_of(stepper.account)
    assert columns["contact_lift_J"] == pytest.approx(-stepper.state.mass[0] * PUSH * columns["contact_way_m"])
    assert columns["contact_way_m"] > 0.0


def test_grains_upstream_of_a_nozzle_stand_in_for_its_edge():
    """All that wait are beyond the side at which the jet enters."""
    simulation = prepared(cases.load(scenes.HERE / "evaporating_jet" / "case.toml"))
    waiting = (simulation.state.kind == INFLOW).sum()
    assert simulation.stepper.held["upstream_particles"] == waiting > 0
    simulation.state.x[np.flatnonzero(simulation.state.kind == INFLOW)[0]] = 0.1
    simulation.stepper.tell()
    assert simulation.stepper.held["upstream_particles"] == waiting - 1
