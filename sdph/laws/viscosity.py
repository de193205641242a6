"""Artificial viscosity of SPH, which keeps particles from passing through each other."""

from sdph.laws.compiled import law
from sdph.laws.constants import SOFTENING


@law
def monaghan(approach, r_squared, h, sound_speed, density, alpha, beta):
    """Pi_ij [m5/(kg s2)] = (-alpha c mu + beta mu^2)/rho, mu = h v.r/(r^2 + 0.01 h^2), where v.r < 0, else 0.

    approach = v_ij.r_ij [m2/s], r_squared [m2], h [m], sound_speed and density the means of the pair [m/s, kg/m3],
    alpha, beta [-] (0.1, 0.2 in the paper). Force on i: -m_i m_j Pi_ij grad_i W. Monaghan 1992, Annu. Rev. Astron.
    Astrophys. 30, 543, section 4.1.
    """
    mu = h * min(approach, 0.0) / (r_squared + SOFTENING * h * h)
    return (beta * mu - alpha * sound_speed) * mu / density
