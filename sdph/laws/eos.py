"""Equations of state."""

from sdph.laws.compiled import law
from sdph.laws.constants import GAS_CONSTANT


@law
def tait_pressure(density, reference_density, sound_speed, exponent, background):
    """p [Pa] = B [(rho/rho_0)^n - 1] + p_b, B = rho_0 c_0^2/n. n = 7 for water, 1: linear.

    densities [kg/m3], sound_speed c_0 [m/s] at rho_0, background p_b [Pa]. Cole 1948, Underwater Explosions;
    Monaghan 1994, J. Comput. Phys. 110, 399.
    """
    stiffness = reference_density * sound_speed**2 / exponent
    return stiffness * ((density / reference_density) ** exponent - 1.0) + background


@law
def tait_density(pressure, reference_density, sound_speed, exponent, background):
    """rho [kg/m3] = rho_0 (1 + (p - p_b)/B)^(1/n), inverse of `tait_pressure`; p > p_b - B."""
    stiffness = reference_density * sound_speed**2 / exponent
    return reference_density * (1.0 + (pressure - background) / stiffness) ** (1.0 / exponent)


@law
def tait_sound_speed(density, reference_density, sound_speed, exponent):
    """c [m/s] = c_0 (rho/rho_0)^((n-1)/2), sqrt(dp/drho) of `tait_pressure`."""
    return sound_speed * (density / reference_density) ** (0.5 * (exponent - 1.0))


@law
def ideal_gas_density(pressure, temperature, molar_mass):
    """rho [kg/m3] = p W/(R T). pressure [Pa], temperature [K], molar_mass [kg/kmol]."""
    return pressure * molar_mass / (GAS_CONSTANT * temperature)


@law
def ideal_gas_pressure(density, temperature, molar_mass):
    """p [Pa] = rho R T/W, inverse of `ideal_gas_density`."""
    return density * GAS_CONSTANT * temperature / molar_mass
