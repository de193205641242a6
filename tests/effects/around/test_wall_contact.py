"""Contact with walls: a grain that is flung at a floor is stopped, and held back along it by Coulomb's friction."""

import math

import numpy as np
import pytest
from grain_boxes import SPACING, box, started

from sdph.methods.grains.account import columns as columns_of

ANGLE, SPEED, FALL = 30.0, 0.5, 0.1  # deg, m/s, m/s
RUBBED = math.sin(math.radians(ANGLE)) * FALL  # m/s, of Schaeffer's grains that slide along a plane
EFFECTS = ["walls", "friction"]
TIME = 1e-3  # s; it touches the floor at once


def flung(folder, speed=SPEED, effects=EFFECTS, **sections):
    """The stepper of a lone particle that comes down on the floor at FALL and slides at `speed` [m/s], after TIME."""
    own = {"friction": {"angle_deg": ANGLE}} if "friction" in effects else {}
    case = box(effects, alpha_p=0.6, periodic=("x",), fill=(SPACING, SPACING), **own, **sections)
    stepper = started(case, folder).stepper
    stepper.state.y[:], stepper.state.u[:], stepper.state.v[:] = 0.25 * SPACING, speed, -FALL
    stepper.prepare()
    stepper.force(np.zeros(1), np.zeros((1, 3)), np.zeros(1))
    stepper.move(TIME)
    return stepper


@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_a_floor_rubs_by_sin_phi_of_what_it_pushes(tmp_path, restitution):
    state = flung(tmp_path, walls={"restitution": restitution}).state
    assert state.v[0] == pytest.approx(restitution * FALL, rel=1e-12)
    assert state.u[0] == pytest.approx(SPEED - (1.0 + restitution) * RUBBED, rel=1e-12)


@pytest.mark.parametrize(("effects", "given", "rubs"), [
    (EFFECTS, 0.1, 0.1),
    (EFFECTS, 0.9, math.sin(math.radians(ANGLE))),
    (EFFECTS, 0.0, 0.0),
    (["walls"], 0.1, 0.1),
])  # fmt: skip
def test_a_floor_that_has_a_friction_rubs_by_it(tmp_path, effects, given, rubs):
    """By no more than grains rub each other, where they do."""
    state = flung(tmp_path, effects=effects, walls={"friction": given}).state
    assert state.u[0] == pytest.approx(SPEED - rubs * FALL, rel=1e-12)


def test_friction_of_a_contact_does_the_work_that_is_booked(tmp_path):
    stepper = flung(tmp_path)
    account, mass, speed = columns_of(stepper.account), stepper.state.mass[0], stepper.state.u[0]
    assert account["impulse_of_walls_x_kg_m_s"] == pytest.approx(mass * (speed - SPEED), rel=1e-9)
    assert account["impulse_of_walls_y_kg_m_s"] == pytest.approx(mass * FALL, rel=1e-9)
    assert account["work_of_walls_J"] == pytest.approx(0.5 * mass * (speed**2 - SPEED**2 - FALL**2), rel=1e-9)


@pytest.mark.parametrize("effects", [[], ["granular_pressure", "granular_viscosity", "granular_temperature"]])
def test_a_lone_grain_that_lies_on_a_floor_bears_its_weight_on_the_contact(tmp_path, effects):
    """It slides and slows by sin(phi) g: no pressure, none from the wall, and no theta yet that makes it viscous."""
    case = box(
        ["walls", "friction", "gravity", *effects], alpha_p=0.6, periodic=("x",), fill=(SPACING, SPACING),
        gravity=(0.0, -9.81), friction={"angle_deg": ANGLE}, grains={"granular_temperature_m2_s2": 1e-10},
    )  # fmt: skip
    stepper = started(case, tmp_path).stepper
    stepper.state.y[:], stepper.state.u[:] = 0.25 * SPACING, SPEED
    stepper.prepare()
    stepper.force(np.zeros(1), np.array([[0.0, -9.81, 0.0]]), np.zeros(1))
    stepper.move(5 * TIME)
    slowed = (SPEED - stepper.state.u[0]) / (5 * TIME)
    print(f"slows by {slowed / 9.81:.5f} g")
    assert slowed == pytest.approx(math.sin(math.radians(ANGLE)) * 9.81, rel=1e-3)


def test_it_comes_to_rest_and_does_not_turn(tmp_path):
    assert flung(tmp_path, speed=0.9 * RUBBED).state.u[0] == 0.0


def test_a_floor_that_slides_takes_it_along(tmp_path):
    floor = {"floor": {"kind": "wall", "side": "bottom", "velocity_m_s": [2.0, 0.0]}, "rest": {"kind": "wall"}}
    assert flung(tmp_path, boundaries=floor).state.u[0] == pytest.approx(SPEED + RUBBED, rel=1e-12)


@pytest.mark.parametrize(("effects", "sections"), [
    (EFFECTS, {"boundaries": {"sides": {"kind": "slip_wall"}}}),
    (EFFECTS, {"walls": {"specularity": 0.0}}),
    (["walls"], {}),
])  # fmt: skip
def test_a_smooth_floor_does_not_hold_it_back(tmp_path, effects, sections):
    assert flung(tmp_path, effects=effects, **sections).state.u[0] == SPEED
