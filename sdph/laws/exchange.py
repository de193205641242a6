"""How far two things that exchange come together within a step, and conduction between two particles.

In a step, a particle goes the fraction f of its way to the gas: v' = (1 - f) v + f v_g', with
lam = dt beta/(alpha_p rho_p) for momentum, dt eps/(alpha_p rho_p c_p) for heat (sdph notes, section 3).
"""

import math

from sdph.laws.compiled import law
from sdph.laws.constants import TINY


@law
def backward_euler_fraction(lam):
    """f [-] = lam/(1 + lam): first order in time, stiffly damped. lam >= 0 [-]."""
    return lam / (1.0 + lam)


@law
def exponential_fraction(lam):
    """f [-] = 1 - exp(-lam): exact while the gas stays as it is; accurate for tiny lam. lam >= 0 [-]."""
    return -math.expm1(-lam)


@law
def harmonic_conductivity(conductivity_i, conductivity_j):
    """2 K_i K_j/(K_i + K_j) [W/(m K)]: the flux between unlike particles is continuous; 0 if either insulates.

    Cleary & Monaghan 1999, J. Comput. Phys. 148, 227, doi 10.1006/jcph.1998.6118.
    """
    return 2.0 * conductivity_i * conductivity_j / max(conductivity_i + conductivity_j, TINY)


@law
def cleary_monaghan(mass_j, density_i, density_j, conductivity_i, conductivity_j, r_squared, gradient, eta_squared):
    """Coefficient C [W/(kg K)] <= 0 of dh_i/dt = sum_j C_ij (T_i - T_j): the hotter particle cools.

    C = 4 m_j/(rho_i rho_j) K_i K_j/(K_i + K_j) r.grad_i W/(r^2 + eta^2), with r.grad_i W = r^2 * `gradient`.
    mass [kg or kg/m], density = SPH density alpha_p rho_p [kg/m3], conductivity = alpha_p k_p [W/(m K)],
    gradient = (dW/dr)/r [1/m^(dims+2)], eta_squared [m2] (0.01 h^2 keeps coincident pairs finite).
    Cleary & Monaghan 1999 (as above); Chen et al. 2014, Eq. (19), whose sign belongs to r_ij = r_j - r_i.
    """
    weight = 2.0 * mass_j / (density_i * density_j) * gradient * r_squared / (r_squared + eta_squared)
    return weight * harmonic_conductivity(conductivity_i, conductivity_j)
