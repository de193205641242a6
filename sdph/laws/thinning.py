"""Liquids whose viscosity depends on how fast they are sheared (generalised Newtonian).

Every law takes the shear rate first, gamma = sqrt(2 D:D) [1/s] of the strain rate D = (grad v + grad v^T)/2, which in
a simple shear is |du/dy|, and returns the viscosity [Pa s]; the stress is 2 mu D. Constants are `viscosity` [Pa s]
and `index` n [-], 1 of a Newtonian liquid, below 1 of one that thins.
"""

import math

import numpy as np

from sdph.laws.compiled import law

UNIT_RATE = 1.0  # 1/s, shear rate at which a power law has its `viscosity`: K of K gamma^n, in Pa s^n, has that number


@law
def power_law(shear_rate, viscosity, index):
    """mu = K gamma^(n-1), K = viscosity (1 s)^(n-1). n > 0; without bound at gamma = 0 if n < 1, 0 there if n > 1.

    Ostwald 1925, Kolloid-Z. 36, 99; de Waele 1923.
    """
    if index == 1.0:
        return viscosity
    return viscosity * (shear_rate / UNIT_RATE) ** (index - 1.0)


@law
def carreau(shear_rate, viscosity, index, time, infinite):
    """mu = mu_inf + (mu_0 - mu_inf) (1 + (lambda gamma)^2)^((n-1)/2): mu_0 = viscosity at rest, mu_inf = infinite [Pa
    s] when sheared fast, lambda = time [s].

    Carreau 1972, Trans. Soc. Rheol. 16, 99; Bird, Armstrong & Hassager 1987, Dynamics of Polymeric Liquids 1, section
    4.1.
    """
    sheared = time * shear_rate
    return infinite + (viscosity - infinite) * (1.0 + sheared * sheared) ** (0.5 * (index - 1.0))


@law
def herschel_bulkley(shear_rate, viscosity, index, time, yield_stress):
    """mu = K gamma^(n-1) + tau_y (1 - exp(-m gamma))/gamma: K as in `power_law`, m = time [s]; at rest the second
    part is tau_y m.

    Herschel & Bulkley 1926, Kolloid-Z. 39, 291, regularised by Papanastasiou 1987, J. Rheol. 31, 385: below the yield
    stress tau_y [Pa] it creeps with a viscosity near tau_y m. n = 1 is Bingham's liquid.
    """
    own = -math.expm1(-time * shear_rate) / shear_rate if shear_rate > 0.0 else time
    return power_law(shear_rate, viscosity, index) + yield_stress * own


def between_plates(y, height: float, pull: float, viscosity: float, index: float) -> np.ndarray:
    """u (N,) [m/s] of a power-law liquid between plates at y = 0 and `height` [m], long after it began to be pulled
    along by `pull` [N/m3]: n/(n+1) (pull/K)^(1/n) (R^(1+1/n) - |y - R|^(1+1/n)), R = height/2.

    Bird, Armstrong & Hassager 1987, section 4.2.
    """
    half, power = 0.5 * height, 1.0 + 1.0 / index
    shape = half**power - np.abs(np.asarray(y, float) - half) ** power
    return index / (index + 1.0) * (pull / viscosity) ** (1.0 / index) * shape
