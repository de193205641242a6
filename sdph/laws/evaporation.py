"""Evaporation of droplets: what leaves the surface, and how the diameter follows.

What drives it is the mass flux over the mass-transfer coefficient, F = G/k_c [kg/m3], positive outwards, with
k_c = Sh D/d and Sh = 2 (1 + c sqrt(d)), c the `ventilation` of grain_loss.py. For spheres of density rho_p:

    dm/dt = -pi d^2 k_c F = -`gas_exchanged` F,   d(d^2)/dt = -4 Sh D F/rho_p = -`regression_rate` (1 + c sqrt(d)).

Saturation laws have one signature, `law(temperature, p)`, p a tuple of floats named in each docstring.
Quoted as "Chen et al. 2014": Chen, Qiang & Gao, Acta Phys. Sin. 63, 230206 (equation numbers as printed there).
"""

import math

from sdph.laws.compiled import law
from sdph.laws.constants import GAS_CONSTANT, TINY
from sdph.laws.exchange import SHORT


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


def antoine_through(temperatures, pressures):
    """A, B, C of log10(p/Pa) = A - B/(C + T/K) through three points, T [K] rising, p [Pa]."""
    (t1, t2, t3), (y1, y2, y3) = temperatures, (math.log10(p) for p in pressures)
    ratio = (y2 - y1) * (t3 - t2) / ((y3 - y2) * (t2 - t1))
    c = (t3 - ratio * t1) / (ratio - 1.0)
    b = (y2 - y1) * (c + t1) * (c + t2) / (t2 - t1)
    return y1 + b / (c + t1), b, c


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
def boiling_temperature_antoine(pressure, p):
    """T [K] at which `saturation_antoine` reaches `pressure` [Pa]; p as there."""
    return p[1] / (p[0] - math.log10(pressure)) - p[2]


@law
def vapour_concentration(pressure, temperature):
    """C [kmol/m3] = p/(R T), p the partial pressure [Pa]: p_sat, T_p at the surface, X p_op, T_g in the gas.

    Chen et al. 2014, Eqs. (9), (10).
    """
    return pressure / (GAS_CONSTANT * temperature)


@law
def partial_pressure(concentration, temperature):
    """p [Pa] = C R T, inverse of `vapour_concentration`; C [kmol/m3]."""
    return concentration * GAS_CONSTANT * temperature


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
def spalding_number(surface_mass_fraction, gas_mass_fraction):
    """B_M [-] = (Y_s - Y_g)/(1 - Y_s), Y_s < 1 (below boiling). Spalding 1953, 4th Symp. (Int.) Combust., 847."""
    return (surface_mass_fraction - gas_mass_fraction) / (1.0 - surface_mass_fraction)


@law
def driving_force_linear(surface_concentration, gas_concentration, molar_mass):
    """F [kg/m3] = W (C_s - C_g): slow evaporation, Y_s << 1; negative where vapour would condense.

    concentrations [kmol/m3]. Chen et al. 2014, Eqs. (8), (12).
    """
    return molar_mass * (surface_concentration - gas_concentration)


@law
def driving_force_spalding(surface_mass_fraction, gas_mass_fraction, gas_density):
    """F [kg/m3] = rho_g ln(1 + B_M): with the Stefan flow of the vapour itself; negative where it would condense.

    Spalding 1953; Fluent's "convection/diffusion controlled" law. Equals the linear law for B_M -> 0.
    """
    return gas_density * math.log1p(spalding_number(surface_mass_fraction, gas_mass_fraction))


@law
def heat_share(blown):
    """Share of its heat that reaches a drop against the vapour that flows off it: z/(exp(z) - 1) = ln(1 + B_T)/B_T [-].

    blown is z = m' c_pv/(h A) = ln(1 + B_T) [-]: m' [kg/s] the vapour, c_pv [J/(kg K)] its heat capacity, h A [W/K]
    the drop's conductance without it; in gas at rest z = m' c_pv/(2 pi d k_g). What is missing warms the vapour on its
    way from T_p to T_g. Exact for an even film of even properties: Spalding 1953, 4th Symp. (Int.)
    Combust., 847; Bird, Stewart & Lightfoot 2002, section 22.8; f_2 of Miller, Harstad & Bellan 1998, Int. J.
    Multiphase Flow 24, 1025.
    """
    z = blown + TINY  # the limit at 0 is 1
    return z / math.expm1(z)


@law
def gas_exchanged(volume, diameter, ventilation, diffusivity):
    """k_c A [m3/s] of spheres of `diameter` [m] and together of `volume` [m3]: 6 V k_c/d = 12 V (1 + c sqrt(d)) D/d^2.

    ventilation c [m^-1/2]. Chen et al. 2014, Eqs. (11), (12).
    """
    return volume * 12.0 * (1.0 + ventilation * math.sqrt(diameter)) * diffusivity / (diameter * diameter)


@law
def regression_rate(driving_force, diffusivity, density):
    """-d(d^2)/dt [m2/s] = 8 D F/rho_p of a sphere in still gas, Sh = 2, 0 where vapour would condense: d^2 law.

    Godsave 1953 and Spalding 1953, 4th Symp. (Int.) Combust., 818 and 847.
    """
    return 8.0 * diffusivity * max(0.0, driving_force) / density


@law
def boiling_force(
    temperature, gas_temperature, beside, boiling_temperature, conductance, capacity, latent_power, driving_force, dt
):
    """F [kg/m3] that holds the end of dt [s] at the boiling temperature [K]; `driving_force` if it stays below.

    A drop of `capacity` [J/K] takes conductance (T_g - T) + beside [W] and gives latent_power F; latent_power
    [W m3/kg].
    """
    if conductance * dt <= SHORT * capacity:
        stored = capacity / dt * (temperature - boiling_temperature)
        return max(driving_force, (conductance * (gas_temperature - temperature) + beside + stored) / latent_power)
    fraction = -math.expm1(-conductance * dt / capacity)
    cooling = latent_power * max(0.0, driving_force) / conductance
    pull = gas_temperature - temperature + beside / conductance
    end = temperature + (pull - cooling) * fraction
    if end <= boiling_temperature:
        return driving_force
    return conductance / latent_power * (pull - (boiling_temperature - temperature) / fraction)
