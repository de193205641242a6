"""Equations of a band of droplets that flies apart across gas that cannot follow: one dimension, apart from both codes.

Droplets are points of a fine lattice, gas has cells of half a millimetre, of which each cell of the codes is a
multiple, from the middle of the band to the outlet: vapour alone moves the gas. Closures are written anew here, in
numpy: Putnam's drag, Ranz & Marshall's heat and mass transfer, the linear law of evaporation, properties at the film
(2 T_p + T_g)/3.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

MOLAR = 8314.46261815324  # J/(kmol K), the molar gas constant (CODATA 2018)
CELL, EACH, STEP = 25e-3 / 48, 4, 5e-5  # m, droplets in a cell at the start, s: our choice; spreading.py halves them


class Code(NamedTuple):
    """Traits in which the codes differ: exponent with which the film's diffusivity goes with its temperature, the
    temperature [K] of the film at which it is the case's, and the vapour's diffusivity [m2/s] in the gas."""

    power: float
    film: float
    diffusivity: float


class Band(NamedTuple):
    """Half a band at a time: place (K,) [m] from its middle, speed (K,) [m/s], temperature (K,) [K], d^2 (K,) [m2] of
    the droplets; temperature (C,) [K] and mass fraction of vapour (C,) [-] of the gas."""

    place: np.ndarray
    speed: np.ndarray
    warm: np.ndarray
    square: np.ndarray
    hot: np.ndarray
    fraction: np.ndarray


def fly(case, code: Code, half: float, edge: float, alpha: float, times, fine: int = 1) -> list[Band]:
    """Bands at `times` [s]. At the start droplets fill `half` [m] with the volume fraction `alpha`, and their speed
    rises evenly from 0 in the middle to `edge` [m/s]; `fine` divides cells and steps. Heun's method."""
    cell, size = CELL / fine, 0.5 * case.domain.size[1]
    number, drops = round(size / cell), round(half * EACH / cell)
    place, each = (np.arange(drops) + 0.5) * half / drops, np.ones(drops)
    temperature = next(iter(case.particles.values())).temperature
    gas = np.ones(number)
    band = Band(
        place, edge * place / half, temperature * each, case.grains.diameter**2 * each,
        case.gas.temperature * gas, 0.0 * gas,
    )  # fmt: skip
    count = alpha * half / drops * 6.0 / (math.pi * case.grains.diameter**3)  # droplets of a point, by m2 of the band
    found, now = [], 0.0
    for end in times:
        steps = math.ceil((end - now) * fine / STEP * (1.0 - 1e-9))
        dt = (end - now) / steps
        for _ in range(steps):
            first = change(case, code, band, count, cell)
            second = change(case, code, Band(*(y + dt * r for y, r in zip(band, first))), count, cell)
            band = Band(*(y + 0.5 * dt * (a + b) for y, a, b in zip(band, first, second)))
        found, now = [*found, band], end
    return found


def change(case, code: Code, band: Band, count: float, cell: float) -> Band:
    """Rates of all of a band, whose points are `count` droplets each by m2, in cells of `cell` [m]."""
    gas, vapour, liquid, own = case.gas, case.vapour, case.grains, case.parameters["evaporation"]
    low, share = _between(band.place, cell, len(band.hot))
    hot, fraction = (low[1] * y[low[0]] + share[1] * y[share[0]] for y in (band.hot, band.fraction))
    through = np.zeros(len(band.hot) + 1)  # m/s, of the gas at the faces; filled below with what evaporates
    d, film = np.sqrt(band.square), (2.0 * band.warm + hot) / 3.0
    ratio = hot / film
    density, mu, k = gas.density * ratio, gas.viscosity / ratio, gas.conductivity / ratio
    diffusivity = vapour.diffusivity * (film / code.film) ** code.power
    mole = fraction / vapour.molar_mass / (fraction / vapour.molar_mass + (1.0 - fraction) / gas.molar_mass)
    force = (own.saturation_pressure - mole * gas.operating_pressure) / (MOLAR * film) * vapour.molar_mass
    rate = np.pi * d * diffusivity * force * (band.warm > own.onset_temperature)
    slip = band.speed
    for _ in range(3):  # less what the vapour moves the gas
        reynolds = density * np.abs(slip) * d / mu
        made = rate * (2.0 + 0.6 * np.sqrt(reynolds) * np.cbrt(mu / (density * diffusivity)))
        given = _deposit(low, share, count * made, len(band.hot)) / cell  # kg/(m3 s)
        through[1:] = np.cumsum(given) * cell / gas.density
        slip = band.speed - np.interp(band.place, cell * np.arange(len(through)), through)
    nusselt = 2.0 + 0.6 * np.sqrt(reynolds) * np.cbrt(mu * gas.heat_capacity / k)
    taken = np.pi * d * k * nusselt * (hot - band.warm)
    mass = np.pi / 6.0 * liquid.density * d**3
    drag = 18.0 * mu / (liquid.density * band.square) * (1.0 + reynolds ** (2.0 / 3.0) / 6.0)
    heat = _deposit(low, share, count * (-taken + made * vapour.heat_capacity * (band.warm - hot)), len(given)) / cell
    mixture = gas.density * (gas.heat_capacity + band.fraction * (vapour.heat_capacity - gas.heat_capacity))
    return Band(
        band.speed, -drag * slip, (taken - made * own.latent_heat) / (mass * liquid.heat_capacity),
        -4.0 * made / (np.pi * d * liquid.density),
        heat / mixture + _moved(band.hot, through, gas.conductivity / mixture, cell),
        given * (1.0 - band.fraction) / gas.density + _moved(band.fraction, through, code.diffusivity, cell),
    )  # fmt: skip


def _between(place, cell: float, number: int):
    """Cells on both sides of places (K,) [m] and the share of each: linear; the middle of the band is a mirror."""
    at = place / cell - 0.5
    low = np.floor(at).astype(int)
    share = at - low
    first, second = (np.clip(index, 0, number - 1) for index in (low, low + 1))
    return (first, 1.0 - share), (second, share)


def _deposit(low, high, amounts, number: int) -> np.ndarray:
    """Sums (C,) of amounts (K,) in the cells."""
    return sum(np.bincount(index, share * amounts, number) for index, share in (low, high))


def _moved(field, through, diffusivity, cell: float) -> np.ndarray:
    """Rate (C,) at which a field is carried outwards (upwind) and spreads; nothing passes the middle."""
    ends = np.concatenate((field[:1], field, field[-1:]))
    slope = np.diff(ends) / cell
    outwards = 0.5 * (through[1:] + through[:-1])
    return -outwards * slope[:-1] + diffusivity * np.diff(slope) / cell


def evaporated(case, band: Band) -> float:
    """Share of the liquid that evaporated [-]."""
    return float(1.0 - ((band.square / case.grains.diameter**2) ** 1.5).mean())


def width(place, mass) -> float:
    """Root mean square of places (N,) [m] from the middle, weighted by mass (N,)."""
    return math.sqrt(float((mass * place**2).sum() / mass.sum()))
