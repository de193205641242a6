"""Drag between grains of two materials."""

import math

from sdph.laws.compiled import law


@law
def syamlal(restitution, friction, density_m, density_s, diameter_m, diameter_s, g0, slip):
    """beta_ms/(alpha_m alpha_s) [kg/(m3 s)], beta_ms (u_s - u_m) [N/m3] the force on m:

    3 (1 + e) (pi/2 + C_f pi^2/8) rho_m rho_s (d_m + d_s)^2 g0 |u_m - u_s| / (2 pi (rho_m d_m^3 + rho_s d_s^3)).

    Restitution e and Coulomb friction C_f of collisions [-], densities of the materials [kg/m3], diameters [m], g0 [-]
    at contact, slip [m/s] of their mean velocities. Spheres that meet because their means differ, not by agitation:
    slip well above sqrt(theta); collisions of two. Syamlal 1987, The particle-particle drag term in a multiparticle
    model of fluidization, DOE/MC/21353-2373; Syamlal, Rogers & O'Brien 1993, MFIX theory guide (DOE/METC-94/1004);
    Fluent's theory guide has it as "symmetric Syamlal-O'Brien".
    """
    rough = 3.0 * (1.0 + restitution) * (0.5 * math.pi + friction * math.pi**2 / 8.0)
    inertia = 2.0 * math.pi * (density_m * diameter_m**3 + density_s * diameter_s**3)
    return rough * density_m * density_s * (diameter_m + diameter_s) ** 2 * g0 * slip / inertia
