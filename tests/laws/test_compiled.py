"""How functions are compiled: no way in from Python that Python does not use."""

from typing import NamedTuple

import numba
import numpy as np
import pytest

from sdph.laws import compiled


class Pair(NamedTuple):
    first: np.ndarray
    second: np.ndarray


@pytest.fixture(autouse=True)
def empty_cache(monkeypatch, tmp_path):
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))


@pytest.fixture
def pair():
    return Pair(np.array([1.0, 2.0, 3.0]), np.array([4.0, 5.0, 6.0]))


def test_a_function_that_a_loop_calls_has_a_way_in_once_python_calls_it(pair):
    product = compiled.serial(lambda pair, i: pair.first[i] * pair.second[i])
    total = compiled.serial(lambda pair: product(pair, 0) + product(pair, 2 * len(pair.second) - 4))
    assert total(pair) == 22.0
    assert product._entry is None and product.overloads
    assert product(pair, 1) == product(pair=pair, i=1) == 10.0


def test_options_reach_the_way_in_from_python():
    small, big = compiled.law(lambda x: 1.0 / x), compiled.fast_inlined(lambda x: x + 1.0)
    assert small(0.0) == np.inf  # IEEE division, or it raises
    assert big(1.0) == 2.0 and big._entry.targetoptions["fastmath"] == compiled.FAST
