"""Lift on a sphere in sheared gas.

Every law has one signature, `law(slip, spin, diameter, gas_density, gas_viscosity)`, and returns L [kg/m3], so that
laws are interchangeable:

    F = L (v_g - v_p) x omega_g   [N per m3 of grain],   omega_g = curl v_g;   acceleration of a grain = F/rho_p

slip = |v_g - v_p| [m/s], spin = |omega_g| [1/s], diameter [m], gas_density [kg/m3], gas_viscosity [Pa s]. In a simple
shear G spin = |G|. A grain that lags behind the gas is pushed to where the gas is faster. Lone grains that do not
turn themselves.
"""

import math

from sdph.laws.compiled import law
from sdph.laws.constants import TINY
from sdph.laws.drag import particle_reynolds

SAFFMAN = 1.615  # 6.46/4, force over mu d s sqrt(Re_G): Saffman 1965, J. Fluid Mech. 22, 385; corrected 1968, 31, 624
WEAK = 0.3314  # Mei 1992: limit of the factor for large Re_p over sqrt(beta)
DECAY = 10.0  # Re_p over which it is reached (the same)
INERTIAL = 0.0524  # of the factor over sqrt(b Re_p) (the same)
INERTIAL_REYNOLDS = 40.0  # Re_p from which it holds (the same)


@law
def shear_reynolds(spin, diameter, gas_density, gas_viscosity):
    """Re_G = rho_g d^2 |omega|/mu_g [-]."""
    return gas_density * diameter * diameter * spin / gas_viscosity


@law
def mei_factor(reynolds, shear):
    """Lift over Saffman's [-], reynolds = Re_p, shear = Re_G, b = Re_G/(2 Re_p):

    (1 - 0.3314 sqrt b) exp(-Re_p/10) + 0.3314 sqrt b up to Re_p = 40, 0.0524 sqrt(b Re_p) beyond. It falls at 40, by
    14 % at b = 0.1. 0.005 < b < 0.4, Re_p < 100. At Re_p = 0 it is 1. Mei 1992, Int. J. Multiphase Flow 18, 145: a
    fit to Dandy & Dwyer 1990 and to Saffman's limit.
    """
    if reynolds > INERTIAL_REYNOLDS:
        return INERTIAL * math.sqrt(0.5 * shear)
    ratio = 0.5 * shear / max(reynolds, TINY)
    return math.exp(-reynolds / DECAY) - WEAK * math.sqrt(ratio) * math.expm1(-reynolds / DECAY)


@law
def saffman(slip, spin, diameter, gas_density, gas_viscosity):
    """L of F = 1.615 mu d s sqrt(Re_G) on a sphere. Re_p << sqrt(Re_G) << 1. Saffman 1965 and 1968."""
    return 6.0 * SAFFMAN / (math.pi * diameter) * math.sqrt(gas_density * gas_viscosity / max(spin, TINY))


@law
def saffman_mei(slip, spin, diameter, gas_density, gas_viscosity):
    """L of Saffman's force times Mei's factor of Re_p and Re_G; range as there."""
    reynolds = particle_reynolds(slip, diameter, gas_density, gas_viscosity)
    factor = mei_factor(reynolds, shear_reynolds(spin, diameter, gas_density, gas_viscosity))
    return factor * saffman(slip, spin, diameter, gas_density, gas_viscosity)
