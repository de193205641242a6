"""Grain sizes within one SPH particle: the log-normal it was born with, less what evaporation or a reaction took from
every grain.

A grain of diameter d_0 at birth has d^2 = `square_after(d_0^2, loss, c)` now (sdph.laws.grain_loss), or one that burns
d = `diameter_after(d_0, loss, l, c, film)` (sdph.laws.burn_off): small grains vanish first, and no moments need
closing. Sums over the grains that are left are trapezoidal in a variable u,

    ln d_0 = m + s z,    z = z_cut + ln(1 + exp(u)),

which puts the points beyond the smallest grain that is left, dense just above it, where d grows like a root. For
smooth integrands that decay at both ends the rule converges exponentially (Trefethen & Weideman 2014, SIAM Rev. 56).
"""

from __future__ import annotations

import math
from typing import NamedTuple

from sdph.effects.around.sizes import spread
from sdph.effects.effect import OFF
from sdph.laws import burn_off, grain_loss, grain_sizes
from sdph.laws.compiled import serial

CLASSES = 16  # points of the rule: mass to 1e-6, mean diameter to 3e-4 (tests/effects/gas/test_sizes.py)
STEP = 1.0  # of u between them
TAIL = 5.0  # standard deviations of the mass distribution beyond which nothing is summed
FAR = 12.0  # standard deviations below the median where an untouched distribution starts
NARROW = 1e-6  # least standard deviation of ln d: equal grains among unequal ones


class Steady(NamedTuple):
    """Share of each grain that stays: all."""

    share: float = 1.0


class Sizes(NamedTuple):
    """Shrinking grains: 1 where they evaporate, 0 where they burn; 1.0 but for a reaction without a film."""

    shrinking: int
    film: float


class Birth(NamedTuple):
    """Size classes of one particle: mean and standard deviation of ln d_0, its loss [m2], ventilation c [m^-1/2],
    kinetic length l [m] (0 of droplets), film, z_cut, and u_top."""

    mean: float
    std: float
    loss: float
    ventilation: float
    kinetic: float
    film: float
    cut: float
    top: float


def kernel(case) -> tuple | Steady | Sizes:
    """The sizes for kernels; OFF where all grains are alike."""
    products = case.parameters.get("break_up")
    differ = "micro_explosion" in case.effects or (products is not None and products.products != "equal")
    differ = differ or any(grains.diameter_std > 0.0 for grains in case.kinds)
    differ = differ or any(spread(nozzle) for nozzle in case.nozzles.values())
    if not differ:
        return OFF
    if not {"evaporation", "reaction"}.intersection(case.effects):
        return Steady()
    own = case.parameters.get("reaction")
    return Sizes(int("evaporation" in case.effects), float(own is None or own.film))


@serial
def classes(p):
    """Number of size classes to sum over."""
    if len(p) == 0:
        return 1
    return CLASSES


@serial
def birth(p, s, i):
    """Quantities that give the size classes of particle i."""
    if len(p) == 0:
        return Birth(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    if len(p) == 1:
        return birth_of(s.diameter[i], s.diameter_variance[i], 0.0, 0.0)
    if len(s.lost_kinetic):
        lost = s.lost_still[i], s.lost_moving[i], s.lost_kinetic[i]
        return birth_of_burnt(s.born_diameter[i], s.born_variance[i], *lost, p.film)
    return birth_of(s.born_diameter[i], s.born_variance[i], s.lost_still[i], s.lost_moving[i])


@serial
def birth_of(diameter, variance, lost_still, lost_moving):
    """The same from mean [m] and variance [m2] at birth, and the integrals of a dt [m2] and of a c dt [m^(3/2)]."""
    return birth_of_burnt(diameter, variance, lost_still, lost_moving, 0.0, 1.0)


@serial
def birth_of_burnt(diameter, variance, lost_still, lost_moving, lost_kinetic, film):
    """The same of grains that burn, with the integral of a l dt [m3] too."""
    deviation = math.sqrt(variance)
    std = max(NARROW, grain_sizes.log_std(diameter, deviation))
    mean = grain_sizes.log_mean(diameter, deviation)
    ventilation = lost_moving / lost_still if lost_still > 0.0 else 0.0
    kinetic = lost_kinetic / lost_still if lost_still > 0.0 else 0.0
    cut = 3.0 * std - FAR
    if kinetic > 0.0:
        smallest = burn_off.diameter_of_scale(lost_still, kinetic, ventilation, film)
        cut = max(cut, (math.log(smallest) - mean) / std)
    elif lost_still > 0.0:
        smallest = grain_loss.square_of_scale(lost_still, ventilation)
        cut = max(cut, (0.5 * math.log(smallest) - mean) / std)
    reach = max(TAIL + 3.0 * std - cut, 2.0)
    top = reach + math.log(-math.expm1(-reach))
    return Birth(mean, std, lost_still, ventilation, kinetic, film, cut, top)


@serial
def by_number(own, q):
    """Diameter now [m] and number (of one grain at birth) of size class q."""
    u = own.top - STEP * q
    z = own.cut + math.log1p(math.exp(-abs(u))) + max(u, 0.0)
    share = STEP / (1.0 + math.exp(-u)) * math.exp(-0.5 * z * z) / math.sqrt(2.0 * math.pi)
    if own.kinetic > 0.0:
        d = math.exp(own.mean + own.std * z)
        return burn_off.diameter_after(d, own.loss, own.kinetic, own.ventilation, own.film), share
    square = math.exp(2.0 * (own.mean + own.std * z))
    if own.loss > 0.0:
        square = grain_loss.square_after(square, own.loss, own.ventilation)
    return math.sqrt(square), share


@serial
def grain(p, s, i, own, q):
    """Diameter [m] and mass (in a unit common to the classes of i) of size class q."""
    if len(p) == 0:
        return s.diameter[i], 1.0
    d, number = by_number(own, q)
    return d, number * d * d * d


@serial
def remaining(own):
    """Mass [m3 a grain at birth], number mean [m] and variance [m2] of the diameters of the grains that are left."""
    count = first = second = third = 0.0
    for q in range(CLASSES):
        d, number = by_number(own, q)
        if d > 0.0:
            count += number
            first += number * d
            second += number * d * d
            third += number * d * d * d
    if count == 0.0:
        return 0.0, 0.0, 0.0
    mean = first / count
    return third, mean, max(0.0, second / count - mean * mean)
