"""The cavity of a ring: its area, forces that add up to nothing, pressure and growth."""

import math

import numpy as np
import pytest
from blocks import moved, stepper

from sdph.effects.solids import inflation
from sdph.engine import state as particles
from sdph.engine.guard import Unstable
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


BRITTLE = {"yield_stress_Pa": 1e4, "failure": [0.01, 0.0, 0.0, 0.0, 0.0]}


def test_a_ring_that_may_fail_is_not_inflated_by_a_pressure():
    """The pressure knows no tear."""
    with pytest.raises(CaseError, match="goes on pressing on what is left of a ring that has torn"):
        ring(solid=BRITTLE)


def test_a_driven_ring_ends_where_it_tears():
    own = ring(solid=BRITTLE, by="growth", growth_1_s=5.0, bulk_modulus_Pa=1e6, pressure_Pa=0.0)
    own.guard.begin(Begun(own))
    while not own.free.any() and own.time < 0.02:
        own.guard.look(own)
        own.step(1.0)
    with pytest.raises(Unstable, match=r"bodies\.ring tore at t = .* D/D0 = 1\.0.*inflation knows no tear"):
        own.guard.look(own)


def test_what_another_body_loses_does_not_end_a_driven_ring():
    own = stepper(
        solid=BRITTLE, bodies={"block": {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.1, 0.1]}, "ring": RING},
        effects=["inflation"], inflation={"body": "ring", "by": "growth", "growth_1_s": 5.0, "bulk_modulus_Pa": 1e6},
        resolution={"spacing_mm": 12.5, "smoothing_ratio": 1.3},
    )  # fmt: skip
    own.guard.begin(Begun(own))
    own.free[np.flatnonzero(own.body == 0)[0]] = 1
    own.guard.look(own)
    own.free[np.flatnonzero(own.body == 1)[0]] = 1
    with pytest.raises(Unstable, match=r"bodies\.ring tore"):
        own.guard.look(own)


class Begun:
    """A run as a guard sees it at the beginning of a window."""

    def __init__(self, own):
        self.state, self.time, self.windows = own.state, own.time, 0


def test_disorder_moves_places_by_no_more_than_its_share_and_no_volume():
    even, off = ring(), stepper(
        bodies={"ring": RING | {"disorder": 0.1, "seed": 3}}, resolution={"spacing_mm": 12.5, "smoothing_ratio": 1.3}
    )  # fmt: skip
    order, other = np.argsort(even.state.ident), np.argsort(off.state.ident)
    moved_by = np.abs(off.reference[other, :2] - even.reference[order, :2]) / 0.0125
    assert 0.099 < moved_by.max() <= 0.1 + 1e-12 and moved_by.mean() == pytest.approx(0.05, rel=0.05)
    np.testing.assert_array_equal(off.state.mass[other], even.state.mass[order])
    assert np.abs(off.acceleration).max() < 1e-9 * 1e6 / (1000.0 * 0.0125)  # undeformed as they stand


def test_diameter():
    own = ring()
    moved(own, 0.3 + 1.1 * (own.reference - 0.5))
    assert own.cavity.diameter_ratio(own.state, own.reference) == pytest.approx(1.1)
