"""Evaporation of droplets: what leaves the surface, and how the diameter follows.

Fluxes are positive outwards. From a mass flux G [kg/(m2 s)], for grains that are spheres of density rho_p:

    dm/dt = -pi d^2 G,   (dm/dt)/m = -6 G/(rho_p d),   d(d^2)/dt = -4 G d/rho_p = -`regression rate`.

Saturation laws have one signature, `law(temperature, p)`, p a tuple of floats named in each docstring.
Quoted as "Chen et al. 2014": Chen, Qiang & Gao, Acta Phys. Sin. 63, 230206 (equation numbers as printed there).
"""

import math

from sdph.laws.compiled import law
from sdph.laws.constants import GAS_CONSTANT


@law
def saturation_constant(temperature, p):
    """p_sat [Pa], whatever the temperature. p = (pressure [Pa],). Chen et al. 2014, table 3."""
    return p[0]


@law
def saturation_antoine(temperature, p):
    """p_sat [Pa] = 10^(A - B/(C + T)). p = (A [log10 Pa], B [K], C [K]), T in kelvin; in the range of its fit.

    Antoine 1888, C. R. Acad. Sci. 107, 681.
    """
    return 10.0 ** (p[0] - p[1] / (p[2] + temperature))


@law
def saturation_clausius_clapeyron(temperature, p):
    """p_sat [Pa] = p_0 exp(h W/R (1/T_0 - 1/T)). p = (p_0 [Pa], T_0 [K], latent heat h [J/kg], W [kg/kmol]).

    Clapeyron 1834, Clausius 1850, for constant h and an ideal vapour: not near the critical point.
    """
    return p[0] * math.exp(p[2] * p[3] / GAS_CONSTANT * (1.0 / p[1] - 1.0 / temperature))


@law
def boiling_temperature(pressure, p):
    """T [K] at which `saturation_clausius_clapeyron` reaches `pressure` [Pa]; p as there."""
    return 1.0 / (1.0 / p[1] - GAS_CONSTANT / (p[2] * p[3]) * math.log(pressure / p[0]))


@law
def vapour_concentration(pressure, temperature):
    """C [kmol/m3] = p/(R T), p the partial pressure [Pa]: p_sat, T_p at the surface, X p_op, T_g in the gas.

    Chen et al. 2014, Eqs. (9), (10).
    """
    return pressure / (GAS_CONSTANT * temperature)


@law
def vapour_mass_fraction(mole_fraction, molar_mass, gas_molar_mass):
    """Y [-] = X W/(X W + (1 - X) W_g). molar masses [kg/kmol] of vapour and of the rest of the gas."""
    vapour = mole_fraction * molar_mass
    return vapour / (vapour + (1.0 - mole_fraction) * gas_molar_mass)


@law
def vapour_mole_fraction(mass_fraction, molar_mass, gas_molar_mass):
    """X [-] = (Y/W)/(Y/W + (1 - Y)/W_g), inverse of `vapour_mass_fraction`."""
    vapour = mass_fraction / molar_mass
    return vapour / (vapour + (1.0 - mass_fraction) / gas_molar_mass)


@law
def mixture_molar_mass(mass_fraction, molar_mass, other_molar_mass):
    """W [kg/kmol] of a mixture = 1/(Y/W_1 + (1 - Y)/W_2)."""
    return 1.0 / (mass_fraction / molar_mass + (1.0 - mass_fraction) / other_molar_mass)


@law
def schmidt_number(gas_density, gas_viscosity, diffusivity):
    """Sc [-] = mu_g/(rho_g D). Chen et al. 2014, section 2.3."""
    return gas_viscosity / (gas_density * diffusivity)


@law
def sherwood_ranz_marshall(reynolds, schmidt):
    """Sh [-] = 2 + 0.6 Re_p^1/2 Sc^1/3, Re_p without alpha_g. A lone sphere, Re_p < 200 in the fit.

    Ranz & Marshall 1952, Chem. Eng. Prog. 48, 141 and 173; Chen et al. 2014, Eq. (11).
    """
    return 2.0 + 0.6 * math.sqrt(reynolds) * schmidt ** (1.0 / 3.0)


@law
def mass_transfer_coefficient(sherwood, diffusivity, diameter):
    """k_c [m/s] = Sh D/d."""
    return sherwood * diffusivity / diameter


@law
def molar_flux(transfer_coefficient, surface_concentration, gas_concentration):
    """N [kmol/(m2 s)] = k_c (C_s - C_g), and no condensation: 0 if C_s < C_g. Chen et al. 2014, Eq. (8)."""
    return transfer_coefficient * max(0.0, surface_concentration - gas_concentration)


@law
def spalding_number(surface_mass_fraction, gas_mass_fraction):
    """B_M [-] = (Y_s - Y_g)/(1 - Y_s), Y_s < 1 (below boiling). Spalding 1953, 4th Symp. (Int.) Combust., 847."""
    return (surface_mass_fraction - gas_mass_fraction) / (1.0 - surface_mass_fraction)


@law
def mass_flux_linear(transfer_coefficient, surface_concentration, gas_concentration, molar_mass):
    """G [kg/(m2 s)] = W N: slow evaporation, Y_s << 1. Chen et al. 2014, Eqs. (8), (12)."""
    return molar_mass * molar_flux(transfer_coefficient, surface_concentration, gas_concentration)


@law
def mass_flux_spalding(transfer_coefficient, gas_density, transfer_number):
    """G [kg/(m2 s)] = rho_g k_c ln(1 + B_M): with the Stefan flow of the vapour itself; 0 if B_M < 0.

    Spalding 1953; Fluent's "convection/diffusion controlled" law. Equals the linear law for B_M -> 0.
    """
    return gas_density * transfer_coefficient * math.log1p(max(0.0, transfer_number))


@law
def boiling_flux(heat_transfer_coefficient, gas_temperature, boiling_temperature, latent_heat):
    """G [kg/(m2 s)] = h (T_g - T_b)/h_fg, 0 if the gas is colder: all heat that comes in evaporates.

    h [W/(m2 K)], temperatures [K], latent_heat [J/kg]. Energy balance of a drop held at T_b.
    """
    return heat_transfer_coefficient * max(0.0, gas_temperature - boiling_temperature) / latent_heat


@law
def boiling_flux_spalding(
    heat_transfer_coefficient, gas_temperature, boiling_temperature, latent_heat, vapour_heat_capacity
):
    """G [kg/(m2 s)] = h/c_v ln(1 + c_v (T_g - T_b)/h_fg): as `boiling_flux`, with Stefan flow shielding the drop.

    Godsave 1953, 4th Symp. (Int.) Combust., 818; Fluent's boiling law. c_v [J/(kg K)] of the vapour.
    """
    transfer_number = vapour_heat_capacity * max(0.0, gas_temperature - boiling_temperature) / latent_heat
    return heat_transfer_coefficient / vapour_heat_capacity * math.log1p(transfer_number)


@law
def mass_rate(mass_flux, diameter):
    """dm/dt [kg/s] = -pi d^2 G of one sphere. Chen et al. 2014, Eq. (12)."""
    return -math.pi * diameter * diameter * mass_flux


@law
def relative_mass_rate(mass_flux, diameter, density):
    """(dm/dt)/m [1/s] = -6 G/(rho_p d) of one sphere, hence of an SPH particle of equal spheres."""
    return -6.0 * mass_flux / (density * diameter)


@law
def diameter_rate(mass_flux, density):
    """dd/dt [m/s] = -2 G/rho_p, for spheres and discs alike."""
    return -2.0 * mass_flux / density


@law
def regression_rate(mass_flux, diameter, density):
    """K [m2/s] = -d(d^2)/dt = 4 G d/rho_p: does not depend on d while Sh is constant (d^2 law)."""
    return 4.0 * mass_flux * diameter / density


@law
def d2_step(diameter, regression_rate, dt):
    """Diameter [m] after dt [s]: sqrt(max(0, d^2 - K dt)), exact for constant K, and exactly 0 once it is gone.

    Godsave 1953 and Spalding 1953 (d^2 law).
    """
    return math.sqrt(max(0.0, diameter * diameter - regression_rate * dt))
