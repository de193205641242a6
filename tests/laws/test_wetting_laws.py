"""Drops on plates and liquid between plates against what is known of them by other ways."""

import math

import numpy as np
import pytest

from sdph.laws import wetting


@pytest.mark.parametrize("degrees", [30.0, 60.0, 90.0, 120.0, 150.0])
def test_segment_is_the_part_of_a_disc_above_its_base(degrees):
    """Counted in cells of a thousandth of the radius; angle of the rim at the base."""
    angle, ticks = math.radians(degrees), (np.arange(-1000, 1000) + 0.5) / 1000.0
    x, y = np.meshgrid(ticks, ticks)
    inside = (x**2 + y**2 < 1.0) & (y > math.cos(angle))
    found = wetting.segment(angle, inside.sum() * 1e-6)
    assert found.height == pytest.approx(1.0 - math.cos(angle), rel=1e-3)
    assert found.base == pytest.approx(2.0 * math.sin(angle), rel=1e-3)
    assert found.spread == pytest.approx((x[inside] ** 2).mean(), rel=1e-3)


@pytest.mark.parametrize("degrees", [20.0, 60.0, 120.0])
def test_meniscus_far_from_the_other_plate_rises_as_on_one(degrees):
    """z^2 = 2 l^2 (1 - sin a): Landau & Lifshitz, section 61."""
    angle = math.radians(degrees)
    _, height = wetting.meniscus(angle, 10.0, 1.0)
    rise = math.copysign(math.sqrt(2.0 * (1.0 - math.sin(angle))), 90.0 - degrees)
    assert height[-1] == pytest.approx(rise, rel=1e-3)


@pytest.mark.parametrize("degrees", [45.0, 60.0, 120.0])
def test_meniscus_without_weight_is_an_arc(degrees):
    angle = math.radians(degrees)
    x, height = wetting.meniscus(angle, 1.0, 100.0)
    radius = 1.0 / abs(math.cos(angle))
    arc = radius - np.sqrt(radius**2 - x**2)
    np.testing.assert_allclose(np.abs(height), arc, atol=1e-4)


def test_meniscus_bears_its_weight():
    """sigma cos a of each plate holds rho g times the area above the level of no pressure: z_0 from the curvature in
    the middle."""
    angle, length = math.radians(60.0), 1.3
    x, height = wetting.meniscus(angle, 1.0, length)
    middle = length**2 * 2.0 * height[20] / x[20] ** 2  # z_0 = l^2 z''
    assert np.trapezoid(height + middle, x) == pytest.approx(length**2 * math.cos(angle), rel=1e-3)
    assert x[-1] == pytest.approx(1.0, rel=1e-9)


def test_meniscus_at_a_right_angle_is_level():
    assert not wetting.meniscus(0.5 * math.pi, 1.0, 1.0)[1].any()
