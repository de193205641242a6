"""Contact with walls: grains too few for a pressure slide along a floor, and Coulomb's friction holds them back."""

import math

import numpy as np
import pytest
from grain_boxes import SPACING, box, started

G, ANGLE, SPEED = 9.81, 30.0, 0.5  # m/s2, deg, m/s
EFFECTS = ["gravity", "walls", "friction"]


def slid(folder, end, effects=EFFECTS, **sections):
    """Velocity along the floor [m/s] of a lone particle that slides from SPEED for `end` [s], and the stepper: windows
    of 1 ms."""
    case = box(
        effects, size=(0.06, 0.06), alpha_p=0.6, periodic=("x",), gravity=(0.0, -G), fill=(SPACING, SPACING),
        **({"friction": {"angle_deg": ANGLE}} if "friction" in effects else {}), **sections,
    )  # fmt: skip
    stepper = started(case, folder).stepper
    stepper.state.y[:], stepper.state.u[:] = 0.25 * SPACING, SPEED  # it touches the floor
    stepper.prepare()
    for _ in range(round(1e3 * end)):
        stepper.force(np.zeros(1), np.array([[0.0, -G, 0.0]]), np.zeros(1))
        stepper.move(1e-3)
    return float(stepper.state.u[0]), stepper


def test_a_grain_that_slides_along_a_floor_is_held_back_by_sin_phi_of_its_weight(tmp_path):
    """Schaeffer's grains that shear along a plane bear sin(phi) of the pressure: 0.5 g here."""
    speed, stepper = slid(tmp_path, 0.05)
    assert speed == pytest.approx(SPEED - math.sin(math.radians(ANGLE)) * G * 0.05, rel=1e-9)
    assert stepper.state.v[0] == pytest.approx(0.0, abs=1e-12)


def test_friction_of_a_contact_does_the_work_that_is_booked(tmp_path):
    speed, stepper = slid(tmp_path, 0.001)
    account = stepper.account.columns()
    mass = stepper.state.mass[0]
    assert account["impulse_of_walls_x_kg_m_s"] == pytest.approx(mass * (speed - SPEED), rel=1e-9)
    moved = 0.5 * mass * (speed**2 - SPEED**2)
    assert account["work_of_walls_J"] + account["work_of_gravity_J"] == pytest.approx(moved, rel=1e-9)


def test_it_comes_to_rest_and_does_not_turn(tmp_path):
    assert slid(tmp_path, 0.2)[0] == 0.0


def test_a_floor_that_slides_takes_it_along(tmp_path):
    floor = {"floor": {"kind": "wall", "side": "bottom", "velocity_m_s": [2.0, 0.0]}, "rest": {"kind": "wall"}}
    assert slid(tmp_path, 0.05, boundaries=floor)[0] == pytest.approx(SPEED + 0.5 * G * 0.05, rel=1e-9)
    assert slid(tmp_path, 0.4, boundaries=floor)[0] == pytest.approx(2.0, rel=1e-9)


@pytest.mark.parametrize(("effects", "sections"), [
    (EFFECTS, {"boundaries": {"sides": {"kind": "slip_wall"}}}),
    (EFFECTS, {"walls": {"specularity": 0.0}}),
    (["gravity", "walls"], {}),
])  # fmt: skip
def test_a_smooth_floor_does_not_hold_it_back(tmp_path, effects, sections):
    assert slid(tmp_path, 0.05, effects, **sections)[0] == SPEED
