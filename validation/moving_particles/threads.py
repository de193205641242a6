"""A thread along a periodic axis: its gravest wave grows at the rate of Rayleigh and Plateau.

It begins as the growing wave of the exact flow, of the radius a (1 + e cos kz) and the potential I_0(kr) cos kz; e is
told by the Fourier component of the mass along the axis, and its rate over FOLD of its growth.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import scipy

from sdph.engine import state as particles
from sdph.laws.sheets import rayleigh_plateau
from sdph.study.compare import check

from . import free

RADIUS, LONG, REACHES = 5, 45, (3.1, 4.1)  # l0, l0: k a = 0.698
AMPLITUDES = (0.05, 0.2)  # of the radius: a quarter of a spacing, a spacing
BAR, FOLD = 0.15, 1.0  # issue 21; of 1/omega, our choice


def checks(folder: Path, *_, radius=RADIUS, long=LONG, reaches=REACHES, amplitudes=AMPLITUDES) -> list[dict]:
    k = 2.0 * math.pi * radius / long
    return [
        check(f"thread of {radius} l0, r_t = {t:g}, amplitude {e:g} a: growth over that of Rayleigh and Plateau",
              growth(radius, long, t, e) / rayleigh_plateau(k), 1.0, BAR)
        for t in reaches for e in amplitudes
    ]  # fmt: skip


def thread(radius: int, long: int, reach: float, amplitude: float):
    """A stepper of a thread that has begun to neck, its k [1/m] and time 1/omega [s]."""
    unit = free.SPACING
    a, length, middle = radius * unit, long * unit, 2.0 * radius * unit
    pool = {"shape": "box", "lower_m": [middle - a, middle - a, 0.0], "upper_m": [middle + a, middle + a, length]}
    stepper = free.body(pool, [2.0 * middle, 2.0 * middle, length], reach, periodic=(False, False, True))
    s = stepper.state
    stepper.take((s.x - middle) ** 2 + (s.y - middle) ** 2 < a * a)
    s, k = stepper.state, 2.0 * math.pi / length
    omega = rayleigh_plateau(k * a) * math.sqrt(free.SIGMA / (free.DENSITY * a**3))
    x, y, z = s.x - middle, s.y - middle, s.z.copy()
    r = np.hypot(x, y)
    outward = scipy.special.iv(1, k * r) / scipy.special.iv(1, k * a) * np.cos(k * z)
    along = -scipy.special.iv(0, k * r) / scipy.special.iv(1, k * a) * np.sin(k * z)
    for place, speed, way in ((s.x, s.u, outward * x / r), (s.y, s.v, outward * y / r), (s.z, s.w, along)):
        place += amplitude * a * way
        speed[:] = amplitude * a * omega * way
    stepper.neighbours.built = ()
    stepper._rebuild()
    return stepper, k, 1.0 / omega


def growth(radius: int, long: int, reach: float, amplitude: float) -> float:
    """Rate of the wave [sqrt(sigma/(rho a^3))]."""
    stepper, k, fold = thread(radius, long, reach, amplitude)

    def see(stepper):
        return (float(abs(np.exp(1j * k * particles.positions(stepper.state)[:, 2]).mean())),)

    time, wave = free.go(stepper, FOLD * fold, see).T
    rate = float(np.polyfit(time, np.log(wave), 1)[0])
    return rate * math.sqrt(free.DENSITY * (radius * free.SPACING) ** 3 / free.SIGMA)
