"""Lift laws against Saffman's and Mei's own numbers."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sdph.laws import lift

MU, RHO = 1.8e-5, 1.2


def test_saffmans_force():
    """F = 6.46 mu a^2 s sqrt(G/nu), a the radius: Saffman 1965."""
    d, s, shear = 1e-4, 0.02, 30.0
    force = lift.saffman(s, shear, d, RHO, MU) * s * shear * math.pi / 6.0 * d**3
    assert force == pytest.approx(6.46 * MU * (0.5 * d) ** 2 * s * math.sqrt(shear * RHO / MU), rel=1e-12)


@pytest.mark.parametrize(
    ("reynolds", "ratio", "factor"),  # worked out by hand from Mei's fit; ratio is his b = Re_G/(2 Re_p)
    [
        (1.0, 0.1, (1.0 - 0.3314 * 0.316227766) * 0.904837418 + 0.3314 * 0.316227766),
        (10.0, 0.4, (1.0 - 0.3314 * 0.632455532) * 0.367879441 + 0.3314 * 0.632455532),
        (40.0, 0.1, (1.0 - 0.3314 * 0.316227766) * 0.018315639 + 0.3314 * 0.316227766),
        (100.0, 0.1, 0.0524 * math.sqrt(10.0)),
    ],
)
def test_meis_factor(reynolds, ratio, factor):
    assert lift.mei_factor(reynolds, 2.0 * ratio * reynolds) == pytest.approx(factor, rel=1e-8)


def test_meis_factor_is_saffmans_at_rest_and_jumps_by_little_at_40():
    assert lift.mei_factor(0.0, 3.0) == 1.0
    assert lift.mei_factor(1e-9, 3.0) == pytest.approx(1.0, abs=1e-4)
    below, above = lift.mei_factor(40.0, 8.0), lift.mei_factor(40.0 * (1.0 + 1e-12), 8.0)
    assert above / below == pytest.approx(0.86, abs=0.01)


@pytest.mark.parametrize("law", [lift.saffman_mei, lift.saffman])
@given(slip=st.floats(0.0, 30.0), spin=st.floats(0.0, 1e5), d=st.floats(1e-6, 5e-3))
def test_finite_everywhere_and_no_lift_without_shear(law, slip, spin, d):
    value = law(slip, spin, d, RHO, MU)
    assert math.isfinite(value * slip * spin) and value >= 0.0
    assert law(slip, 0.0, d, RHO, MU) * slip * 0.0 == 0.0
