"""Nozzles of several sizes and of a rate that changes: mass, number and surface; words of bad input."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lognormal import raw_moment
from test_inflow import SLOT, case, drift

from sdph.effects.around import inflow, rates
from sdph.engine import state as particles
from sdph.engine.state import GRAIN
from sdph.laws import size_classes
from sdph.schema import CaseError

RATE = {key: value for key, value in SLOT.items() if key != "volume_fraction"}
ROSIN = {"sizes": "rosin_rammler", "size_parameter_mm": 1.0, "size_exponent": 2.5, "least_diameter_mm": 0.2}
ROWS = [[0.0, 0.0], [0.1, 80.0], [0.2, 20.0], [0.3, 20.0]]
DENSITY = 700.0  # kg/m3, of the grains of test_inflow


def moments(state):
    """Mass [kg], surface [m2] and number of all drops of a state."""
    own = list(zip(state.mass, state.diameter, np.sqrt(state.diameter_variance)))
    count = [m / (DENSITY * math.pi / 6.0 * raw_moment(3, d, std)) for m, d, std in own]
    surface = [n * math.pi * raw_moment(2, d, std) for n, (_, d, std) in zip(count, own)]
    return state.mass.sum(), sum(surface), sum(count)


@settings(max_examples=8, deadline=None)
@given(classes=st.integers(1, 7), exponent=st.floats(1.2, 5.0), until=st.floats(0.02, 0.2))
def test_drops_of_rosin_rammler_are_those_of_the_law(classes, exponent, until):
    """Mass that of the rate; surface and number over mass those of the distribution, whatever came in."""
    chosen = case(SLOT | ROSIN | {"size_exponent": exponent, "size_classes": classes})
    _, state = drift(chosen, until, 0.02)
    inside = particles.take(state, state.kind == GRAIN)
    mass, surface, count = moments(inside)
    assert abs(mass - 0.3 * DENSITY * 0.2 * 2.0 * until) <= 0.5 * 0.3 * DENSITY * 0.2 * 0.02 * (1.0 + 1e-9)
    ((mean, variance),) = size_classes.rosin_rammler(1e-3, exponent, 2e-4, math.inf, 1)
    one = mean, math.sqrt(variance)
    assert count == pytest.approx(mass / (DENSITY * math.pi / 6.0 * raw_moment(3, *one)), rel=1e-9)
    assert surface / count == pytest.approx(math.pi * raw_moment(2, *one), rel=1e-9)
    assert len(np.unique(inside.ident)) == len(inside.ident)


def test_each_size_is_a_particle_at_each_place():
    chosen = case(SLOT | {"sizes": "given", "diameters_mm": [0.5, 1.0], "shares": [1.0, 3.0]})
    _, state = drift(chosen, 0.1, 0.02)
    small, large = (particles.take(state, state.diameter == d) for d in (5e-4, 1e-3))
    assert len(small.x) == len(large.x) > 0
    order = [np.lexsort((own.y, own.x)) for own in (small, large)]
    np.testing.assert_array_equal(small.x[order[0]], large.x[order[1]])
    np.testing.assert_allclose(3.0 * small.mass, large.mass, rtol=1e-14)
    np.testing.assert_allclose(small.mass + large.mass, 0.3 * DENSITY * 0.02**2, rtol=1e-12)
    assert (state.density == 0.3 * DENSITY).all()


@settings(max_examples=12, deadline=None)
@given(st.lists(st.floats(0.5, 90.0), min_size=2, max_size=6), st.floats(0.02, 0.3))
def test_what_came_in_is_the_integral_of_the_rate(values, until):
    """To within half a layer at the largest rate, whatever the rows."""
    rows = [[0.3 * k / (len(values) - 1), rate] for k, rate in enumerate(values)]
    made, _ = drift(case(RATE | {"rates": rows}), until, 0.013)
    times, rate = np.array(rows).T
    fine = np.linspace(0.0, until, 20001)
    there = np.interp(fine, times, rate)
    truth = float((0.5 * (there[1:] + there[:-1]) * np.diff(fine)).sum())
    assert abs(made.mass - truth) <= 0.5 * max(values) * 0.02 / 2.0 + 1e-6 * truth


def test_layers_have_the_mass_that_passes_while_they_do():
    """Exact: the integral of the rate over all whole layers, from a start at which it is 0."""
    _, state = drift(case(RATE | {"rates": ROWS}), 0.2, 0.05)
    inside = state.mass[state.kind == GRAIN].sum()  # 20 layers of 10 ms
    assert inside == pytest.approx(4.0 + 5.0, rel=1e-12)
    assert (state.mass > 0.0).all()


def test_a_nozzle_pauses_between_two_rows_of_rate_0():
    """No particle comes of the layers between, those after it have the mass of the rate, and numbers go on."""
    rows = [[0.0, 40.0], [0.1, 40.0], [0.1001, 0.0], [0.2, 0.0], [0.2001, 40.0], [0.3, 40.0]]
    source, state = drift(case(RATE | {"rates": rows}), 0.3, 0.05)
    assert (state.mass > 0.0).all() and len(np.unique(state.ident)) == len(state.ident)
    assert source.mass == pytest.approx(8.0, rel=1e-9)  # 4 kg before the pause and 4 after it, less the ramps' halves
    born = 0.3 - state.x[state.kind == GRAIN] / 2.0  # [s] when each was in the mouth
    assert not ((born > 0.111) & (born < 0.199)).any() and (born > 0.2).any()


def test_before_and_after_the_rows_the_rate_stays():
    rows = ((1.0, 2.0), (2.0, 4.0))
    np.testing.assert_allclose(rates.passed(rows, np.array([0.0, 1.0, 1.5, 2.0, 3.0])), [-2.0, 0.0, 1.25, 3.0, 7.0])


@pytest.mark.parametrize(("nozzle", "told"), [
    (SLOT | {"sizes": "rosin_rammler"}, "size_parameter_mm is missing"),
    (SLOT | ROSIN | {"least_diameter_mm": 9.0}, "least_diameter_mm = 9; it must be below 4.373 mm"),
    (SLOT | ROSIN | {"most_diameter_mm": 0.1}, "must be below 0.1 mm"),
    (SLOT | ROSIN | {"diameter_std_mm": 0.1}, "diameter_std_mm is of sizes = 'log_normal'"),
    (SLOT | ROSIN | {"size_classes": 65}, "size_classes = 65; it must be 64 at most"),
    (SLOT | {"size_classes": 3}, "the grains are all alike"),
    (SLOT | {"sizes": "given"}, "diameters_mm = []; give 1 to 64 diameters above 0"),
    (SLOT | {"sizes": "given", "diameters_mm": [0.1, -0.2]}, "diameters above 0"),
    (SLOT | {"sizes": "given", "diameters_mm": [0.1, 0.2], "shares": [1.0]}, "for each of the 2 diameters"),
    (SLOT | {"sizes": "given", "diameters_mm": [0.1], "size_classes": 2}, "it must be 1, as each size given is one"),
    (SLOT | {"rates": ROWS}, "give either volume_fraction or rate_kg_s, or rates"),
    (RATE | {"rates": [[0.0, 1.0]]}, "give two at least"),
    (RATE | {"rates": [[0.0, 1.0], [0.2, -1.0]]}, "the rate 0 or more"),
    (RATE | {"rates": [0.0, 1.0]}, "a row is [time s, rate kg/s]"),
    (RATE | {"rates": [[0.0, 1.0], [0.2, 2.0]]}, "gives from 0 to 0.3 s; add rows"),
    (RATE | {"rates": [[0.0, 0.0], [0.3, 0.0]]}, "0 in all rows"),
])  # fmt: skip
def test_bad_input_is_told_in_one_line(nozzle, told):
    with pytest.raises(CaseError, match=r"nozzles\.one") as error:
        inflow.kernel(case(nozzle))
    assert told in str(error.value) and "\n" not in str(error.value)
