"""Classes of drop sizes: adaptive quadrature, closed forms, and what they must add up to."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lognormal import mass_moment, raw_moment
from scipy.integrate import quad

from sdph.laws import size_classes

X = 2e-4  # m
LEAST = 1e-5


def truth(order, exponent, least, most):
    """Mean of d^-order [m^-order] by mass of a Rosin-Rammler between two sizes, by adaptive quadrature in ln d."""
    a, b = ((d / X) ** exponent for d in (least, most))

    def mass(y, power):
        return math.exp(y - math.exp(y) - power / exponent * y)

    whole, part = (
        quad(mass, math.log(a), math.log(b), (power,), epsabs=0.0, epsrel=1e-12, limit=200)[0] for power in (0, order)
    )
    return part / whole / X**order


def sums(classes):
    """Number and surface of a unit of volume of drops, from number mean and variance of classes of equal mass."""
    own = [(mean, math.sqrt(variance)) for mean, variance in classes]
    number = np.mean([1.0 / raw_moment(3, *one) for one in own])
    return number, np.mean([raw_moment(2, *one) / raw_moment(3, *one) for one in own])


@settings(max_examples=40, deadline=None)
@given(exponent=st.floats(0.7, 8.0), classes=st.integers(1, 12), share=st.floats(0.01, 0.9), bounded=st.booleans())
def test_rosin_rammler_keeps_number_and_surface(exponent, classes, share, bounded):
    """Whatever the number of classes: that of the law between its smallest and its largest drop, to 1e-10."""
    least, most = share * X, 4.0 * X if bounded else math.inf
    found = sums(size_classes.rosin_rammler(X, exponent, least, most, classes))
    end = min(most, X * 45.0 ** (1.0 / exponent))
    assert found == pytest.approx([truth(order, exponent, least, end) for order in (3, 1)], rel=1e-10)


def test_sauter_mean_of_rosin_rammler():
    """X/Gamma(1 - 1/q) without bounds (Lefebvre & McDonell 2017, Eq. 3.17)."""
    number, surface = sums(size_classes.rosin_rammler(X, 3.5, 1e-3 * X, math.inf, 6))
    assert 1.0 / surface == pytest.approx(X / math.gamma(1.0 - 1.0 / 3.5), rel=1e-6)
    assert number > 0.0


def test_classes_of_rosin_rammler_are_of_equal_mass_and_lie_within_their_part():
    """Each class's mean diameter by d^3/d^2 lies between the quantiles of the mass that it stands for."""
    q, n = 2.0, 5
    classes = size_classes.rosin_rammler(X, q, LEAST, math.inf, n)
    low = (LEAST / X) ** q
    edges = [X * (low - math.log1p(-k / n)) ** (1.0 / q) for k in range(n)] + [math.inf]
    for (mean, variance), a, b in zip(classes, edges, edges[1:]):
        assert a < raw_moment(3, mean, math.sqrt(variance)) / raw_moment(2, mean, math.sqrt(variance)) < b


@settings(max_examples=40, deadline=None)
@given(ratio=st.floats(0.02, 1.5), classes=st.integers(1, 12))
def test_log_normal_keeps_number_and_surface(ratio, classes):
    mean, std = X, ratio * X
    found = sums(size_classes.log_normal(mean, std, classes))
    whole = 1.0 / raw_moment(3, mean, std), mass_moment(-1, mean, std)
    assert found == pytest.approx(whole, rel=1e-8)


def test_one_class_of_a_log_normal_is_itself():
    assert size_classes.log_normal(X, 0.3 * X, 1) == [(X, (0.3 * X) ** 2)]


def test_what_bounds_cut_away_is_what_the_law_has_beyond_them():
    """The mass above d is exp(-(d/X)^q): both ends and a quadrature of what is between add up to all of it."""
    exponent, least, most = 2.3, 0.4 * X, 1.7 * X
    below, above = size_classes.cut_away(X, exponent, least, most)
    ends = math.log((least / X) ** exponent), math.log((most / X) ** exponent)
    between = quad(lambda y: math.exp(y - math.exp(y)), *ends, epsabs=0.0, epsrel=1e-12)[0]
    assert below + between + above == pytest.approx(1.0, rel=1e-12)
    assert above == pytest.approx(math.exp(-(1.7**exponent)), rel=1e-14)
    assert size_classes.cut_away(X, exponent, least, math.inf)[1] == 0.0
