"""Charged grains in an electric field.

A sphere that bears `surface_charge` sigma [C/m2] evenly over its surface is pushed by F = pi d^2 sigma E [N]. Grains
that a corona has charged as far as it can bear 3 eps_r/(eps_r + 2) eps_0 E (Pauthenier & Moreau-Hanot 1932, J. Phys.
Radium 3, 590). More than eps_0 3e6 V/m = 2.7e-5 C/m2 leaks away: from that field on air breaks down.
"""

from sdph.laws.compiled import law
from sdph.laws.constants import VACUUM_PERMITTIVITY


@law
def charge_per_mass(surface_charge, sauter_diameter, density):
    """q/m [C/kg] = 6 sigma/(rho_p d32) of spheres, with their Sauter mean diameter [m]: surface over volume is 6/d32.

    sigma [C/m2], of either sign; density [kg/m3]. Gauss 1813.
    """
    return 6.0 * surface_charge / (density * sauter_diameter)


@law
def slab_field(charge_density, width):
    """Field [V/m] at the faces of a slab, rho_q w/(2 eps_0), by its own charge: density [C/m3], width [m].

    Gauss 1813; nothing earthed nearby.
    """
    return 0.5 * charge_density * width / VACUUM_PERMITTIVITY
