import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sdph.laws import grain_sizes

means = st.floats(1e-5, 1e-2)
ratios = st.floats(0.0, 0.6)  # std/mean
BROAD = 3e-4, 1.2e-4  # m


@given(mean=means, ratio=ratios, order=st.integers(-3, 6))
def test_quadrature_reproduces_the_moments(mean, ratio, order):
    d, w = grain_sizes.number_quadrature(mean, ratio * mean, 20)
    assert w @ d**order == pytest.approx(grain_sizes.raw_moment(float(order), mean, ratio * mean), rel=1e-7)
    d, w = grain_sizes.mass_quadrature(mean, ratio * mean, 20)
    assert w @ d**order == pytest.approx(grain_sizes.mass_moment(float(order), mean, ratio * mean), rel=1e-7)


@given(mean=means, ratio=ratios)
def test_first_two_moments_are_what_was_asked_for(mean, ratio):
    std = ratio * mean
    first, second = (grain_sizes.raw_moment(k, mean, std) for k in (1.0, 2.0))
    assert first == pytest.approx(mean, rel=1e-12)
    assert second - first**2 == pytest.approx(std**2, rel=1e-9, abs=1e-13 * mean**2)


@given(mean=means, ratio=ratios, order=st.floats(-2.0, 3.0))
def test_mass_weights_are_number_weights_times_volume(mean, ratio, order):
    std = ratio * mean
    expected = grain_sizes.raw_moment(order + 3.0, mean, std) / grain_sizes.raw_moment(3.0, mean, std)
    assert grain_sizes.mass_moment(order, mean, std) == pytest.approx(expected, rel=1e-10)


@given(mean=means, ratio=ratios)
def test_sauter_diameter_keeps_the_surface_per_volume(mean, ratio):
    d, w = grain_sizes.number_quadrature(mean, ratio * mean, 20)
    assert grain_sizes.sauter_diameter(mean, ratio * mean) == pytest.approx((w @ d**3) / (w @ d**2), rel=1e-8)
    assert 1.0 / grain_sizes.sauter_diameter(mean, ratio * mean) == pytest.approx(
        grain_sizes.mass_moment(-1.0, mean, ratio * mean), rel=1e-12
    )


def test_moments_agree_with_a_sample():
    sample = np.random.default_rng(7).lognormal(grain_sizes.log_mean(*BROAD), grain_sizes.log_std(*BROAD), 400_000)
    assert sample.mean() == pytest.approx(BROAD[0], rel=2e-3)
    assert sample.std() == pytest.approx(BROAD[1], rel=1e-2)
    assert (sample**3).mean() == pytest.approx(grain_sizes.raw_moment(3.0, *BROAD), rel=1e-2)
    assert (sample**4).sum() / (sample**3).sum() == pytest.approx(grain_sizes.mass_moment(1.0, *BROAD), rel=2e-2)


@pytest.mark.parametrize("n", [1, 2, 5, 9])
def test_nodes_are_the_standard_normal(n):
    x, w = grain_sizes.gauss_hermite(n)
    assert len(x) == len(w) == n
    assert w.sum() == pytest.approx(1.0, rel=1e-13)
    normal = [0.0 if k % 2 else math.prod(range(k - 1, 0, -2)) for k in range(2 * n)]
    np.testing.assert_allclose([w @ x**k for k in range(2 * n)], normal, rtol=1e-10, atol=1e-9 * max(normal))


def test_node_by_node_equals_the_arrays():
    x, w = grain_sizes.gauss_hermite(5)
    s = grain_sizes.log_std(*BROAD)
    for centre, quadrature in (
        (grain_sizes.log_mean(*BROAD), grain_sizes.number_quadrature),
        (grain_sizes.mass_log_mean(*BROAD), grain_sizes.mass_quadrature),
    ):
        d, weights = quadrature(*BROAD, 5)
        np.testing.assert_allclose([grain_sizes.diameter_at(node, centre, s) for node in x], d, rtol=1e-14)
        np.testing.assert_array_equal(weights, w)


@given(alpha_p=st.floats(0.01, 0.6), dx=st.floats(1e-3, 0.1), mean=means, ratio=ratios, dims=st.sampled_from([2, 3]))
def test_counted_grains_give_the_mass_back(alpha_p, dx, mean, ratio, dims):
    rho, std = 3060.0, ratio * mean
    mass = grain_sizes.particle_mass(alpha_p, rho, dx, dims)
    spheres = grain_sizes.sphere_count(alpha_p, dx, dims, mean, std) * grain_sizes.sphere_mass(rho, mean, std)
    assert spheres == pytest.approx(mass, rel=1e-12)
    discs = grain_sizes.disc_count(alpha_p, dx, mean, std) * grain_sizes.disc_mass(rho, mean, std)
    assert discs == pytest.approx(grain_sizes.particle_mass(alpha_p, rho, dx, 2), rel=1e-12)


def test_equal_grains_are_all_alike():
    d, _w = grain_sizes.mass_quadrature(3e-4, 0.0, 5)
    np.testing.assert_allclose(d, 3e-4, rtol=1e-13)
    assert grain_sizes.sphere_mass(3060.0, 3e-4, 0.0) == pytest.approx(3060.0 * math.pi / 6.0 * 3e-4**3, rel=1e-13)
