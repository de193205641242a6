"""Equations of state."""

from sdph.laws.compiled import law
from sdph.laws.constants import GAS_CONSTANT


@law
def tait_pressure(compression, stiffness, exponent, background):
    """p [Pa] = B [(rho/rho_0)^n - 1] + p_b, B = rho_0 c_0^2/n. n = 7 for water, 1: linear.

    compression rho/rho_0 [-], stiffness B [Pa] with the speed of sound c_0 at rho_0, background p_b [Pa]. The power 7
    is without `pow`, which costs more than a pair. Cole 1948, Underwater Explosions; Monaghan 1994, J. Comput. Phys.
    110, 399.
    """
    if exponent == 7.0:
        cubed = compression * compression * compression
        return stiffness * (cubed * cubed * compression - 1.0) + background
    return stiffness * (compression**exponent - 1.0) + background


@law
def tait_density(pressure, reference_density, sound_speed, exponent, background):
    """rho [kg/m3] = rho_0 (1 + (p - p_b)/B)^(1/n), inverse of `tait_pressure`; p > p_b - B."""
    stiffness = reference_density * sound_speed**2 / exponent
    return reference_density * (1.0 + (pressure - background) / stiffness) ** (1.0 / exponent)


@law
def ideal_gas_density(pressure, temperature, molar_mass):
    """rho [kg/m3] = p W/(R T). pressure [Pa], temperature [K], molar_mass [kg/kmol]."""
    return pressure * molar_mass / (GAS_CONSTANT * temperature)
