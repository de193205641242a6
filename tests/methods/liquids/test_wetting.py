"""Contact angle at walls: what wall particles stand for, and how far the interface turns between them and the drop."""

import math

import numpy as np
import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.engine.state import GAS, LIQUID, WALL
from sdph.methods.liquids import interface, wetting
from sdph.methods.liquids.limiters import held
from sdph.methods.liquids.method import LiquidStepper
from sdph.schema import CaseError

RADIUS, SPACING, ROWS = 1e-3, 1e-4, 5  # m, m, rows of particles beyond which no kernel sees the wall
FILE = scenes.find("drop_on_plate")[1]


def stepper(degrees):
    return LiquidStepper(
        cases.load(FILE, ("resolution.spacing_mm=0.1", f"surface_tension.contact_angle_deg={degrees}"))
    )


def cut(own, meets, middle):
    """Make liquid of what lies in a disc that meets the plate at an angle [deg]; tension anew. middle [m]."""
    s, low = own.state, -RADIUS * math.cos(math.radians(meets))
    fluid = s.kind != WALL
    s.kind[fluid] = np.where(np.hypot(s.x - middle, s.y - low)[fluid] < RADIUS, LIQUID, GAS)
    s.density[fluid] = np.where(s.kind[fluid] == LIQUID, 1000.0, 1.0)
    s.mass[fluid] = s.density[fluid] * SPACING**2
    own.volume[fluid] = SPACING**2
    interface.tighten(own)
    return low


def turned(own, meets):
    """Angle [deg] by which the interface turns within ROWS of the plate beyond the disc's own; mean of drops that lie
    differently on the lattice."""
    total, weight = np.zeros(ROWS), np.zeros(ROWS)
    for middle in 2e-3 + SPACING * np.arange(12) / 12.0:
        low, s = cut(own, meets, middle), own.state
        met = (own.curvature != 0.0) & (s.y < ROWS * SPACING)
        near = np.abs(np.hypot(s.x - middle, s.y - low)[met] - RADIUS) < SPACING
        row = (s.y[met][near] / SPACING).astype(int)
        total += np.bincount(row, own.curvature[met][near], ROWS)
        weight += np.bincount(row, minlength=ROWS)
    height = (np.arange(ROWS) + 0.5) * SPACING
    way = SPACING / np.sqrt(1.0 - ((height - low) / RADIUS) ** 2)
    return math.degrees(((total / weight - 1.0 / RADIUS) * way).sum())


@pytest.mark.parametrize("degrees", [60.0, 90.0, 120.0])
def test_interface_turns_to_the_angle_of_the_wall(degrees):
    """By nothing where it has it, by 10 degrees where it is 10 off."""
    own = stepper(degrees)
    assert turned(own, degrees) == pytest.approx(0.0, abs=3.0)
    assert turned(own, degrees + 10.0) == pytest.approx(-10.0, abs=3.0)


@pytest.mark.parametrize("degrees", [30.0, 90.0, 150.0])
def test_walls_have_the_normal_of_the_angle_where_the_interface_is(degrees):
    own = stepper(degrees)
    cut(own, 90.0, 2e-3)
    s = own.state
    plate = (s.kind == WALL) & (s.y < 0.0) & (np.abs(s.x - 2e-3) < 1.5e-3)
    met = plate & own.normal.any(axis=1)
    right = met & (s.x > 2e-3)
    angle = math.radians(degrees)
    assert right.sum() > 5
    np.testing.assert_allclose(own.normal[right], [[math.sin(angle), math.cos(angle), 0.0]] * right.sum(), atol=1e-3)
    assert np.abs(np.abs(s.x[met] - 2e-3) - RADIUS).max() < 6.0 * SPACING
    assert not own.normal[plate & (np.abs(s.x - 2e-3) < 0.4e-3)].any()


def test_what_is_held_where_the_interface_meets_the_wall_is_told():
    """Pairs led on further than FURTHEST, by hand, and the lowest row once it is set into the plate."""
    own = stepper(90.0)
    cut(own, 90.0, 2e-3)
    s, active = own.state, own.active
    first = held(own)
    assert (first["wetting_height_held_share"], first["wetting_unmet_share"]) == (0.0, 0.0)
    has = own.normal.any(axis=1)
    far = [(s.y[i] - s.y[j]) / s.y[i] for i in active[has[active]] for j in own.walls[has[own.walls]]
           if math.hypot(s.x[i] - s.x[j], s.y[i] - s.y[j]) < 2.0 * own.kernel.h]  # fmt: skip
    assert first["wetting_factor_held_share"] == pytest.approx(np.mean(np.array(far) > 4.0 + 1e-9), abs=1e-12)
    assert 0.05 < first["wetting_factor_held_share"] < 0.4
    near = own.line.facing[active].any(axis=1)
    lowest = active[s.y[active] < SPACING]
    s.y[lowest] -= 0.2 * SPACING
    interface.tighten(own)
    assert held(own)["wetting_height_held_share"] == 0.0
    s.y[lowest] -= 0.5 * SPACING
    interface.tighten(own)
    assert held(own)["wetting_height_held_share"] == pytest.approx(len(lowest) / near.sum(), rel=0.2)


def test_a_film_along_a_wall_does_not_meet_it():
    own = stepper(90.0)
    s = own.state
    fluid = s.kind != WALL
    s.kind[fluid] = np.where(s.y[fluid] < 2.0 * SPACING, LIQUID, GAS)
    interface.tighten(own)
    plate = own.walls[(s.y[own.walls] < 0.0) & (np.abs(s.x[own.walls] - 2e-3) < 1e-3)]
    seen = own.line.meeting[plate] > 0
    assert seen.sum() > 10 and (own.line.meeting[plate][seen] == wetting.UNMET).all() and not own.normal[plate].any()
    sides = (own.line.meeting[own.walls] == wetting.MET).sum()  # the film ends at the sides, which it does meet
    many = (own.line.meeting[own.walls] > 0).sum()
    assert sides > 0 and held(own)["wetting_unmet_share"] == 1.0 - sides / many


def test_without_an_angle_walls_have_no_normal():
    table = cases.to_table(cases.load(FILE, ("resolution.spacing_mm=0.1",)))
    del table["surface_tension"]["contact_angle_deg"]
    own = LiquidStepper(cases.from_table(table))
    cut(own, 90.0, 2e-3)
    assert len(own.p["surface_tension"]) == 2
    assert not [key for key in held(own) if key.startswith("wetting")]
    assert not own.normal[own.state.kind == WALL].any()


def test_an_angle_without_walls_is_told():
    with pytest.raises(CaseError, match="contact_angle_deg = 60; there are no walls"):
        LiquidStepper(cases.load(scenes.find("oscillating_droplet")[1], ("surface_tension.contact_angle_deg=60.0",)))
