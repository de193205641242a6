"""The cavity of a ring: its area, forces that add up to nothing, pressure and growth."""

import math

import numpy as np
import pytest
from blocks import moved, stepper

from sdph.effects.solids import inflation
from sdph.engine import state as particles
from sdph.schema import CaseError

RING = {"shape": "ring", "centre_m": [0.5, 0.5], "radius_m": 0.25, "inner_radius_m": 0.2}


def ring(solid=None, **own):
    return stepper(
        solid=solid, bodies={"ring": RING}, effects=["inflation"],
        inflation={"body": "ring", "pressure_Pa": 10.0} | own,
        resolution={"spacing_mm": 12.5, "smoothing_ratio": 1.3},
    )  # fmt: skip


def test_area_of_the_cavity_is_that_inside_the_surface():
    own = ring()
    count = len(own.cavity.nodes)
    polygon = 0.5 * count * math.sin(2.0 * math.pi / count) * 0.2**2
    assert own.cavity.area == pytest.approx(polygon, rel=1e-3)
    moved(own, 0.5 + 1.1 * (own.reference - 0.5))
    assert own.cavity.area == pytest.approx(1.21 * polygon, rel=1e-3)


def test_pressure_pushes_outwards_with_the_force_of_the_surface_and_no_sum():
    own = ring()
    places = particles.positions(own.state)
    places[:, 0] = 0.5 + 1.2 * (places[:, 0] - 0.5)  # an ellipse
    moved(own, places)
    own.cavity.push(own.state, own.gradient, 1.0, own.pressed)
    force = own.state.mass[:, None] * own.pressed
    assert np.linalg.norm(force.sum(axis=0)) < 1e-12 * np.abs(force).sum()
    upper = own.reference[:, 1] > 0.5
    assert force[upper, 1].sum() == pytest.approx(10.0 * 2.0 * 1.2 * 0.2, rel=0.02)
    assert set(np.flatnonzero(np.abs(force).sum(axis=1))) == set(own.cavity.nodes)


def test_pressure_rises_smoothly():
    p = inflation.InflationP(10.0, 2.0, 0.0, 0.0, 0.5)
    assert [inflation.pressure(p, time, 1.0, 1.0) for time in (0.0, 1.0, 2.0, 3.0)] == [0.0, 5.0, 10.0, 10.0]


def test_a_liquid_presses_where_the_cavity_is_smaller_than_wanted():
    p = inflation.InflationP(0.0, 0.0, 2.0, 1e6, 0.5)
    wanted = 0.1 + 0.25 * math.pi * 0.25 * (1.2**2 - 1.0)
    assert inflation.pressure(p, 0.1, wanted, 0.1) == pytest.approx(0.0, abs=1e-9)
    assert inflation.pressure(p, 0.1, wanted / 1.01, 0.1) == pytest.approx(1e4)
    slow = p._replace(rise_time=0.2)
    assert inflation.pressure(slow, 0.2, wanted, 0.1) == pytest.approx(0.0, abs=1e-9)  # half of its growth is lost
    risen = p._replace(rise_time=0.1)
    early, late = (inflation.pressure(risen, t, 0.1, 0.1) for t in (0.0999999, 0.1000001))
    assert early == pytest.approx(late, rel=1e-4)


def test_a_ring_that_may_fail_is_not_inflated():
    """The pressure knows no tear."""
    brittle = {"yield_stress_Pa": 1e4, "failure": [0.1, 0.0, 0.0, 0.0, 0.0]}
    with pytest.raises(CaseError, match="inflation goes on pressing on what is left of a ring that has torn"):
        ring(solid=brittle)


def test_diameter():
    own = ring()
    moved(own, 0.3 + 1.1 * (own.reference - 0.5))
    assert own.cavity.diameter_ratio(own.state, own.reference) == pytest.approx(1.1)
