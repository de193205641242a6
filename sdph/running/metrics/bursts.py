"""Metrics of a spray of gel droplets: how many droplets there are, their Sauter diameter, how many shells are whole."""

from __future__ import annotations

import math

import numpy as np

from sdph.effects.gas import sizes
from sdph.laws.compiled import serial


def metrics(simulation) -> dict[str, float]:
    """droplets, sauter_diameter_m of all of them, whole_share by mass; nan of the last two where there are none."""
    state = simulation.grains.inside
    number, second, third = (np.empty(len(state.x)) for _ in range(3))
    moments(simulation.case.grains.density, state, number, second, third)
    mass, surface = float(state.mass.sum()), float(number @ second)
    return {
        "droplets": float(number.sum()),
        "sauter_diameter_m": float(number @ third) / surface if surface else math.nan,
        "whole_share": float(state.mass @ (state.sealed * (state.throwing == 0.0))) / mass if mass else math.nan,
    }


@serial
def moments(density, s, number, second, third):
    """Moments of each particle: number of droplets that are left (N,), their mean d^2 (N,) [m2] and d^3 (N,) [m3]."""
    for i in range(len(s.x)):
        own = sizes.birth_of(s.born_diameter[i], s.born_variance[i], s.lost_still[i], s.lost_moving[i])
        count = surface = volume = 0.0
        for q in range(sizes.CLASSES):
            d, share = sizes.by_number(own, q)
            if d > 0.0:
                count += share
                surface += share * d * d
                volume += share * d * d * d
        number[i] = count * s.mass[i] / (density * math.pi / 6.0 * volume)
        second[i], third[i] = surface / count, volume / count
