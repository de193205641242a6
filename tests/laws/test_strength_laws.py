"""Strength of solids against values that were made apart (gel_reference.json, groups jcd and shell)."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sdph.laws import matrices, solids, strength

A, B, N, C, EPS0 = 490e3, 807e3, 0.73, 0.1739, 5e-4
DAMAGE = strength.Damage(0.00705, 1.732, -0.054, -0.0123, 1.0, 0.012, 0.0)
K, G = strength.bulk_modulus(20e6, 0.45), strength.shear_modulus(20e6, 0.45)


def plastic(softening=1.0):
    return strength.Plastic(A, B, N, C, EPS0, softening)


@pytest.mark.parametrize(
    ("r", "rate", "t_star", "harm", "expected"),
    [
        (0.0, 0.5, 0.0, 0.0, 1078616.735077347),
        (0.3, 5e-4, 0.0, 0.0, 825098.1657911883),
        (0.3, 0.5, 0.0, 0.006, 1805356.9419709693),
        (0.2, 50.0, 0.04, 0.0, 2111600.452941862),
    ],
)
def test_flow_stress(r, rate, t_star, harm, expected):
    found = strength.flow_stress(plastic(1.0 - t_star**0.94 if t_star else 1.0), r, rate, harm)
    assert found == pytest.approx(expected, rel=1e-8)


@pytest.mark.parametrize(
    ("triaxiality", "expected"),
    [(1.0 / 3.0, 1.5630190301499773), (3.0**-0.5, 1.5426428088589779), (2.0 / 3.0, 1.5352514633210121)],
)
def test_failure_strain(triaxiality, expected):
    assert strength.failure_strain(DAMAGE, triaxiality, 0.5, EPS0) == pytest.approx(expected, rel=1e-8)


def test_rates_below_the_reference_and_extreme_triaxiality_are_held():
    assert strength.rate_share(C, 0.0, EPS0) == 1.0
    held = strength.failure_strain(DAMAGE, 3.0, 0.5, EPS0)
    assert strength.failure_strain(DAMAGE, 1e3, 0.5, EPS0) == held
    assert strength.failure_strain(DAMAGE, -1e3, 0.5, EPS0) > held


def test_a_bar_that_is_drawn():
    """True stress at plastic strain 0.4: damage in steps adds up to D_c p/p_f, and r to p - D_c p^2/(2 p_f)."""
    p_f, p, steps = strength.failure_strain(DAMAGE, 1.0 / 3.0, 0.5, EPS0), 0.4, 1000
    harm = r = 0.0
    for n in range(steps):
        grown = strength.damage_growth(DAMAGE, (n + 1) * p / steps, p / steps, p_f)
        r += (1.0 - harm - 0.5 * grown) * p / steps
        harm += grown
    found = strength.flow_stress(plastic(), r, (1.0 - harm) * 0.5, harm)
    assert found == pytest.approx(1981025.7866430753, rel=1e-8)


@pytest.mark.parametrize("trial", [1.2e6, 5e6, 4e7])
@pytest.mark.parametrize(("r", "harm"), [(0.0, 0.0), (0.2, 0.3)])
def test_radial_return_ends_on_the_flow_stress(trial, r, harm):
    dt, jacobian = 1e-3, 1.02
    dp = strength.plastic_strain(plastic(), trial, G, jacobian, r, harm, dt)
    left = jacobian * strength.flow_stress(plastic(), r + (1.0 - harm) * dp, (1.0 - harm) * dp / dt, harm)
    assert dp > 0.0
    assert trial - 3.0 * G * dp == pytest.approx(left, rel=1e-10)


@given(
    hardening=st.sampled_from([0.0, 8.07e5, 1e9]), exponent=st.floats(0.2, 1.5),
    factor=st.sampled_from([0.0, 0.01, 0.2]), past=st.floats(-8.0, 1.0), r=st.sampled_from([0.0, 1e-9, 1e-3, 0.5]),
    harm=st.floats(0.0, 0.9), step=st.floats(-9.0, 0.0),
)  # fmt: skip
def test_radial_return_comes_to_its_end_for_any_metal(hardening, exponent, factor, past, r, harm, step):
    """Steps of 1 ns to 1 s, stresses a hundred-millionth to ten times past yield."""
    metal = plastic()._replace(hardening=hardening, exponent=exponent, rate_factor=factor)
    dt, trial = 10.0**step, strength.flow_stress(metal, r, 0.0, harm) * (1.0 + 10.0**past)
    dp = strength.plastic_strain(metal, trial, G, 1.0, r, harm, dt)
    left = strength.flow_stress(metal, r + (1.0 - harm) * dp, (1.0 - harm) * dp / dt, harm)
    assert dp > 0.0 and abs(trial - 3.0 * G * dp - left) <= 2e-13 * trial


def test_below_yield_nothing_flows():
    assert strength.plastic_strain(plastic(), 0.99 * A, G, 1.0, 0.0, 0.0, 1.0) == 0.0


def test_damage_waits_for_its_strain():
    late = DAMAGE._replace(begin=0.1)
    assert strength.damage_growth(late, 0.1, 0.01, 1.5) == 0.0
    assert strength.damage_growth(late, 0.11, 0.01, 1.5) == pytest.approx(0.012 * 0.01 / 1.4)


def test_elastic_constants():
    """A bar: E from K and G; sound; energy of a strain e along it with no change of width, (K + 4 G/3) e^2/2."""
    assert pytest.approx(20e6) == 9.0 * K * G / (3.0 * K + G)
    assert strength.sound_speed(K, G, 1500.0) == pytest.approx(math.sqrt((K + 4.0 * G / 3.0) / 1500.0))
    strain = 0.01
    assert strength.elastic_energy(K, G, strain, 2.0 * G * strain) == pytest.approx(
        0.5 * (K + 4.0 * G / 3.0) * strain**2
    )


@pytest.mark.parametrize("seed", range(6))
def test_principal_axes(seed):
    made = np.random.default_rng(seed).standard_normal((3, 3))
    whole = np.eye(3) + 1e-7 * (made + made.T) if seed % 2 else made @ made.T
    whole[2, :2] = whole[:2, 2] = whole[2, :2] * (seed > 1)
    values = matrices.principal(whole[0, 0], whole[1, 1], whole[2, 2], whole[0, 1], whole[1, 2], whole[2, 0])
    axes = np.array(values[3:]).reshape(3, 3)
    np.testing.assert_allclose(axes.T @ np.diag(values[:3]) @ axes, whole, atol=1e-13)
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-14)
    np.testing.assert_allclose(sorted(values[:3]), np.linalg.eigvalsh(whole), rtol=1e-12)


def test_rings():
    hoop, moved = solids.lame_ring(4.5e-4, 1e4, 4.5e-4, 5e-4, 2e7, 0.45)
    assert (hoop, moved) == pytest.approx((95263.15789473684, 1.8561907894736842e-06), rel=1e-8)
    hoop, moved = solids.lame_ring(5e-4, 1e4, 4.5e-4, 5e-4, 2e7, 0.45)
    assert (hoop, moved) == pytest.approx((85263.15789473684, 1.6999342105263158e-06), rel=1e-8)


def test_cantilever():
    assert solids.cantilever_period(0.2, 0.02, 2e6, 0.3975, 1000.0) == pytest.approx(0.25403, rel=1e-4)
    assert solids.cantilever(1.0) == 1.0
    assert solids.cantilever(0.0) == pytest.approx(0.0, abs=1e-15)
    slope = (solids.cantilever(1e-6) - solids.cantilever(0.0)) / 1e-6
    assert slope == pytest.approx(0.0, abs=1e-5)


@pytest.mark.parametrize("failure", [0.1, 0.2, -0.3])
def test_damage_never_goes_backwards(failure):
    """Where the strain at failure is no more than that at which damage begins, what is beyond that fails at once."""
    damage = strength.Damage(failure, 0.0, 0.0, 0.0, 1.0, 0.5, 0.2)
    assert strength.damage_growth(damage, 0.15, 0.01, failure) == 0.0
    assert strength.damage_growth(damage, 0.25, 0.01, failure) == 0.5
    assert strength.damage_growth(damage, 0.25, 0.0, failure) == 0.0
