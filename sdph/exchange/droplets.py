"""Evaporation of droplets in a window: what they lose, and what becomes of them.

Over a window the heat of evaporation L is held, so that heat exchange integrates in closed form (`exchange.py`). The
rate is that of the mean temperature in the window, from the linearised balance of heat with the gas as it is. By
Spalding's law the flow of the vapour holds back heat, and rate and heat are found together. Grains shrink exactly by
their law (sdph.laws.grain_loss). So a window may be longer than a droplet lives. `p` is the `EvaporationP` of
sdph.effects.gas.evaporation.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import prange

from sdph.effects.gas import sizes
from sdph.effects.gas.evaporation import driving_force, past_boiling, saturated, ventilation
from sdph.engine.state import GRAIN
from sdph.laws import evaporation as law
from sdph.laws import grain_loss
from sdph.laws.compiled import parallel, serial
from sdph.laws.exchange import mean_rise

COOLER = 1e-3  # K, step of the slope of the rate with temperature
FINISHED = 1e-9  # of the mass at birth, below which a particle has evaporated; our choice
# of the force, within which rate and heat are found together, and the steps that it may take; our choice
CLOSE, TRIES = 1e-12, 60


class Balance(NamedTuple):
    """Linearised balance of heat of a particle in a window of dt [s].

    Driving force `now` [kg/m3] and its slope [kg/m3/K] with the particle's temperature [K]; that of the gas; heat [W]
    that comes beside what the gas gives; conductance to the gas [W/K], of which vapour may hold back the part
    `hindered`; heat capacity [J/K]; heat that evaporation takes [W m3/kg], and z of `sdph.laws.evaporation.heat_share`
    [m3/kg], both over the force.
    """

    now: float
    slope: float
    temperature: float
    gas_temperature: float
    beside: float
    conductance: float
    hindered: float
    capacity: float
    latent: float
    blowing: float
    dt: float


@serial
def transfer(p, sizes_p, s, i, c):
    """k_c A of all grains [m3/s]: flow of gas that they exchange, the mass average over their sizes."""
    total = whole = 0.0
    own = sizes.birth(sizes_p, s, i)
    for q in range(sizes.classes(sizes_p)):
        d, mass = sizes.grain(sizes_p, s, i, own, q)
        if mass == 0.0:  # gone; what comes after is smaller still
            break
        total += law.gas_exchanged(mass, d, c, p.diffusivity)
        whole += mass
    return s.mass[i] / p.grain_density * total / whole


@serial
def kept_share(sizes_p, s, i, still, moving):
    """Share of its mass that particle i keeps when `still` = integral of a dt [m2], `moving` of a c dt [m^3/2] are
    lost."""
    if still <= 0.0:
        return 1.0
    if len(sizes_p) == 0:
        square = s.diameter[i] ** 2
        return (grain_loss.square_after(square, still, moving / still) / square) ** 1.5
    before = sizes.remaining(sizes.birth(sizes_p, s, i))[0]
    lost = s.lost_still[i] + still, s.lost_moving[i] + moving
    return sizes.remaining(sizes.birth_of(s.born_diameter[i], s.born_variance[i], *lost))[0] / before


@serial
def is_sealed(s, i):
    """True where a shell holds vapour in (sdph.effects.gas.micro_explosion)."""
    return len(s.sealed) > 0 and s.sealed[i] > 0.0


@serial
def active_time(p, s, i, conductance, gas_temperature, beside, dt):
    """Time [s] of the window in which particle i evaporates: from when it reaches the onset, as it warms up; beside [W]
    comes to it beside what the gas gives."""
    if is_sealed(s, i):
        return 0.0
    if s.temperature[i] >= p.onset_temperature or (p.onset == 0 and s.evaporating[i] > 0.0):
        return dt
    capacity = s.mass[i] * p.grain_heat_capacity
    if conductance == 0.0:
        return max(0.0, dt - capacity / beside * (p.onset_temperature - s.temperature[i])) if beside > 0.0 else 0.0
    goal = gas_temperature + beside / conductance
    if goal <= p.onset_temperature:
        return 0.0
    missing = (goal - s.temperature[i]) / (goal - p.onset_temperature)
    return max(0.0, dt - capacity / conductance * math.log(missing))


@parallel
def survey(p, sizes_p, s, slip, gas_density, gas_temperature, beside, dt, conductance, flow, surface):
    """Look, before the losses, at gas [m3/s] that the particle exchanges vapour with, averaged over the window, and
    vapour at its surface [kmol/m3]; conductance (N,) [W/K] of heat."""
    for i in prange(len(s.x)):
        flow[i] = surface[i] = 0.0
        if s.kind[i] == GRAIN:
            time = active_time(p, s, i, conductance[i], gas_temperature[i], beside[i], dt)
            flow[i] = transfer(p, sizes_p, s, i, ventilation(p, slip[i], gas_density[i])) * time / dt
            surface[i] = saturated(p, s.temperature[i], gas_temperature[i])


@parallel
def losses(
    p,
    sizes_p,
    s,
    slip,
    gas_density,
    gas_temperature,
    concentration,
    beside,
    dt,
    convection,
    conductance,
    loss,
    still,
    moving,
    refused,
    rest,
):
    """Losses of each particle in dt: mass lost [kg]; its integrals of a dt [m2], a c dt [m^3/2]; condensation refused
    [kg]; rest [kg] of a droplet that has finished, which is lost at once.

    `conductance` becomes the mean over the window: it shrinks with the grains as evaporation does, and of its part
    `convection` the vapour holds some back.
    """
    for i in prange(len(s.x)):
        loss[i] = still[i] = moving[i] = refused[i] = rest[i] = 0.0
        if s.kind[i] != GRAIN:
            continue
        time = active_time(p, s, i, conductance[i], gas_temperature[i], beside[i], dt)
        if time > 0.0:
            c = ventilation(p, slip[i], gas_density[i])
            rate = transfer(p, sizes_p, s, i, c)
            around = gas_density[i], gas_temperature[i], concentration[i], beside[i]
            balance = balance_of(p, sizes_p, s, i, rate, c, around, time, dt, convection[i], conductance[i])
            force = window_force(p, balance)
            refused[i] = max(0.0, -force) * rate * time
            still[i] = law.regression_rate(force, p.diffusivity, p.grain_density) * time
            moving[i] = c * still[i]
            left = s.mass[i] * kept_share(sizes_p, s, i, still[i], moving[i])
            rest[i] = 0.0 if left > FINISHED * s.born_mass[i] else left
            loss[i] = s.mass[i] - (left - rest[i])
            if force > 0.0:
                conductance[i] -= convection[i] * (time / dt) * held_back(balance, force)
                conductance[i] *= shrinkage(loss[i], rate * force * time)


@parallel
def rates(p, sizes_p, s, slip, gas_density, gas_temperature, concentration, rate):
    """rate (N,) [kg/s] at which each particle evaporates now."""
    for i in prange(len(s.x)):
        rate[i] = 0.0
        if s.kind[i] == GRAIN and active_time(p, s, i, 0.0, gas_temperature[i], 0.0, 1.0) > 0.0:
            force = driving_force(p, s.temperature[i], concentration[i], gas_temperature[i], gas_density[i])
            rate[i] = max(0.0, force) * transfer(p, sizes_p, s, i, ventilation(p, slip[i], gas_density[i]))


@serial
def shrinkage(loss, unshrunk):
    """Mean over the window of the grains' exchange over that at its start: what was lost over what the start would
    lose."""
    return min(1.0, loss / unshrunk)


@serial
def balance_of(p, sizes_p, s, i, rate, c, around, time, dt, convection, conductance):
    """Balance of heat of particle i, which evaporates for `time` of dt [s]; `around`: density [kg/m3], temperature [K]
    and vapour [kmol/m3] of the gas, and what comes beside it [W]."""
    gas_density, gas_temperature, concentration, beside = around
    temperature = s.temperature[i]
    now = driving_force(p, temperature, concentration, gas_temperature, gas_density)
    slope = max(0.0, slope_of(p, temperature, concentration, gas_temperature, gas_density, now))
    still = law.regression_rate(now, p.diffusivity, p.grain_density) * time
    kept = kept_share(sizes_p, s, i, still, c * still)
    share = shrinkage(s.mass[i] * (1.0 - kept), rate * now * time) if now > 0.0 else 1.0
    capacity = s.mass[i] * kept * p.grain_heat_capacity
    latent = p.latent_heat * rate * share * time / dt
    hindered = convection * share * (time / dt)
    blowing = p.blowing * rate / convection if convection > 0.0 else 0.0
    return Balance(
        now, slope, temperature, gas_temperature, beside, conductance * share, hindered, capacity, latent, blowing, dt
    )


@serial
def window_force(p, balance):
    """Driving force [kg/m3] at the mean temperature of the window; at boiling what the heat that comes in evaporates.

    Where vapour holds heat back the force is the one that lets in the heat that makes it. It lies between those of all
    heat and of none past the vapour (regula falsi, Illinois: Dowell & Jarratt 1971, BIT 11, 168).
    """
    high = force_by(p, balance, 0.0)
    if balance.blowing == 0.0 or high <= 0.0:
        return high
    low = force_by(p, balance, 1.0)
    off_low = low - force_by(p, balance, held_back(balance, low))
    off_high = high - force_by(p, balance, held_back(balance, high))
    for _ in range(TRIES):
        if abs(off_high) <= CLOSE * high or off_low == off_high:
            break
        middle = (low * off_high - high * off_low) / (off_high - off_low)
        off = middle - force_by(p, balance, held_back(balance, middle))
        if off * off_high < 0.0:
            low, off_low = high, off_high
        else:
            off_low *= 0.5
        high, off_high = middle, off
    return high


@serial
def held_back(balance, force):
    """Share of the heat that vapour of a driving force [kg/m3] holds back."""
    return 1.0 - law.heat_share(balance.blowing * max(0.0, force))


@serial
def force_by(p, balance, without):
    """Driving force [kg/m3] at the mean temperature of the window if vapour holds back the share `without`."""
    b = balance
    warmth = b.conductance - b.hindered * without
    power = warmth * (b.gas_temperature - b.temperature) + b.beside - b.latent * max(0.0, b.now)
    force = b.now + b.slope * mean_rise(power, warmth + b.latent * b.slope, b.capacity, b.dt)
    if b.latent == 0.0 or p.boiling_temperature == math.inf:
        return force
    held = law.boiling_force(
        b.temperature, b.gas_temperature, b.beside, p.boiling_temperature, warmth, b.capacity, b.latent, force, b.dt
    )
    return max(force, held)


@serial
def slope_of(p, temperature, concentration, gas_temperature, gas_density, now):
    """Slope [kg/m3/K] of the driving force, which is `now`, with the temperature of the droplet."""
    below = driving_force(p, temperature - COOLER, concentration, gas_temperature, gas_density)
    return (now - below) / COOLER


@parallel
def held(p, s, gas_density, gas_temperature, concentration, flat, boiling):
    """Mark (N,) the particles whose slope is held at 0, and those whose vapour at the surface is held below boiling."""
    for i in prange(len(s.x)):
        now = driving_force(p, s.temperature[i], concentration[i], gas_temperature[i], gas_density[i])
        flat[i] = slope_of(p, s.temperature[i], concentration[i], gas_temperature[i], gas_density[i], now) < 0.0
        boiling[i] = past_boiling(p, s.temperature[i]) and not is_sealed(s, i)


@parallel
def shrink(p, sizes_p, s, still, moving, latched, diameter, variance):
    """Sizes of each particle after its loss: latch, mean [m] and variance [m2] of the diameters left."""
    for i in prange(len(s.x)):
        latched[i] = max(s.evaporating[i], 1.0 * (still[i] > 0.0))
        if still[i] > 0.0:
            if len(sizes_p) == 0:
                square = grain_loss.square_after(s.diameter[i] ** 2, still[i], moving[i] / still[i])
                diameter[i], variance[i] = math.sqrt(square), 0.0
            else:
                lost = s.lost_still[i] + still[i], s.lost_moving[i] + moving[i]
                left = sizes.remaining(sizes.birth_of(s.born_diameter[i], s.born_variance[i], *lost))
                diameter[i], variance[i] = left[1], left[2]
        else:
            diameter[i], variance[i] = s.diameter[i], s.diameter_variance[i]


def apply(p, sizes_p, s, loss, still, moving) -> None:
    """Take the losses from the state."""
    latched, diameter, variance = (np.empty(len(s.x)) for _ in range(3))
    shrink(p, sizes_p, s, still, moving, latched, diameter, variance)
    s.mass[:] -= loss
    s.lost_still[:] += still
    s.lost_moving[:] += moving
    s.evaporating[:], s.diameter[:], s.diameter_variance[:] = latched, diameter, variance
