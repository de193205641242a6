"""Checkpoints: whatever is kept comes back, and only the last two stay."""

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from sdph.engine import restart
from sdph.engine import state as particles
from sdph.schema import CaseError


class Thing:
    KEPT = ("value", "inner", "chance")

    def __init__(self, value, inner=None):
        self.value, self.inner, self.chance = value, inner, np.random.default_rng(1)


FINITE = st.floats(allow_nan=False, allow_infinity=False)
NUMBERS = st.one_of(st.none(), st.booleans(), st.integers(-(2**63), 2**63 - 1), FINITE, st.text(max_size=5))
SHAPES = hnp.array_shapes(min_dims=1, max_dims=2, min_side=0, max_side=4)
ARRAYS = st.one_of(
    hnp.arrays(np.float64, SHAPES, elements=FINITE), *(hnp.arrays(dtype, SHAPES) for dtype in (np.int64, np.int8))
)
VALUES = st.recursive(
    st.one_of(NUMBERS, ARRAYS),
    lambda parts: st.one_of(
        st.lists(parts, max_size=3).map(tuple), st.dictionaries(st.text(max_size=4), parts, max_size=3)
    ),
    max_leaves=6,
)


def equal(a, b):
    if isinstance(a, np.ndarray):
        return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()
    if isinstance(a, dict):
        return list(a) == list(b) and all(equal(a[key], b[key]) for key in a)
    if isinstance(a, tuple):
        return type(a) is type(b) and len(a) == len(b) and all(equal(x, y) for x, y in zip(a, b))
    return type(a) is type(b) and repr(a) == repr(b)


def blank(value):
    """Something of the same form."""
    if isinstance(value, np.ndarray):
        return np.zeros_like(value)
    if isinstance(value, dict):
        return {key: blank(part) for key, part in value.items()}
    if isinstance(value, tuple):
        return tuple(map(blank, value))
    return value if value is None else type(value)()


class NoGas:
    def checkpoint(self, folder):
        folder.mkdir()


@given(VALUES)
@example({"\x00": np.zeros(0), "a/b": np.ones(2), "": np.ones(1)})
def test_whatever_is_kept_comes_back(tmp_path_factory, value):
    folder = tmp_path_factory.mktemp("run")
    before = Thing(value, Thing(particles.empty(3, ("temperature",))._replace(x=np.arange(3.0))))
    before.chance.random(5)
    restart.write(folder, 1, 0.0, {}, before, NoGas())
    after = Thing(blank(value), Thing(particles.empty(3, ("temperature",))))
    restart.newest(folder).fill(after)
    assert equal(after.value, value)
    assert isinstance(after.inner.value, particles.State)
    assert equal(tuple(after.inner.value), tuple(before.inner.value))
    assert after.chance.random() == before.chance.random()


def test_other_attributes_than_were_kept_are_refused(tmp_path):
    restart.write(tmp_path, 1, 0.0, {}, Thing(1.0), NoGas())

    class Other(Thing):
        KEPT = ("value", "new")
        new = 0

    with pytest.raises(CaseError, match="another version.*chance, inner, new"):
        restart.newest(tmp_path).fill(Other(1.0))


def test_only_the_last_two_checkpoints_stay(tmp_path):
    for number in range(5):
        restart.write(tmp_path, number, 0.0, {}, Thing(number), NoGas())
    assert sorted(path.name for path in (tmp_path / "checkpoints").iterdir()) == ["000000003", "000000004"]
