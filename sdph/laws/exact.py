"""Exact solutions of model problems that the laws and the coupled code are held against. Plain Python, not compiled.

Suffix g: gas, p (or d, dust): grains. Capacities are per volume of mixture, C = alpha rho c [J/(m3 K)]; rho_g, rho_d
in the dusty problems are per volume of mixture too, and K is the drag coefficient beta [kg/(m3 s)].
"""

from __future__ import annotations

import math
from collections.abc import Callable

import scipy

from sdph.laws import evaporation
from sdph.laws.constants import GAS_CONSTANT


def _root(function: Callable[[float], float], low: float, high: float) -> float:
    """Find where a function changes its sign, to round-off."""
    return scipy.optimize.brentq(function, low, high, xtol=1e-15, rtol=1e-15)


# --- heat ---------------------------------------------------------------------------------------------------------


def volumetric_heat_capacity(fraction: float, density: float, heat_capacity: float) -> float:
    """C [J/(m3 K)] = alpha rho c of one phase."""
    return fraction * density * heat_capacity


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


# --- momentum -----------------------------------------------------------------------------------------------------


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


# --- grains -------------------------------------------------------------------------------------------------------


# --- evaporation --------------------------------------------------------------------------------------------------


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


def spalding_wet_bulb(
    gas_temperature: float, hottest: float, mass_number: Callable[[float], float], exponent: float, heat: float
) -> float:
    """T [K] of a drop with Stefan flow in mass and heat: 1 + B_T = (1 + B_M)^phi, B_T = c_pv (T_g - T)/L.

    Sought in [hottest/2, hottest], below boiling. `mass_number(T)` is B_M, exponent phi = Sh rho_g D c_pv/(Nu k_g),
    heat L/c_pv [K]. m' = pi d Nu k_g/c_pv ln(1 + B_T). Spalding 1953, 4th Symp. (Int.) Combust., 847; Abramzon &
    Sirignano 1989, Int. J. Heat Mass Transfer 32, 1605, without F.
    """

    def more(T):  # vapour than heat
        return exponent * math.log1p(mass_number(T)) - math.log1p((gas_temperature - T) / heat)

    return _root(more, 0.5 * hottest, hottest)
