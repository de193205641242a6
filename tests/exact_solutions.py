"""Exact solutions that tests alone hold the code against; those of `sdph compare` and `sdph validate` stand in
`sdph.laws.exact`. Suffix g: gas, p (or d, dust): grains; K is the drag coefficient beta [kg/(m3 s)]."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from sdph.laws import friction, granular, kernels
from sdph.laws.exact import buoyant_weight, exchange_rate


def thermal_diffusivity(conductivity: float, density: float, heat_capacity: float) -> float:
    """D [m2/s] = k/(rho c)."""
    return conductivity / (density * heat_capacity)


def equilibrium_temperature(T_p: float, T_g: float, C_p: float, C_g: float) -> float:
    """T [K] in the end, of capacities [any unit] that exchange heat with each other alone."""
    return (C_p * T_p + C_g * T_g) / (C_p + C_g)


def cosine_decay(t: float, wavenumber: float, diffusivity: float) -> float:
    """Amplitude [-] of cos(kx) after t under conduction alone: exp(-D k^2 t)."""
    return math.exp(-diffusivity * wavenumber**2 * t)


def quadratic_slip(t: float, slip: float, linear: float, quadratic: float) -> float:
    """s(t) [m/s] of ds/dt = -(A + B s) s: the dusty box under Ergun's drag; A [1/s], B [1/m], either may be 0.

    1/s(t) = exp(A t)/s_0 + B (exp(A t) - 1)/A. Laibe & Price 2011 (DUSTYBOX, non-linear drag).
    """
    stretch = math.expm1(linear * t) / linear if linear > 0.0 else t
    return slip / (math.exp(linear * t) + quadratic * slip * stretch)


def dusty_wave_roots(wavenumber: float, c: float, rho_g: float, rho_d: float, K: float) -> np.ndarray:
    """The three s (3,) [1/s], by imaginary part, of sound exp(st + ikx) in dusty gas; c [m/s] of the gas alone.

    s^3 + s^2 K (1/rho_g + 1/rho_d) + k^2 c^2 s + k^2 c^2 K/rho_d = 0. Laibe & Price 2011 (DUSTYWAVE).
    """
    kc2 = (wavenumber * c) ** 2
    roots = np.roots([1.0, exchange_rate(K, rho_d, rho_g), kc2, kc2 * K / rho_d])
    return roots[np.argsort(roots.imag)]


def settling_slip(
    law: Callable,
    alpha_p: float,
    density: float,
    gravity: float,
    diameter: float,
    gas_density: float,
    gas_viscosity: float,
) -> float:
    """Slip [m/s] of uniform settling in a periodic box: beta s = alpha_p alpha_g (rho_p - rho_g) g; `law` of drag.py.

    alpha_p = 0: the terminal velocity of a lone grain.
    """
    force = (1.0 - alpha_p) * (density - gas_density) * gravity

    def excess(slip):
        return law(alpha_p, slip, diameter, gas_density, gas_viscosity) * slip - force

    upper = 1.0
    while excess(upper) < 0.0:
        upper *= 2.0
    return brentq(excess, 0.0, upper, xtol=1e-15, rtol=1e-15)


def settling_slip_at(t, beta, alpha_p, density, gas_density, gravity) -> float:
    """Slip [m/s] at t of the same from rest, for constant beta [kg/(m3 s)]."""
    final = (1.0 - alpha_p) * buoyant_weight(alpha_p, density, gas_density, gravity) / beta
    return -final * math.expm1(-exchange_rate(beta, alpha_p * density, (1.0 - alpha_p) * gas_density) * t)


def haff_cooling(t: float, theta: float, cooling: float) -> float:
    """theta(t) [m2/s2] = theta_0/(1 + K sqrt(theta_0) t/2)^2. Haff 1983, J. Fluid Mech. 134, 401."""
    return theta / (1.0 + 0.5 * cooling * math.sqrt(theta) * t) ** 2


def haff_cooling_with_drag(t: float, theta: float, cooling: float, damping: float) -> float:
    """theta(t) [m2/s2] = [(1/sqrt(theta_0) + K/B) exp(B t/2) - K/B]^-2, B > 0 [1/s]."""
    ratio = cooling / damping
    return ((1.0 / math.sqrt(theta) + ratio) * math.exp(0.5 * damping * t) - ratio) ** -2


class Shear(NamedTuple):
    """Steady uniform shear: granular temperature [m2/s2], shear stress and pressure [Pa]."""

    theta: float
    stress: float
    pressure: float


def uniform_shear(rate, alpha_p, restitution, g0, density, diameter) -> Shear:
    """Grains without gas in simple shear at `rate` [1/s]: mu rate^2 = gamma (Lun et al. 1984)."""
    invariant = friction.second_invariant(0.0, 0.0, 0.0, 0.5 * rate, 0.0, 0.0)
    theta = granular.equilibrium_theta(alpha_p, restitution, g0, density, diameter, invariant, 0.0, 0.0)
    stress = rate * granular.gidaspow_viscosity(alpha_p, theta, restitution, g0, density, diameter)
    return Shear(theta, stress, granular.lun_pressure(alpha_p, theta, restitution, g0, density))


def yield_slope(friction_angle: float) -> float:
    """Slope [rad] at which grains under Schaeffer friction start to move: atan(sin(phi))."""
    return math.atan(math.sin(friction_angle))


def slope_acceleration(slope: float, friction_angle: float, gravity: float) -> float:
    """Acceleration [m/s2] down a slope [rad] under Schaeffer friction, tau = p sin(phi): 0 up to `yield_slope`."""
    return max(0.0, gravity * (math.sin(slope) - math.sin(friction_angle) * math.cos(slope)))


def lattice_divergence_factor(kernel: str, dims: int, ratio: float) -> float:
    """-(1/dims) sum of dx^dims r.grad W [-] over the square or cubic lattice with h/dx = `ratio`: the discrete
    div(r)/dims, one for an exact kernel."""
    sigma, reach = kernels.normalisation(kernel, dims, ratio), math.ceil(kernels.SUPPORT * ratio)
    radii = [math.hypot(*point) for point in itertools.product(range(-reach, reach + 1), repeat=dims)]
    return -math.fsum(r * r * kernels.KERNELS[kernel].gradient(r, ratio, sigma) for r in radii) / dims
