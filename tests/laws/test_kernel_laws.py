import math

import numpy as np
import pytest
from exact_solutions import lattice_divergence_factor
from hypothesis import given
from hypothesis import strategies as st

from sdph.laws import kernels

NAMES = sorted(kernels.KERNELS)
SPHERE = {1: lambda r: 2.0, 2: lambda r: 2.0 * math.pi * r, 3: lambda r: 4.0 * math.pi * r * r}
H = 0.00375  # m


def profile(name, dims, radii):
    sigma = kernels.normalisation(name, dims, H)
    return [kernels.KERNELS[name].value(r, H, sigma) for r in radii]


@pytest.mark.parametrize("dims", [1, 2, 3])
@pytest.mark.parametrize("name", NAMES)
def test_integral_over_the_support_is_one(name, dims):
    nodes, weights = np.polynomial.legendre.leggauss(12)  # exact for the piecewise polynomials
    total = 0.0
    for start in (0.0, H):
        radii = start + 0.5 * H * (nodes + 1.0)
        total += 0.5 * H * sum(w * SPHERE[dims](r) * v for w, r, v in zip(weights, radii, profile(name, dims, radii)))
    assert total == pytest.approx(1.0, rel=1e-13)


@pytest.mark.parametrize("name", NAMES)
@given(q=st.floats(0.01, 2.2))
def test_gradient_is_the_slope_of_the_value(name, q):
    kernel, sigma, r, step = kernels.KERNELS[name], kernels.normalisation(name, 2, H), q * H, 1e-5 * H
    slope = (kernel.value(r + step, H, sigma) - kernel.value(r - step, H, sigma)) / (2.0 * step)
    assert kernel.gradient(r, H, sigma) * r == pytest.approx(slope, rel=1e-6, abs=1e-6 * sigma / H)


@pytest.mark.parametrize("name, limit", [("cubic_spline", -3.0), ("wendland_c2", -5.0)])
def test_gradient_over_r_is_finite_at_the_centre(name, limit):
    sigma = kernels.normalisation(name, 3, H)
    gradient = kernels.KERNELS[name].gradient
    assert gradient(0.0, H, sigma) == pytest.approx(limit * sigma / H**2, rel=1e-14)
    assert gradient(1e-9 * H, H, sigma) == pytest.approx(limit * sigma / H**2, rel=1e-8)


@pytest.mark.parametrize("name", NAMES)
@given(q=st.floats(0.0, 3.0), further=st.floats(0.0, 1.0))
def test_value_falls_with_distance_and_ends_at_the_support(name, q, further):
    near, far = profile(name, 2, [q * H, (q + further) * H])
    assert near >= far >= 0.0
    assert (near > 0.0) == (q * H / H < kernels.SUPPORT) or near < 1e-40 * kernels.normalisation(name, 2, H)


@pytest.mark.parametrize("name", NAMES)
def test_value_is_continuous_at_the_knot(name):
    below, above = profile(name, 2, [np.nextafter(H, 0.0), np.nextafter(H, 1.0)])
    assert below == pytest.approx(above, rel=1e-14)


def test_lattice_bias_of_the_cubic_spline():
    assert kernels.lattice_factor("cubic_spline", 2, 1.5) == pytest.approx(1.00344, abs=5e-6)  # closure sheet, no. 25


@pytest.mark.parametrize("name, dims", [("cubic_spline", 2), ("cubic_spline", 3), ("wendland_c2", 2)])
def test_lattice_sums_converge_to_one(name, dims):
    for factor in (kernels.lattice_factor, lattice_divergence_factor):
        assert abs(factor(name, dims, 3.5) - 1.0) < abs(factor(name, dims, 1.2) - 1.0) < 0.2
        assert factor(name, dims, 3.5) == pytest.approx(1.0, abs=3e-3)
