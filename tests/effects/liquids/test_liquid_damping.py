"""Damping of a liquid of any strength: no step turns a wave round, and explain names the limit."""

import itertools
import math

import numpy as np
import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.effects.liquids import liquid_damping
from sdph.engine.kernels import slope, smoothing
from sdph.laws.constants import SOFTENING
from sdph.study.explain import tables

STRONG = ("liquid_damping.alpha=20", "resolution.spacing_mm=5")


def decay(kernel: str, ratio: float, way: tuple[float, ...]) -> float:
    """Largest rate over alpha c/h at which waves along `way` decay on a lattice with h = `ratio` spacings."""
    d, reach = len(way), math.ceil(2.0 * ratio)
    places = np.stack(np.meshgrid(*d * [np.arange(-reach, reach + 1.0)]), axis=-1).reshape(-1, d)
    places = places[places.any(axis=1)]
    own, r2 = smoothing(kernel, d, ratio), (places**2).sum(axis=1)
    pulls = np.array([slope(own, each) for each in np.sqrt(r2)])
    phases = np.linspace(0.01, 1.0, 100)[:, None] * math.pi * (places @ np.array(way))
    weights = -pulls / (r2 + SOFTENING * ratio**2) * (1.0 - np.cos(phases))
    return np.linalg.eigvalsh(np.einsum("wn,na,nb->wab", weights, places, places))[:, -1].max() * ratio**2


@pytest.mark.parametrize("kernel", ["wendland_c2", "cubic_spline"])
@pytest.mark.parametrize("dimensions", [2, 3])
def test_a_step_takes_no_more_than_all_of_a_wave(kernel, dimensions):
    """For h of 1.2 to 2 spacings."""
    ways = [way for way in itertools.product((0.0, 1.0), repeat=dimensions) if any(way)]
    rates = [decay(kernel, ratio, way) for ratio in (1.2, 1.3, 1.5, 2.0) for way in ways]
    assert 0.5 < liquid_damping.STEP * max(rates) <= 1.0


def test_explain_names_it_where_it_is_strong():
    case = cases.load(scenes.HERE / "dam_break" / "case.toml", STRONG)
    rows = {row["cause"]: row for row in tables.explain(case)["limits"]}
    expected = 0.45 * case.smoothing_length / (20.0 * case.liquid.sound_speed)
    assert rows["liquid_damping"]["largest [s]"] == pytest.approx(expected) and rows["liquid_damping"]["rules"]
    weak = tables.explain(cases.load(scenes.HERE / "dam_break" / "case.toml", STRONG[1:]))["limits"]
    assert not {row["cause"]: row["rules"] for row in weak}["liquid_damping"]
