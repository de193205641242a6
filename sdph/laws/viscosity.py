"""Artificial viscosity of SPH, which keeps particles from passing through each other."""

from sdph.laws.compiled import law
from sdph.laws.constants import SOFTENING, TINY


@law
def monaghan(approach, r_squared, h, sound_speed, density, alpha, beta):
    """Pi_ij [m5/(kg s2)] = (-alpha c mu + beta mu^2)/rho, mu = h v.r/(r^2 + 0.01 h^2), where v.r < 0, else 0.

    approach = v_ij.r_ij [m2/s], r_squared [m2], h [m], sound_speed and density the means of the pair [m/s, kg/m3],
    alpha, beta [-] (0.1, 0.2 in the paper). Force on i: -m_i m_j Pi_ij grad_i W. Monaghan 1992, Annu. Rev. Astron.
    Astrophys. 30, 543, section 4.1.
    """
    mu = h * min(approach, 0.0) / (r_squared + SOFTENING * h * h)
    return (beta * mu - alpha * sound_speed) * mu / density


@law
def espanol_revenga(dimensions, shear, bulk, r_squared, closing, scale):
    """Viscous force per mass of i by j: (along r_ij [1/s2], along v_ij [1/s]); shear mu and bulk lambda of the pair [Pa
    s].

    scale = m_j (dW/dr)/r / (rho_i rho_j); closing = v_ij.r_ij [m2/s]. In d dimensions, with
    P = 5/3 mu - lambda and Q = (d+2)(lambda + mu/3), its continuum is mu lap v + (lambda + mu/3) grad div v; it never
    gives energy. Espanol & Revenga 2003, Phys. Rev. E 67, 026705.
    """
    along = scale * (dimensions + 2.0) * (bulk + shear / 3.0) * closing / max(r_squared, TINY)
    return along, scale * (5.0 / 3.0 * shear - bulk)
