"""Exchange of two things within a step, how far they come together, and conduction between two particles.

In a step, a particle goes the fraction f of its way to the gas: v' = (1 - f) v + f v_g', with
lam = dt beta/(alpha_p rho_p) for momentum, dt eps/(alpha_p rho_p c_p) for heat (sdph notes, section 3).
"""

import math

from sdph.laws.compiled import law
from sdph.laws.constants import TINY

SHORT = 1e-8  # relaxation times in a step below which a function of them is its limit; our choice


@law
def exponential_fraction(lam):
    """f [-] = 1 - exp(-lam): exact while the gas stays as it is; accurate for tiny lam. lam >= 0 [-]."""
    return -math.expm1(-lam)


@law
def lead(lam):
    """Share [-] of a step by which drag is ahead of the velocity at its start: 1/f - 1/lam, from 1/2 on to 1.

    A particle that a [m/s2] pulls for dt [s] beside its drag is v' = v + f (v_g' - v) + a tau f after it, and so is one
    that gets a dt and the drag of v + a dt (1/f - 1/lam): with it a particle that drifts drifts by a tau. lam as above.
    """
    if lam < SHORT:
        return 0.5 + lam / 12.0
    return 1.0 / exponential_fraction(lam) - 1.0 / lam


@law
def harmonic_mean(a, b):
    """2 a b/(a + b) of two conductivities or viscosities: the flux between unlike particles is continuous; 0 if either
    is.

    Cleary & Monaghan 1999, J. Comput. Phys. 148, 227, doi 10.1006/jcph.1998.6118.
    """
    return 2.0 * a * b / max(a + b, TINY)


@law
def cleary_monaghan(pull, r_squared, eta_squared, conductivity, grain_density, density):
    """Coefficient C [W/(kg K)] <= 0 of dh_i/dt = sum_j C_ij (T_i - T_j): the hotter particle cools.

    C = 4 m_j/(rho_i rho_j) K_i K_j/(K_i + K_j) r.grad_i W/(r^2 + eta^2), where with K = alpha_p k and rho = alpha_p
    rho_p all but 2 k/rho_p over the mean of the densities [kg/m3] falls out. pull = m_j (dW/dr)/r [kg/m^(dims+2)],
    conductivity k [W/(m K)] and grain_density rho_p [kg/m3] of the grains, eta_squared [m2] (0.01 h^2 keeps coincident
    pairs finite). Cleary & Monaghan 1999 (as above); Chen et al. 2014, Eq. (19), with r_ij = r_j - r_i in its sign.
    """
    weight = pull * r_squared / (r_squared + eta_squared)
    return 2.0 * conductivity / grain_density * weight / density


@law
def cleary_monaghan_unlike(pull, r_squared, eta_squared, k_i, k_j, densities):
    """The same of grains of two materials: 4 m_j/(rho_i rho_j) K_i K_j/(K_i + K_j) r.grad_i W/(r^2 + eta^2), with K =
    alpha_p k [W/(m K)] of each and `densities` rho_i rho_j [kg2/m6]. Cleary & Monaghan 1999 (as above)."""
    return 2.0 * harmonic_mean(k_i, k_j) * pull * r_squared / (r_squared + eta_squared) / densities


@law
def mean_rise(power, conductance, capacity, dt):
    """Mean over dt [s] of the rise [K] of a body of `capacity` [J/K] heated with power - conductance * rise [W]."""
    if conductance * dt <= SHORT * capacity:
        return 0.5 * power * dt / capacity if capacity > 0.0 else 0.0
    x = conductance * dt / capacity
    return power / conductance * (1.0 + math.expm1(-x) / x)
