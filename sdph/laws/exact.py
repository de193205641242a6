"""Exact solutions of model problems that the laws and the coupled code are held against. Plain Python, not compiled.

Suffix g: gas, p (or d, dust): grains. Capacities are per volume of mixture, C = alpha rho c [J/(m3 K)]; rho_g, rho_d
in the dusty problems are per volume of mixture too, and K is the drag coefficient beta [kg/(m3 s)].
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from sdph.laws import evaporation, friction, granular
from sdph.laws.constants import GAS_CONSTANT


def _root(function: Callable[[float], float], low: float, high: float) -> float:
    """Where a function changes its sign, to round-off."""
    from scipy.optimize import brentq  # takes longer to import than a run needs to begin

    return brentq(function, low, high, xtol=1e-15, rtol=1e-15)


# --- heat ---------------------------------------------------------------------------------------------------------


def volumetric_heat_capacity(fraction: float, density: float, heat_capacity: float) -> float:
    """C [J/(m3 K)] = alpha rho c of one phase."""
    return fraction * density * heat_capacity


def thermal_diffusivity(conductivity: float, density: float, heat_capacity: float) -> float:
    """D [m2/s] = k/(rho c)."""
    return conductivity / (density * heat_capacity)


def equilibrium_temperature(T_p: float, T_g: float, C_p: float, C_g: float) -> float:
    """T [K] in the end, of capacities [any unit] that exchange heat with each other alone."""
    return (C_p * T_p + C_g * T_g) / (C_p + C_g)


def one_way_temperature(t: float, T_p: float, T_g: float, eps: float, C_p: float) -> float:
    """T_p(t) [K] in gas that stays at T_g; eps [W/(m3 K)]."""
    return T_p - (T_g - T_p) * math.expm1(-eps * t / C_p)


def exchange_rate(eps: float, C_p: float, C_g: float) -> float:
    """Rate [1/s] at which T_g - T_p decays (or v_g - v_p, with beta and alpha rho)."""
    return eps * (1.0 / C_p + 1.0 / C_g)


def two_way_rise(t: float, T_p: float, T_g: float, eps: float, C_p: float, C_g: float) -> float:
    """T_p(t) - T_p(0) [K], without cancellation, of grains and gas that exchange heat with each other alone."""
    return -(T_g - T_p) * C_g / (C_p + C_g) * math.expm1(-exchange_rate(eps, C_p, C_g) * t)


def two_way_temperatures(t: float, T_p: float, T_g: float, eps: float, C_p: float, C_g: float) -> tuple[float, float]:
    """T_p(t), T_g(t) [K] of the same: the lumped two-temperature disc."""
    rise = two_way_rise(t, T_p, T_g, eps, C_p, C_g)
    return T_p + rise, T_g - rise * C_p / C_g


def cosine_decay(t: float, wavenumber: float, diffusivity: float) -> float:
    """Amplitude [-] of cos(kx) after t under conduction alone: exp(-D k^2 t)."""
    return math.exp(-diffusivity * wavenumber**2 * t)


def mode_exchange(t, wavenumber, eps, C_p, C_g, D_p, D_g, start) -> np.ndarray:
    """Amplitudes (2,) [K] of cos(kx) in T_p and T_g at t, from `start` (2,), under conduction and exchange."""
    k2 = wavenumber**2
    rates = np.array([[-D_p * k2 - eps / C_p, eps / C_p], [eps / C_g, -D_g * k2 - eps / C_g]])
    from scipy.linalg import expm

    return expm(rates * t) @ np.asarray(start, dtype=float)


def stefan_front_coefficient(stefan_number: float) -> float:
    """lambda [-] of the melting front s = 2 lambda sqrt(D t): lambda exp(lambda^2) erf(lambda) = Ste/sqrt(pi)."""

    def excess(x):
        return x * math.exp(x * x) * math.erf(x) - stefan_number / math.sqrt(math.pi)

    return _root(excess, 0.0, 1.0 + math.sqrt(math.log1p(stefan_number)))


# --- momentum -----------------------------------------------------------------------------------------------------


def dusty_box(t: float, v_g: float, v_d: float, rho_g: float, rho_d: float, K: float) -> tuple[float, float]:
    """v_g(t), v_d(t) [m/s] under constant drag. Laibe & Price 2011, MNRAS 418, 1491 (DUSTYBOX)."""
    mean = (rho_g * v_g + rho_d * v_d) / (rho_g + rho_d)
    slip = (v_d - v_g) * math.exp(-exchange_rate(K, rho_d, rho_g) * t)
    return mean - rho_d / (rho_g + rho_d) * slip, mean + rho_g / (rho_g + rho_d) * slip


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


def dusty_wave(x, t, amplitude, wavenumber, c, rho_g, rho_d, K) -> np.ndarray:
    """[drho_g/rho_g, v_g, drho_d/rho_d, v_d] (4,) at x, t, all `amplitude` sin(kx) at first. Isothermal gas."""
    ik = 1j * wavenumber
    rates = np.zeros((4, 4), dtype=complex)
    rates[0, 1] = rates[2, 3] = -ik
    rates[1] = [-ik * c**2, -K / rho_g, 0.0, K / rho_g]
    rates[3] = [0.0, K / rho_d, 0.0, -K / rho_d]
    from scipy.linalg import expm

    return (expm(rates * t) @ np.full(4, amplitude + 0j) * np.exp(ik * x)).imag


def dusty_sound_speed(c: float, rho_g: float, rho_d: float) -> float:
    """Sound speed [m/s] of gas whose dust follows it at once: c/sqrt(1 + rho_d/rho_g)."""
    return c / math.sqrt(1.0 + rho_d / rho_g)


def ergun_gradient(alpha_p: float, velocity: float, diameter: float, gas_density: float, gas_viscosity: float) -> float:
    """dP/dL [Pa/m] of a packed column at superficial velocity U [m/s]. Ergun 1952, Chem. Eng. Prog. 48, 89."""
    viscous = 150.0 * alpha_p * gas_viscosity / diameter
    return (viscous + 1.75 * gas_density * velocity) * alpha_p * velocity / ((1.0 - alpha_p) ** 3 * diameter)


def buoyant_weight(alpha_p: float, density: float, gas_density: float, gravity: float) -> float:
    """dP/dL [Pa/m] that carries the grains: alpha_p (rho_p - rho_g) g."""
    return alpha_p * (density - gas_density) * gravity


def minimum_fluidisation(
    alpha_p: float, density: float, gravity: float, diameter: float, gas_density: float, gas_viscosity: float
) -> float:
    """U_mf [m/s], superficial: Ergun's gradient equals the buoyant weight (root of a quadratic)."""
    a = 1.75 * gas_density
    b = 150.0 * alpha_p * gas_viscosity / diameter
    c = (1.0 - alpha_p) ** 3 * diameter * buoyant_weight(1.0, density, gas_density, gravity)
    return 2.0 * c / (b + math.sqrt(b * b + 4.0 * a * c))


def fluidised_fraction(
    velocity: float, density: float, gravity: float, diameter: float, gas_density: float, gas_viscosity: float
) -> float:
    """alpha_p [-] of grains whose U_mf is `velocity` [m/s]: a bed there is just carried."""

    def excess(alpha_p):
        return minimum_fluidisation(alpha_p, density, gravity, diameter, gas_density, gas_viscosity) - velocity

    return _root(excess, 1e-6, 1.0 - 1e-6)


def wen_yu_minimum_fluidisation(
    density: float, gravity: float, diameter: float, gas_density: float, gas_viscosity: float
) -> float:
    """U_mf [m/s] = (sqrt(33.7^2 + 0.0408 Ar) - 33.7) mu_g/(rho_g d). Wen & Yu 1966, AIChE J. 12, 610."""
    archimedes = gas_density * (density - gas_density) * gravity * diameter**3 / gas_viscosity**2
    return (math.sqrt(33.7**2 + 0.0408 * archimedes) - 33.7) * gas_viscosity / (gas_density * diameter)


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
    return _root(excess, 0.0, upper)


def settling_slip_at(t, beta, alpha_p, density, gas_density, gravity) -> float:
    """Slip [m/s] at t of the same from rest, for constant beta [kg/(m3 s)]."""
    final = (1.0 - alpha_p) * buoyant_weight(alpha_p, density, gas_density, gravity) / beta
    return -final * math.expm1(-exchange_rate(beta, alpha_p * density, (1.0 - alpha_p) * gas_density) * t)


# --- grains -------------------------------------------------------------------------------------------------------


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


def slope_acceleration(slope: float, friction_angle: float, gravity: float) -> float:
    """Acceleration [m/s2] down a slope [rad] under Schaeffer friction, tau = p sin(phi): 0 up to `yield_slope`."""
    return max(0.0, gravity * (math.sin(slope) - math.sin(friction_angle) * math.cos(slope)))


def yield_slope(friction_angle: float) -> float:
    """Slope [rad] at which grains under Schaeffer friction start to move: atan(sin(phi))."""
    return math.atan(math.sin(friction_angle))


# --- evaporation --------------------------------------------------------------------------------------------------


def d2_law_life(diameter: float, regression_rate: float) -> float:
    """Time [s] until a drop is gone: d_0^2/K."""
    return diameter**2 / regression_rate


def d2_law_diameter(t: float, diameter: float, regression_rate: float) -> float:
    """d(t) [m] = sqrt(d_0^2 - K t), 0 once it is gone."""
    return evaporation.d2_step(diameter, regression_rate, t)


def stefan_tube_flux(pressure, diffusivity, temperature, length, surface_fraction, top_fraction) -> float:
    """N [kmol/(m2 s)] = p D/(R T L) ln((1 - X_L)/(1 - X_s)): vapour through still gas. Stefan 1874."""
    scale = pressure * diffusivity / (GAS_CONSTANT * temperature * length)
    return scale * (math.log1p(-top_fraction) - math.log1p(-surface_fraction))


def wet_bulb_temperature(
    gas_temperature: float,
    saturation: Callable[[float], float],
    diffusivity: float,
    molar_mass: float,
    latent_heat: float,
    gas_conductivity: float,
    sherwood_over_nusselt: float = 1.0,
) -> float:
    """T [K] < T_g at which a drop in dry gas neither heats nor cools: Nu k_g (T_g - T) = Sh D W h_fg p_sat(T)/(R T).

    `saturation(T)` [Pa]; the warmer of two roots (p_sat/T may fall with T), sought in [T_g/2, T_g].
    """
    scale = sherwood_over_nusselt * diffusivity * molar_mass * latent_heat / gas_conductivity

    def cooling(temperature):
        concentration = evaporation.vapour_concentration(saturation(temperature), temperature)
        return scale * concentration - (gas_temperature - temperature)

    if cooling(0.5 * gas_temperature) > 0.0:
        raise ValueError(f"no wet-bulb temperature above half of {gas_temperature} K: evaporation cools too strongly")
    return _root(cooling, 0.5 * gas_temperature, gas_temperature)
