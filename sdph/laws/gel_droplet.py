"""A gel droplet without a mesh: conduction feeds a saturated bubble, which inflates the shell around the gel.

Gel and shell lie in rings around the bubble; the gel keeps its volume. All is quiet but heat: pressure is the same all
through the gel. `dims` 2: a cylinder, by the metre; 3: a sphere. Qiang et al. 2017, Chin. J. Energ. Mater. 25, 372,
with the corrections of `real_gas`, `cavities` and `shells`.
"""

import math
from typing import NamedTuple

from sdph.laws import cavities, real_gas, shells
from sdph.laws.compiled import law

FIRST_OF_VOID = 1e-9  # of the void: the first step of a search for that of the end, which then doubles
DOUBLINGS = 40  # of it: up to 500 times the void
ROUNDS = 80  # of a root's search at most: each halves what encloses the root or does better
BALANCED = 1e-13  # of the heat that the bubble holds: roots are found to this


class Around(NamedTuple):
    """dims, pressure around the droplet [Pa], surface tension at the bubble [N/m], and K and G of the shell [Pa]."""

    dims: int
    ambient: float
    tension: float
    bulk: float
    shear: float


class Bubble(NamedTuple):
    """Mass [kg/m], [kg], void [m2], [m3] and temperature [K] of a saturated bubble."""

    mass: float
    void: float
    temperature: float


@law
def bubble_pressure(around, pressure, void):
    """Pressure [Pa], absolute, of the vapour: that around, what the shell bears, and surface tension."""
    radius = cavities.radius(void, around.dims)
    return around.ambient + pressure + cavities.capillary_pressure(around.tension, radius, around.dims)


@law
def growth_of(dims, void, gel, inner):
    """Growth g [m^dims] of the shell's inner face, at `inner` [m] unloaded, around a void and gel [m^dims]."""
    return void / cavities.measure(dims) + gel - inner**dims


@law
def _left_over(around, gel, v, edges, plastic, damage, dt, heat, bubble, void, before, after):
    """Heat [J] that a bubble of a void would take in dt [s] over what it gets."""
    growth = growth_of(around.dims, void, gel, edges[0])
    shell = shells.loaded(around.dims, edges, growth, plastic, damage, around.bulk, around.shear, dt, before, after)
    temperature = real_gas.saturation_temperature(v, bubble_pressure(around, shell, void))
    mass = real_gas.saturated_density(v, temperature) * void
    taken = cavities.heat_taken(v, mass - bubble.mass, mass, temperature - bubble.temperature)
    return taken - dt * (heat[0] - heat[1] * temperature)


@law
def inflated(around, gel, v, edges, plastic, damage, dt, heat, bubble, before, after):
    """Bubble after dt [s] of a heat [W] heat[0] - heat[1] T: the void at which its heat, mass and pressure agree.

    gel [m^dims]: its volume over `cavities.measure`; edges, before, after: of the shell (`shells.loaded`); `after`
    becomes the shell's at the end. A void of nan where none is found.
    """
    scale = BALANCED * (v.latent_heat * bubble.mass + dt * heat[1] * bubble.temperature)
    low = high = bubble.void
    below = above = _left_over(around, gel, v, edges, plastic, damage, dt, heat, bubble, low, before, after)
    sign, step = (1.0 if below < 0.0 else -1.0), FIRST_OF_VOID * bubble.void
    for _ in range(DOUBLINGS):
        if sign * above >= 0.0:
            break
        low, below = high, above
        high = low + step if sign > 0.0 else low / (1.0 + step / bubble.void)
        above = _left_over(around, gel, v, edges, plastic, damage, dt, heat, bubble, high, before, after)
        step *= 2.0
    else:
        return Bubble(bubble.mass, math.nan, bubble.temperature)
    void, left = high, above
    for _ in range(ROUNDS):
        if abs(left) <= scale:
            break
        void = (low * above - high * below) / (above - below)
        left = _left_over(around, gel, v, edges, plastic, damage, dt, heat, bubble, void, before, after)
        if sign * left < 0.0:
            low, below, above = void, left, 0.5 * above
        else:
            high, above, below = void, left, 0.5 * below
    if not abs(left) <= scale:
        return Bubble(bubble.mass, math.nan, bubble.temperature)
    return _filled(around, gel, v, edges, plastic, damage, dt, void, before, after)


@law
def _filled(around, gel, v, edges, plastic, damage, dt, void, before, after):
    """Bubble of a void, saturated under its shell."""
    growth = growth_of(around.dims, void, gel, edges[0])
    shell = shells.loaded(around.dims, edges, growth, plastic, damage, around.bulk, around.shear, dt, before, after)
    temperature = real_gas.saturation_temperature(v, bubble_pressure(around, shell, void))
    return Bubble(real_gas.saturated_density(v, temperature) * void, void, temperature)


@law
def resistance(dims, near, far, conductivity):
    """Heat resistance [K m/W], [K/W] between two radii [m]: ln(r2/r1)/(2 pi k) of a cylinder, (1/r1 - 1/r2)/(4 pi k)
    of a sphere. Fourier 1822."""
    if dims == 2:
        return math.log(far / near) / (2.0 * math.pi * conductivity)
    return (1.0 / near - 1.0 / far) / (4.0 * math.pi * conductivity)


@law
def conducted(dims, inner, volumes, conductivity, capacities, powers, dt, start, upper, free, unit):
    """Temperatures of rings after dt [s] of conduction: free (n,) [K] with the bubble at 0 K, and what each kelvin of
    it adds, unit (n,). Returns the conductance [W/K] between the bubble and the first ring.

    inner [m]: the bubble's radius; volumes (n,) [m^dims] over `cavities.measure`, capacities (n,) [J/K], powers (n,)
    [W], start (n,) [K], upper (n,) scratch. A ring's temperature is that of the radius that halves its volume; implicit
    Euler, Thomas' elimination from the bubble out and back.
    """
    count, first, before = len(volumes), 0.0, 0.0
    edge, last = inner**dims, inner
    for n in range(count):
        here = (edge + 0.5 * volumes[n]) ** (1.0 / dims)
        edge += volumes[n]
        inward = dt / (resistance(dims, last, here, conductivity) * capacities[n])
        if n == 0:
            first = inward * capacities[0] / dt
        outward = 0.0
        if n + 1 < count:
            beyond = (edge + 0.5 * volumes[n + 1]) ** (1.0 / dims)
            outward = dt / (resistance(dims, here, beyond, conductivity) * capacities[n])
        pivot = 1.0 + inward + outward - inward * before
        before, last, upper[n] = outward / pivot, here, outward / pivot
        known = start[n] + dt * powers[n] / capacities[n]
        free[n] = (known + (inward * free[n - 1] if n else 0.0)) / pivot
        unit[n] = (inward * unit[n - 1] if n else inward) / pivot
    for n in range(count - 2, -1, -1):
        free[n] += upper[n] * free[n + 1]
        unit[n] += upper[n] * unit[n + 1]
    return first


@law
def vented(around, v, opening, dt, heat, bubble, hottest):
    """Bubble after dt [s] behind an opening [m], [m2] in its torn shell, and the mass [kg/m], [kg] that left it.

    The void stays, as gel and shell are too slow to close it (our choice); it boils on by a heat [W] heat[0] - heat[1]
    T, and is no hotter than the gel, `hottest` [K].
    """
    low = real_gas.saturation_temperature(v, around.ambient)
    high = hottest if hottest > bubble.temperature else bubble.temperature
    for _ in range(ROUNDS):
        middle = 0.5 * (low + high)
        pressure = real_gas.saturation_pressure(v, middle)
        out = dt * opening * cavities.vent_flux(pressure, middle, around.ambient, v.molar_mass, v.heat_ratio)
        mass = real_gas.saturated_density(v, middle) * bubble.void
        taken = cavities.heat_taken(v, mass + out - bubble.mass, mass, middle - bubble.temperature)
        if taken < dt * (heat[0] - heat[1] * middle):
            low = middle
        else:
            high = middle
    mass = real_gas.saturated_density(v, low) * bubble.void
    boiled = cavities.boiled(v, dt * (heat[0] - heat[1] * low), mass, low - bubble.temperature)
    return Bubble(mass, bubble.void, low), bubble.mass + boiled - mass
