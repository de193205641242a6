"""Thickness of a sheet as its particles see it, and how fast waves grow on it."""

from __future__ import annotations

import math

from numba import prange

from sdph.engine.geometry import apart
from sdph.engine.rows import entry
from sdph.laws.compiled import inlined, parallel
from sdph.laws.sheets import fastest_wave, wave_growth


@inlined
def of_count(number, reach, volume):
    """Thickness h [m] of a sheet in which a sphere of radius R, `reach` [m], about a particle of it holds `number` of
    them, that one too, of `volume` [m3] each.

    The sphere holds pi (R^2 h - h^3/6) of a flat sheet, in the mean over where in it the particle is; turned round by
    one step of a fixed point.
    """
    first = number * volume / (math.pi * reach * reach)
    return first / (1.0 - first * first / (6.0 * reach * reach))


@parallel
def see(reach, volume, s, rows, box, thickness):
    """thickness (N,): h = n_A l0^3 [m] where each particle is, by those within `reach` [m] of it."""
    for i in prange(len(s.x)):
        number = 1.0
        for k in range(rows.number[i]):
            dx, dy, dz = apart(s, box, entry(rows, i, k), i)
            if dx * dx + dy * dy + dz * dz < reach * reach:
                number += 1.0
        thickness[i] = of_count(number, reach, volume)


@parallel
def swell(suction, s, thickness, rate, wave):
    """rate (N,) [1/s] by which the wave that suction of gas at rest makes grow fastest grows; its length (N,) [m]."""
    for i in prange(len(s.x)):
        half, speed = 0.5 * thickness[i], math.sqrt(s.u[i] ** 2 + s.v[i] ** 2 + s.w[i] ** 2)
        k = fastest_wave(half, speed, suction.gas_density, suction.tension)
        wave[i] = 2.0 * math.pi / k
        rate[i] = wave_growth(k, half, speed, suction.density, suction.gas_density, suction.tension)
