"""Height of a liquid's free surface over a place: a wave gauge."""

from __future__ import annotations

import numpy as np

from sdph.engine import kernels as smoothing
from sdph.engine import state as particles
from sdph.laws.kernels import SUPPORT

FIELD = "level"  # of a probe
LOOKED_AT = 0.25  # of the spacing, between places of a line that are looked at; our choice
EDGE = 0.5  # of the largest share of liquid along the line, at its surface


def of(case, cloud, at, world) -> float:
    """Height [m], along the axis of gravity (the last one without), up to which liquid reaches over and under a place
    `at` (d,) [m]: the highest where sum V W is half of the largest on that line; of a gas beside it not. Each process
    of a world has a cloud (pyvista) of particles; nan without any near."""
    wet = np.flatnonzero(np.asarray(cloud["kind"]) == particles.LIQUID) if cloud.n_points else np.zeros(0, int)
    places = np.asarray(cloud.points)[wet]
    volumes = np.asarray(cloud["mass"])[wet] / np.asarray(cloud["density"])[wet] if len(wet) else np.zeros(0)
    d, up = case.dimensions, _up(case)
    axis = int(np.abs(up).argmax())
    low, high = case.domain.corner[axis], case.domain.upper[axis]
    heights = np.linspace(low, high, 1 + round((high - low) / (LOOKED_AT * case.resolution.spacing)))[:: int(up[axis])]
    kernel = smoothing.smoothing(case.liquid.kernel, d, case.smoothing_length)
    aside = places[:, :d] - np.array(at)
    aside[:, axis] = 0.0
    near = particles.lengths(aside) < SUPPORT * case.smoothing_length
    share = np.zeros(len(heights))
    for place, off, volume in zip(places[near, axis], particles.lengths(aside[near]), volumes[near]):
        reach = np.flatnonzero(np.abs(heights - place) < SUPPORT * case.smoothing_length)
        r = np.hypot(heights[reach] - place, off)
        share[reach] += volume * np.array([smoothing.value.py_func(kernel, one) for one in r])
    share = world.sum(share)
    edge = EDGE * share.max()
    if not edge:
        return float("nan")
    top = int(np.flatnonzero(share >= edge)[-1])
    if top + 1 == len(heights):
        return float(heights[top])
    part = (share[top] - edge) / (share[top] - share[top + 1])
    return float(heights[top] + part * (heights[top + 1] - heights[top]))


def _up(case) -> np.ndarray:
    """(d,) 1 or -1 along the axis that is most against gravity, else 0."""
    gravity = np.array(case.domain.gravity) * ("gravity" in case.effects)
    found = np.zeros(case.dimensions)
    axis = int(np.abs(gravity).argmax()) if gravity.any() else case.dimensions - 1
    found[axis] = -1.0 if gravity[axis] > 0.0 else 1.0
    return found
