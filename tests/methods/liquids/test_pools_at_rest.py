"""Pressure of pools at the start: hydrostatic below their own surface, or below the pool that lies on them."""

import numpy as np
import pytest

from sdph.case import read as cases
from sdph.engine import regions
from sdph.engine.state import LIQUID
from sdph.laws import eos
from sdph.methods.liquids import start
from sdph.schema import CaseError

RHO, G, SOUND, DX = 1000.0, 10.0, 40.0, 0.05


def box(lower, upper) -> dict:
    return {"shape": "box", "lower_m": lower, "upper_m": upper}


def disc(centre, radius=0.2) -> dict:
    return {"shape": "disc", "centre_m": centre, "radius_m": radius}


def over(pools: dict) -> dict[str, float]:
    """Pressure at the start less rho g times the depth below the pool's own highest particle's upper face, by pool
    [Pa]: what lies on it; the same for all of its particles."""
    case = cases.from_table({
        "dimensions": 2, "effects": ["gravity", "density_diffusion", "tank"],
        "run": {"end_time_s": 1.0, "output_interval_s": 1.0},
        "domain": {"size_m": [4.0, 3.0], "gravity_m_s2": [0.0, -G]}, "tank": {"open_sides": ["top"]},
        "resolution": {"spacing_mm": 1e3 * DX}, "liquid": {"density_kg_m3": RHO, "sound_speed_m_s": SOUND},
        "pools": pools,
    })  # fmt: skip
    state, found = start.fill(case), {}
    stiffness = RHO * SOUND**2 / case.liquid.exponent
    pressure = eos.tait_pressure(state.density / RHO, stiffness, case.liquid.exponent, 0.0)
    places = np.column_stack([state.x, state.y])
    taken = state.kind != LIQUID
    for name, pool in case.pools.items():
        own = regions.holds(pool, places) & ~taken
        taken |= own
        rest = pressure[own] - RHO * G * (state.y[own].max() + 0.5 * DX - state.y[own])
        assert np.ptp(rest) < 1e-6 * RHO * G
        found[name] = float(rest.mean())
    return found


@pytest.mark.parametrize("turned", [False, True])
def test_columns_apart_have_each_its_own_surface(turned):
    pools = {"high": box([0.0, 0.0], [0.5, 1.0]), "low": box([2.0, 0.0], [2.5, 0.5])}
    found = over(dict(reversed(pools.items())) if turned else pools)
    assert found == pytest.approx({"high": 0.0, "low": 0.0}, abs=1e-6)


def test_what_lies_on_a_pool_presses_on_it_in_whatever_order():
    pools = {"low": box([0.0, 0.0], [1.0, 0.5]), "mid": box([0.0, 0.5], [1.0, 1.0]), "top": box([0.0, 1.0], [1.0, 1.2])}
    pressed = {"low": 0.7 * RHO * G, "mid": 0.2 * RHO * G, "top": 0.0}
    assert over(pools) == pytest.approx(pressed, abs=1e-6)
    assert over(dict(reversed(pools.items()))) == pytest.approx(pressed, abs=1e-6)


def test_drops_that_fall_are_under_no_pool():
    """Two of them, and one over a pool, which it was pulled down by with rho g times its height over it."""
    assert over({"a": disc([1.0, 2.0]), "b": disc([2.5, 2.0])}) == pytest.approx({"a": 0.0, "b": 0.0}, abs=1e-6)
    assert over({"a": disc([1.0, 2.0]), "pool": box([0.0, 0.0], [4.0, 0.5])})["a"] == pytest.approx(0.0, abs=1e-6)


def test_a_drop_within_a_pool_has_in_its_middle_what_the_pool_has_there():
    found = over({"a": disc([1.0, 0.6]), "pool": box([0.0, 0.0], [4.0, 1.0])})
    assert found["a"] == pytest.approx(0.4 * RHO * G - 0.2 * RHO * G, abs=0.5 * DX * RHO * G)


def test_what_lies_under_a_drop_cannot_be_known():
    with pytest.raises(CaseError, match="pools.b lies on or around another pool"):
        over({"a": disc([1.0, 2.0]), "b": disc([1.0, 2.0], 0.5)})


@pytest.mark.parametrize("shape", ["box", "outline"])
def test_a_column_presses_on_the_bed_below_it_alone(shape):
    """A dam break over a wet bed: the bed's surface beside the column is free, in whatever tank; so it is under a
    block that hangs in the air."""
    corners = {"corners_m": [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]]} if shape == "outline" else {}
    case = cases.from_table({
        "dimensions": 2, "effects": ["gravity", "density_diffusion", "tank"],
        "run": {"end_time_s": 1.0, "output_interval_s": 1.0},
        "domain": {"size_m": [4.0, 3.0], "gravity_m_s2": [0.0, -G]}, "tank": {"shape": shape} | corners,
        "resolution": {"spacing_mm": 1e3 * DX}, "liquid": {"density_kg_m3": RHO, "sound_speed_m_s": SOUND},
        "pools": {"column": box([0.0, 0.6], [1.0, 1.6]), "block": box([3.0, 1.2], [3.5, 1.5]),
                  "bed": {"shape": "tank", "fill": 0.2}},
    })  # fmt: skip
    state = start.fill(case)
    pressure = eos.tait_pressure(state.density / RHO, RHO * SOUND**2 / case.liquid.exponent, case.liquid.exponent, 0.0)
    bed = (state.kind == LIQUID) & (state.y < 0.6)
    level = 0.6 - state.y[bed]
    expected = RHO * G * (level + np.where(state.x[bed] < 1.0, 1.0, 0.0))
    np.testing.assert_allclose(pressure[bed], expected, rtol=1e-6)
