"""A gel droplet with one temperature that swells until its shell tears: `sdph.laws.gel_droplet` without rings of gel.

The droplet is a sphere: a bubble of saturated vapour in gel, a shell of one layer around it, with a flaw. Heat comes
into its rim and spreads as `bursting.lags` has it. Steps are implicit in the heat between gel and bubble, and as short
as the growth of shell and flaw asks for.
"""

import math
from typing import NamedTuple

import numpy as np

from sdph.laws import bursting, cavities, gel_droplet, real_gas, shells
from sdph.laws.compiled import law

SPHERE = 3  # dimensions
GROWTH = 5e-3  # of D/D_0 in a step; by convergence (validation/gel_spray/README.md)
SPOT_GROWTH, FAST, EAGER = (
    20.0,
    2.0,
    2.0,
)  # of GROWTH: hoop strain of the flaw, D/D_0; of a step: the next one; our choice
SHORTEST = 1e-6  # of the time asked for: a flaw that runs away in less has torn; our choice


class Droplet(NamedTuple):
    """One droplet at rest: first bubble's, shell's inner and outer radius [m], mass of that bubble [kg]; of its gel:
    density [kg/m3], conductivity [W/(m K)], heat capacity [J/K]; share by which the flaw is thinner."""

    first: float
    inner: float
    outer: float
    seed: float
    density: float
    conductivity: float
    capacity: float
    flaw: float


class Swollen(NamedTuple):
    """A droplet as it is: bubble, mean temperature of the gel [K], heat that the bubble has taken [J], hoop strain of
    the flaw."""

    bubble: gel_droplet.Bubble
    temperature: float
    taken: float
    hoop: float


@law
def radii(bubble, shell, diameter):
    """Radius of the first bubble, and of the shell's inner and outer face around it [m], of a droplet whose gel and
    shell fill `diameter` [m]; bubble and shell [-] are shares of that."""
    first = 0.5 * bubble * diameter
    outer = (0.125 * diameter**3 + first**3) ** (1.0 / 3.0)
    return first, outer - shell * diameter, outer


@law
def nucleus(v, around, first):
    """Temperature [K] of a saturated bubble of radius `first` [m] in a shell without load."""
    return real_gas.saturation_temperature(v, gel_droplet.bubble_pressure(around, 0.0, cavities.void(first, SPHERE)))


@law
def droplet(v, around, bubble, shell, diameter, density, heat_capacity, conductivity, flaw):
    """The `Droplet` of a diameter [m], of shares [-] and of a gel [kg/m3], [J/(kg K)], [W/(m K)]."""
    first, inner, outer = radii(bubble, shell, diameter)
    seed = real_gas.saturated_density(v, nucleus(v, around, first)) * cavities.void(first, SPHERE)
    capacity = density * heat_capacity * math.pi / 6.0 * diameter**3
    return Droplet(first, inner, outer, seed, density, conductivity, capacity, flaw)


@law
def faces(d, edges, void, mass, rows):
    """Gel [m3] over 4 pi/3, and radii [m] of the shell's faces, around a bubble of a void [m3] and a mass [kg]; rows
    (4, 1) of the shell."""
    gel = d.inner**SPHERE - d.first**SPHERE - (mass - d.seed) / (d.density * cavities.measure(SPHERE))
    growth = gel_droplet.growth_of(SPHERE, void, gel, d.inner)
    beyond = shells.outer_growth(SPHERE, edges, growth, rows)
    return gel, shells.grown(d.inner, growth, SPHERE), shells.grown(d.outer, beyond, SPHERE)


@law
def stretched(d, v, plastic, damage, around, span, bubble, inner, outer, hoop, spot):
    """Hoop strain of the flaw after `span` [s] under a bubble, between faces [m] of the shell; 0 without a flaw."""
    if d.flaw == 0.0:
        return 0.0
    pressure = real_gas.saturation_pressure(v, bubble.temperature)
    pressure -= gel_droplet.bubble_pressure(around, 0.0, bubble.void)
    pull, thickness = shells.tension(pressure, inner, outer, SPHERE), (1.0 - d.flaw) * (d.outer - d.inner)
    return shells.necked(
        SPHERE, thickness, pressure, pull, plastic, damage, around.bulk, around.shear, span, hoop, spot
    )


@law
def step(d, v, plastic, damage, around, edges, power, now, span, before, after, spot):
    """The droplet after `span` [s] of a power [W] into its rim, and by how much D/D_0 grew, inf where it outran the
    step; rows of the shell (4, 1) go from `before` to `after`, spot (4,) becomes that of the end."""
    gel, _, outside = faces(d, edges, now.bubble.void, now.bubble.mass, before)
    warming, boiling = bursting.lags(cavities.radius(now.bubble.void, SPHERE), outside, d.conductivity)
    conductance = 1.0 / (boiling - warming + span / d.capacity)
    free = conductance * (now.temperature + power * (span / d.capacity - warming))
    heat = (free, conductance)
    bubble = gel_droplet.inflated(around, gel, v, edges, plastic, damage, span, heat, now.bubble, before, after)
    if not bubble.void > 0.0:
        return now, math.inf
    _, within, beyond = faces(d, edges, bubble.void, bubble.mass, after)
    hoop = stretched(d, v, plastic, damage, around, span, bubble, within, beyond, now.hoop, spot)
    more, taken = abs(beyond - outside) / d.outer, span * (free - conductance * bubble.temperature)
    if not (abs(hoop - now.hoop) < SPOT_GROWTH * GROWTH and more < FAST * GROWTH):
        return now, math.inf
    temperature = now.temperature + (power * span - taken) / d.capacity
    return Swollen(bubble, temperature, now.taken + taken, hoop), more


@law
def wall(d, edges, bubble, rows):
    """Gel and shell [m] between a bubble and the outside; rows (4, 1) of the shell."""
    return faces(d, edges, bubble.void, bubble.mass, rows)[2] - cavities.radius(bubble.void, SPHERE)


@law
def swell(d, v, plastic, damage, around, power, now, time, shell, spot):
    """The droplet after a time [s] of a power [W] into its rim, or when it tears, and then its wall [m], else 0.

    shell (4, 1) and spot (4,) become those of the end. A bubble that condenses to less than the first one is gone: a
    void of 0 tells so.
    """
    edges, after, beside = np.array([d.inner, d.outer]), np.empty((4, 1)), np.empty(4)
    left, span, nothing = time, time, cavities.void(d.first, SPHERE)
    while left > 0.0:
        beside[:] = spot
        span = span if span < left else left
        new, more = step(d, v, plastic, damage, around, edges, power, now, span, shell, after, beside)
        if more == math.inf:
            span *= 0.5
            if span < SHORTEST * time:
                return now, wall(d, edges, now.bubble, shell)
            continue
        now, left = new, left - span
        shell[:], spot[:] = after, beside
        if shell[shells.HARM, 0] >= damage.critical or spot[shells.HARM] >= damage.critical:
            return now, wall(d, edges, now.bubble, shell)
        if now.bubble.void < nothing:
            return Swollen(gel_droplet.Bubble(0.0, 0.0, 0.0), now.temperature, now.taken, now.hoop), 0.0
        span *= EAGER if EAGER * more < GROWTH else GROWTH / more
    return now, 0.0
