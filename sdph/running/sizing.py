"""Sizes of droplets or grains: D10 and D32 by their definition, Dv10, Dv50 and Dv90 by volume (ASTM E799; ISO 9276-2).

D10 is the mean diameter by number, D32 = sum d^3 / sum d^2 that of the surface (Sauter); a part of 10, 50, 90 % of the
volume is in drops smaller than Dv10, Dv50, Dv90. Within a particle drops are distributed as sdph.effects.gas.sizes has
them: its rule with steps so much finer, and the volume between two nodes evenly in ln d.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from sdph.effects.gas import sizes
from sdph.laws import grain_loss
from sdph.laws.compiled import serial
from sdph.methods.grains.history import carried

FINER = 8  # nodes for each of the rule of sizes: quantiles to 0.3 %, of equal drops to half a bin; our choice
LEAST, MOST, PER_DECADE = 1e-9, 10.0, 200  # diameters [m] that are told apart, by 1.2 %: from a molecule to a boulder
BINS = round(PER_DECADE * math.log10(MOST / LEAST))
SHARES = {"Dv10_m": 0.1, "Dv50_m": 0.5, "Dv90_m": 0.9}
NAMES = ("D10_m", "D32_m", *SHARES)


class Census(NamedTuple):
    """Sizes of N particles: number of drops, mean d [m], d^2 [m2] and d^3 [m3] of each (N,); volume [m3] by bins of ln
    d."""

    number: np.ndarray
    first: np.ndarray
    second: np.ndarray
    third: np.ndarray
    volume: np.ndarray


def told(case) -> bool:
    """True where a case has drops, or grains, whose sizes differ or change."""
    sprayed = bool({"evaporation", "break_up", "reaction"} & set(case.effects))
    return "diameter" in carried(case) and (sprayed or bool(sizes.kernel(case)))


def census(case, state) -> Census:
    """The drops of the particles of a state."""
    found = Census(*(np.zeros(len(state.x)) for _ in range(4)), np.zeros(BINS))
    tally(sizes.kernel(case), case.grains.density, state, *found)
    return found


def diameters(sums, volume) -> dict[str, float]:
    """All of NAMES from `sums` (4,) over the drops (number, d [m], d^2 [m2], d^3 [m3]) and their volume by bins; nan
    where there are none."""
    if not sums[0]:
        return dict.fromkeys(NAMES, math.nan)
    found = {"D10_m": float(sums[1] / sums[0]), "D32_m": float(sums[3] / sums[2])}
    below = np.concatenate(([0.0], np.cumsum(volume))) / volume.sum()
    edges = math.log(LEAST) + math.log(10.0) / PER_DECADE * np.arange(BINS + 1)
    return found | {name: math.exp(np.interp(share, below, edges)) for name, share in SHARES.items()}


def sums_of(found: Census) -> np.ndarray:
    """(4,) sums over all drops: number, d [m], d^2 [m2], d^3 [m3]."""
    return np.array([found.number.sum(), *(found.number @ mean for mean in found[1:4])])


def metrics(simulation) -> dict[str, float]:
    """NAMES of what is in the gas."""
    found = census(simulation.case, simulation.grains.inside)
    return diameters(sums_of(found), found.volume)


@serial
def tally(p, density, s, number, first, second, third, volume):
    """Fill a Census; `p` of the sizes, density [kg/m3]. What lies beyond LEAST and MOST counts as of them."""
    for i in range(len(s.x)):
        rho = s.grain_density[i] if len(s.grain_density) else density
        if len(p) == 0:
            d = s.diameter[i]
            first[i], second[i], third[i] = d, d * d, d * d * d
            volume[place(d)] += s.mass[i] / rho
        else:
            share(sizes.birth(p, s, i), s.mass[i] / rho, i, first, second, third, volume)
        number[i] = s.mass[i] / (rho * math.pi / 6.0 * third[i]) if third[i] > 0.0 else 0.0


@serial
def share(own, whole, i, first, second, third, volume):
    """Means of the drops of particle i, and its volume `whole` [m3] shared among the bins."""
    count = one = two = three = 0.0
    nodes = FINER * (sizes.CLASSES - 1) + 1
    for q in range(nodes):
        d, n = node(own, q)
        if d > 0.0:
            count, one, two, three = count + n, one + n * d, two + n * d * d, three + n * d * d * d
    if three == 0.0:
        return
    first[i], second[i], third[i] = one / count, two / count, three / count
    upper, amount = node(own, 0)
    amount *= upper**3
    volume[place(upper)] += 0.5 * whole * amount / three
    for q in range(1, nodes):
        lower, n = node(own, q)
        more = n * lower**3
        spread(whole * 0.5 * (amount + more) / three, lower, upper, volume)
        upper, amount = lower, more
    if upper > 0.0:
        volume[place(upper)] += 0.5 * whole * amount / three


@serial
def spread(amount, lower, upper, volume):
    """Put a volume [m3] evenly in ln d between two diameters [m]; all of it at the upper where the lower has gone."""
    high = position(upper)
    low = position(lower) if lower > 0.0 else high
    begin, end = int(low), int(high)
    if begin == end:
        volume[end] += amount
        return
    for b in range(begin, end + 1):
        volume[b] += amount * (min(high, b + 1.0) - max(low, float(b))) / (high - low)


@serial
def node(own, q):
    """Diameter now [m] and number (of one drop at birth) at node q, from the largest down: `sizes.by_number`, finer."""
    u = own.top - sizes.STEP / FINER * q
    z = own.cut + math.log1p(math.exp(-abs(u))) + max(u, 0.0)
    number = sizes.STEP / FINER / (1.0 + math.exp(-u)) * math.exp(-0.5 * z * z) / math.sqrt(2.0 * math.pi)
    square = math.exp(2.0 * (own.mean + own.std * z))
    if own.loss > 0.0:
        square = grain_loss.square_after(square, own.loss, own.ventilation)
    return math.sqrt(square), number


@serial
def position(d):
    """Place of a diameter [m] among the bins, as a number of them."""
    return min(max(0.0, PER_DECADE * math.log10(d / LEAST)), BINS - 1e-9)


@serial
def place(d):
    """Bin of a diameter [m]; of nothing the first."""
    return int(position(d)) if d > 0.0 else 0
