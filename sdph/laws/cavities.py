"""Bubbles of saturated vapour as points without inside: mass, void, heat that boils or condenses, vent.

A bubble of mass m [kg] and void A is saturated: rho_v(p_sat(T), T) = m/A gives its temperature T and pressure. Heat Q
that conduction brings boils L dm = Q - m c_sat dT: no more than the heat bears (heat-limited), and what it lacks
condenses. `dims` 2: a cylinder, by the metre (A [m2], m [kg/m]); 3: a sphere. `v` is a `real_gas.Vapour`.

Qiang et al. 2017 print no source of vapour; their bubble has a fixed mass, which cannot fill 1.4 times the diameter.
"""

import math

from sdph.laws import real_gas
from sdph.laws.compiled import law
from sdph.laws.constants import GAS_CONSTANT

NEAR = 1e-14  # of a temperature: it is found to this


@law
def measure(dims):
    """c of A = c R^dims: pi of a cylinder, 4 pi/3 of a sphere."""
    return math.pi if dims == 2 else 4.0 / 3.0 * math.pi


@law
def void(radius, dims):
    """A [m2], [m3] of a bubble of radius R [m]."""
    return measure(dims) * radius**dims


@law
def radius(void, dims):
    """R [m] of a bubble of void A [m2], [m3]."""
    return (void / measure(dims)) ** (1.0 / dims)


@law
def capillary_pressure(tension, radius, dims):
    """Pressure [Pa] that surface tension [N/m] adds inside: sigma/R of a cylinder, 2 sigma/R of a sphere. Laplace
    1806."""
    return (dims - 1) * tension / radius


@law
def boiled(v, heat, mass, warming):
    """Mass [kg] that a heat [J] boils in a bubble of `mass` that warms by `warming` [K]; negative: it condenses.

    dm = (Q - m c_sat dT)/L.
    """
    return (heat - mass * v.heat_capacity * warming) / v.latent_heat


@law
def heat_taken(v, gained, mass, warming):
    """Heat [J] that a bubble takes which gains a mass [kg] and warms [K]: L dm + m c_sat dT, the reverse of
    `boiled`."""
    return v.latent_heat * gained + mass * v.heat_capacity * warming


@law
def temperature_of(v, density, low, high):
    """T [K] between low and high at which the saturated vapour has a density [kg/m3]; it rises with T. Bisection."""
    while high - low > NEAR * high:
        middle = 0.5 * (low + high)
        if real_gas.saturated_density(v, middle) < density:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


@law
def merged(v, masses, voids, temperatures):
    """Temperature [K] of two bubbles in one, and the mass [kg] that the heat left over boils.

    Masses and voids add up, the one bubble is saturated, and heat is kept: what cooling to the common temperature sets
    free boils (our reading of "add m, keep heat").
    """
    mass, density = masses[0] + masses[1], (masses[0] + masses[1]) / (voids[0] + voids[1])
    common = temperature_of(v, density, min(temperatures), max(temperatures))
    mean = (masses[0] * temperatures[0] + masses[1] * temperatures[1]) / mass
    return common, boiled(v, 0.0, mass, common - mean)


@law
def critical_ratio(heat_ratio):
    """Pressure outside over inside [-] below which a vent is choked: (2/(gamma + 1))^(gamma/(gamma - 1)).

    Saint-Venant & Wantzel 1839, J. Ec. polytech. 27, 85.
    """
    return (2.0 / (heat_ratio + 1.0)) ** (heat_ratio / (heat_ratio - 1.0))


@law
def vent_flux(pressure, temperature, outside, molar_mass, heat_ratio):
    """Flux G [kg/(m2 s)] of an ideal gas through an opening, from absolute p [Pa] and T [K] to `outside` [Pa].

    Choked: G = p sqrt(gamma W/(R T)) (2/(gamma + 1))^((gamma + 1)/(2 (gamma - 1))); else
    G = p sqrt(2 gamma W/((gamma - 1) R T)) sqrt(x^(2/gamma) - x^((gamma + 1)/gamma)), x = outside/p; 0 from outside in.
    Saint-Venant & Wantzel 1839; Shapiro 1953, Compressible Fluid Flow 1, ch. 4. Coefficient of discharge 1.
    """
    if pressure <= outside:
        return 0.0
    g, x = heat_ratio, outside / pressure
    density = molar_mass / (GAS_CONSTANT * temperature)
    if x <= critical_ratio(g):
        return pressure * math.sqrt(g * density) * (2.0 / (g + 1.0)) ** ((g + 1.0) / (2.0 * (g - 1.0)))
    return pressure * math.sqrt(2.0 * g / (g - 1.0) * density * (x ** (2.0 / g) - x ** ((g + 1.0) / g)))
