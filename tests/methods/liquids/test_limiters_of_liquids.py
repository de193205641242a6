"""What limiters hold in a liquid is counted: what it is where they act by hand, nothing where they do not."""

import numpy as np
import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.methods.liquids.limiters import held
from sdph.methods.liquids.method import LiquidStepper


def stepper(name, *given):
    return LiquidStepper(cases.load(scenes.HERE / name / "case.toml", given))


@pytest.fixture(scope="module")
def pool():
    return stepper("hydrostatic_tank")


def test_a_pool_at_rest_is_not_held(pool):
    found = held(pool)
    assert 0.0 < found.pop("softened_rel") < 0.02  # of every pair, at rest too
    shares = {"wall_holds_off_share": 0.0, "walls_held_share": pytest.approx(0.0, abs=0.1), "no_gradient_share": 0.0}
    assert found == shares


def test_a_particle_at_a_wall_is_counted_and_so_is_suction(pool):
    before, lowest = held(pool), pool.active[np.argmin(pool.state.y[pool.active])]
    pool.state.y[lowest] *= 0.1
    pool.forces()
    assert 0.0 < held(pool)["wall_holds_off_share"] < 0.2
    pool.state.density[pool.active] = 0.98 * pool.case.liquid.density
    pool.forces()
    assert held(pool)["walls_held_share"] > max(0.5, before["walls_held_share"])


def test_shifts_and_control_of_tension_are_counted():
    own = stepper("square_patch", "resolution.spacing_mm=50")
    own.step(1.0)
    found, least, inside = held(own), own.state.enclosure[own.active], own.pressure[own.active] < 0.0
    assert found["shift_at_surface_share"] == (least <= 0.75).mean() > 0.0
    assert found["tension_controlled_share"] == (inside & (least > 0.75)).mean() > 0.0
    for shifts, share in ((0.0, 0.0), (1e9, 7 / len(own.active))):
        own.shift[own.active[:7]], own.shift[own.active[7:]] = shifts, 0.0
        assert held(own)["shift_held_share"] == share


def test_what_the_correction_leaves_out_is_counted():
    own = stepper("square_patch", "resolution.spacing_mm=50", "liquid.pressure_gradient='corrected'")
    assert 0.1 < held(own)["uncorrected_share"] < 0.5  # the outermost layer of 20 x 20 is 0.19
