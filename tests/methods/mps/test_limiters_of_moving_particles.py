"""What limiters hold in a liquid of moving particles is counted: by hand where they act, nothing where they do not."""

import numpy as np
import pytest
from moving import SPACING, case, joined

from sdph.engine.state import LIQUID, positions
from sdph.methods.mps import pools
from sdph.methods.mps.limiters import held
from sdph.methods.mps.method import MpsStepper

TANK = {
    "domain": {"size_m": [12 * SPACING] * 2, "gravity_m_s2": [0.0, -9.81]},
    "pools": {"drop": None, "water": {"lower_m": [0.0, 0.0], "upper_m": [12 * SPACING, 6 * SPACING]}},
}


def tank(suction="none"):
    return MpsStepper(case(("gravity", "tank"), joined(TANK, {"tank": {"suction": suction}}), 2))


def test_pairs_closer_than_their_weight_knows_are_counted():
    own = MpsStepper(case())
    assert held(own)["close_share"] == 0.0
    own.state.x[5], own.state.y[5], own.state.z[5] = (places[9] + 0.05 * SPACING for places in positions(own.state).T)
    own._rebuild()
    assert held(own)["close_share"] == 2.0 / (own.state.kind == LIQUID).sum()
    assert "walls_held_share" not in held(own)


def by_hand(own, pressure, scale):
    """Share of the pairs of water and wall whose pressure in the wall would be below 0."""
    s, found = own.state, []
    places, water = positions(s), np.flatnonzero(s.kind == LIQUID)
    wall = np.flatnonzero(s.kind != LIQUID)
    for i in water:
        for j in wall:
            way = (places[j] - places[i])[:2]
            if np.linalg.norm(way) < own.cloud.reach:
                block = own.walls.block[s.ident[j] - own.walls.first, :2, :2]
                found.append(pressure[i] + scale * np.array([s.u[i], s.v[i]]) @ block @ way < 0.0)
    return np.mean(found)


def test_walls_that_would_pull_are_counted():
    own = tank()
    s, scale = own.state, 780.0 / 1e-4
    rng = np.random.default_rng(5)
    s.u[s.kind == LIQUID], s.v[s.kind == LIQUID] = rng.normal(size=(2, (s.kind == LIQUID).sum()))
    pressure, beside = np.abs(rng.normal(size=len(s.x))), np.zeros(len(s.x), np.int8)
    own.at_walls = pools.press(*own.around, pressure, beside, scale, np.zeros((len(s.x), 3)), np.zeros((len(s.x), 3)))
    share = held(own)["walls_held_share"]
    assert 0.2 < share < 0.8 and share == pytest.approx(by_hand(own, pressure, scale), rel=1e-12)


@pytest.mark.parametrize("rises, share", [(1.0, True), (0.0, False)])
def test_water_that_leaves_the_floor_is_held_by_no_wall(rises, share):
    own = tank()
    own.state.v[own.state.kind == LIQUID] = rises
    own.step(1e-5)
    assert (held(own)["walls_held_share"] > 0.1) == share


def test_a_wall_that_may_pull_is_no_limiter():
    assert "walls_held_share" not in held(tank("full"))
