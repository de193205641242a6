"""Sizes of drops against closed forms and sums over many drops."""

import math
from statistics import NormalDist

import lognormal
import numpy as np
import pytest

from sdph.effects.gas.sizes import Sizes
from sdph.engine import state as particles
from sdph.laws import grain_loss, grain_sizes
from sdph.running import sizing

MEAN, STD, DENSITY = 1e-4, 4e-5, 700.0
ARRAYS = ("diameter", "diameter_variance", "born_mass", "born_diameter", "born_variance", "lost_still", "lost_moving")


def told(p, state):
    found = sizing.Census(*(np.zeros(len(state.x)) for _ in range(4)), np.zeros(sizing.BINS))
    sizing.tally(p, DENSITY, state, *found)
    return found, sizing.diameters(sizing.sums_of(found), found.volume)


def drops(*kinds, mass=1e-9, still=0.0, moving=0.0):
    """A particle for each (mean, std) [m] at birth, all of them with the same loss."""
    state = particles.empty(len(kinds), ARRAYS, 3)
    state.mass[:] = mass
    state.diameter[:], state.diameter_variance[:] = np.array([(m, s**2) for m, s in kinds]).reshape(-1, 2).T
    state.born_diameter[:], state.born_variance[:] = state.diameter, state.diameter_variance
    state.lost_still[:], state.lost_moving[:] = still, moving
    return state


def test_a_log_normal_has_the_diameters_of_its_closed_form():
    found, own = told(Sizes(1, 1.0), drops((MEAN, STD)))
    m, s = grain_sizes.log_mean(MEAN, STD), grain_sizes.log_std(MEAN, STD)
    assert own["D10_m"] == pytest.approx(MEAN, rel=1e-4)
    third, second = (lognormal.raw_moment(k, MEAN, STD) for k in (3, 2))
    assert own["D32_m"] == pytest.approx(third / second, rel=1e-4)
    for name, share in sizing.SHARES.items():
        assert own[name] == pytest.approx(math.exp(m + 3.0 * s * s + s * NormalDist().inv_cdf(share)), rel=3e-3)
    assert found.number[0] == pytest.approx(1e-9 / (DENSITY * math.pi / 6.0 * third), rel=1e-4)
    assert found.volume.sum() == pytest.approx(1e-9 / DENSITY, rel=1e-12)


def test_what_evaporation_left_of_it_is_a_sum_over_many_drops():
    """Small drops are gone; 200 000 of them, each by its own law."""
    still, c = (0.8 * MEAN) ** 2, 20.0
    _, own = told(Sizes(1, 1.0), drops((MEAN, STD), still=still, moving=c * still))
    m, s = grain_sizes.log_mean(MEAN, STD), grain_sizes.log_std(MEAN, STD)
    shares = (np.arange(200_000) + 0.5) / 200_000
    quantile = np.interp(shares, [NormalDist().cdf(z) for z in np.linspace(-8, 8, 4001)], np.linspace(-8, 8, 4001))
    d = np.array([math.sqrt(grain_loss.square_after(math.exp(2.0 * (m + s * z)), still, c)) for z in quantile])
    d = d[d > 0.0]
    assert 0.2 < len(d) / 200_000 < 0.6
    assert own["D10_m"] == pytest.approx(d.mean(), rel=2e-3)
    assert own["D32_m"] == pytest.approx((d**3).sum() / (d**2).sum(), rel=1e-3)
    below = np.cumsum(d**3) / (d**3).sum()
    for name, share in sizing.SHARES.items():
        assert own[name] == pytest.approx(np.interp(share, below, d), rel=6e-3)


def test_drops_that_are_alike_within_a_particle():
    """Two sizes of equal mass, without a distribution: 1 large drop weighs as much as 8 small ones."""
    state = drops((1e-4, 0.0), (2e-4, 0.0))
    _, own = told((), state)
    assert own["D10_m"] == pytest.approx((8 * 1e-4 + 2e-4) / 9, rel=1e-12)
    assert own["D32_m"] == pytest.approx((8 * 1e-12 + 8e-12) / (8 * 1e-8 + 4e-8), rel=1e-12)
    assert own["Dv10_m"] == pytest.approx(1e-4, rel=0.012) and own["Dv90_m"] == pytest.approx(2e-4, rel=0.012)


def test_where_no_drop_is_there_is_no_size():
    assert all(math.isnan(value) for value in told(Sizes(1, 1.0), drops())[1].values())
