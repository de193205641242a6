"""Checks of beds in vessels of any shape."""

from types import SimpleNamespace

import numpy as np
import pytest

from sdph.study import beds


@pytest.mark.parametrize(("lowest", "ok"), [
    ((0.1, 0.1), True), ((-4e-4, 0.1), True), ((0.1, -6e-4), False), ((np.nan, 0.1), False), ((0.1, np.nan), False),
])  # fmt: skip
def test_a_grain_beyond_a_wall_or_nowhere_is_told(lowest, ok):
    """At the first output or a later one, of 10 mm between grains; the floor is at 0."""
    places = [np.array([[0.0, 0.5], [0.0, y]]) for y in lowest]
    case = SimpleNamespace(resolution=SimpleNamespace(spacing=0.01))
    clouds = {float(k): SimpleNamespace(points=own) for k, own in enumerate(places)}
    run = SimpleNamespace(case=case, metrics={"time_s": [0.0, 1.0]}, fields=lambda t: (t, clouds[t], None))
    assert beds.inside(run, lambda points: points[:, 1])["ok"] == ok
