"""Friction between grains in lasting contact, above the fraction alpha_fr where friction starts.

Frictional viscosities are TOTAL: stress tau = 2 mu dev(D), nothing to multiply by alpha_p (see granular.py).
"""

import math

from sdph.laws.compiled import law

# phi_0 [-] by powers of k from 0 on, and k to which and slope with which it begins straight: Li & Benyahia 2012
STICKING = -0.00125963407, 0.106455101, -0.0428147645, 0.00975940218, -0.00125082579, 8.36982963e-5, -2.26955057e-6
STICKING_STRAIGHT, STICKING_SLOPE = 0.2, 0.0909456818


@law
def johnson_jackson_pressure(alpha_p, alpha_fr, alpha_max, fr, eta, p):
    """p_fr [Pa] = Fr (alpha_p - alpha_fr)^eta/(alpha_max - alpha_p)^p, 0 below alpha_fr. alpha_p < alpha_max (pole).

    Fr [Pa], eta, p [-], see constants.py. Johnson & Jackson 1987, J. Fluid Mech. 176, 67.
    """
    if alpha_p <= alpha_fr:
        return 0.0
    return fr * (alpha_p - alpha_fr) ** eta / (alpha_max - alpha_p) ** p


@law
def johnson_jackson_slope(alpha_p, alpha_fr, alpha_max, fr, eta, p):
    """dp_fr/dalpha_p [Pa] = p_fr (eta/(alpha_p - alpha_fr) + p/(alpha_max - alpha_p)), 0 below alpha_fr."""
    if alpha_p <= alpha_fr:
        return 0.0
    pressure = johnson_jackson_pressure(alpha_p, alpha_fr, alpha_max, fr, eta, p)
    return pressure * (eta / (alpha_p - alpha_fr) + p / (alpha_max - alpha_p))


@law
def second_invariant(d11, d22, d33, d12, d23, d31):
    """I2D [1/s2] = dev(D):dev(D)/2 of the rate of strain D [1/s]; (shear rate)^2/4 in simple shear. 2-D: d33 = 0.

    Schaeffer 1987; = [(D11-D22)^2 + (D22-D33)^2 + (D33-D11)^2]/6 + D12^2 + D23^2 + D31^2.
    """
    normal = (d11 - d22) ** 2 + (d22 - d33) ** 2 + (d33 - d11) ** 2
    return normal / 6.0 + d12 * d12 + d23 * d23 + d31 * d31


@law
def yield_share(pressure, sin_angle, stress_squared):
    """Share [-] of a deviatoric stress that contacts bear: sqrt(J2) is at most p_fr sin(phi).

    pressure p_fr [Pa], sin_angle = sin(phi), stress_squared = J2 = tau:tau/2 [Pa2]. Schaeffer 1987, J. Differ.
    Equations 66, 19: grains that yield have tau = 2 mu_fr dev(D), mu_fr = p_fr sin(phi)/(2 sqrt(I2D)).
    """
    most = pressure * sin_angle
    return most / math.sqrt(stress_squared) if stress_squared > most * most else 1.0


@law
def johnson_jackson_wall(specularity, alpha_p, theta, g0, density, alpha_max):
    """k [Pa s/m] of the stress k v on a wall that grains slip along at v: phi pi rho_p alpha_p g0 sqrt(3 theta)/(6
    alpha_max).

    specularity phi [-], 0 smooth to 1 rough; theta [m2/s2], density rho_p [kg/m3]. Johnson & Jackson 1987.
    """
    return specularity * math.pi * density * alpha_p * g0 * math.sqrt(3.0 * theta) / (6.0 * alpha_max)


@law
def load_of_pressure(alpha_p, restitution, g0, alpha_max):
    """Lun's pressure over the load of the collisions that `johnson_jackson_wall` counts, (1 + e) pi rho_p alpha_p g0
    theta/(2 alpha_max sqrt(6 pi)) [-].

    The stress of `sliding_specularity` is mu of that load where all grains slide; a wall bears the pressure.
    """
    collisions = (1.0 + restitution) * math.pi * g0 / (2.0 * alpha_max * math.sqrt(6.0 * math.pi))
    return (1.0 + 2.0 * (1.0 + restitution) * alpha_p * g0) / collisions


def sliding(friction, restitution):
    """Coefficient of a collision with a wall k [-] = 7/2 mu (1 + e), mu Coulomb's coefficient and e the restitution of
    a grain on it: a grain slides where its speed along the wall is more than k times that towards it.

    Li & Benyahia 2012, AIChE J. 58, 2058.
    """
    return 3.5 * friction * (1.0 + restitution)


def sticking_specularity(friction, restitution):
    """Specularity phi_0 [-] of a wall that grains do not slide along, by its friction [-] and restitution [-]: a fit of
    sixth degree in k of `sliding`, below 0.2 its straight beginning.

    Li & Benyahia 2012, AIChE J. 58, 2058; coefficients as in MFIX.
    """
    k = sliding(friction, restitution)
    return STICKING_SLOPE * k if k <= STICKING_STRAIGHT else sum(c * k**n for n, c in enumerate(STICKING))


@law
def sliding_specularity(sticking, k, slip, theta):
    """Specularity [-] of a wall that grains of theta [m2/s2] slide along at `slip` [m/s]: with r = slip/sqrt(3 theta)

        phi_0 - 7 sqrt(6 pi) phi_0^2 r/(8 k)   up to r = 4 k/(7 sqrt(6 pi) phi_0), where it is half of phi_0,
        2 k/(7 sqrt(6 pi) r)                   beyond: the stress no longer grows with slip, all grains slide.

    sticking = phi_0 by `sticking_specularity`, k by `sliding`. Li & Benyahia 2012, AIChE J. 58, 2058.
    """
    agitation, turn = math.sqrt(3.0 * theta), 7.0 * math.sqrt(6.0 * math.pi)
    if slip * turn * sticking <= 4.0 * k * agitation:
        return sticking - (turn * sticking * sticking * slip / (8.0 * k * agitation) if slip > 0.0 else 0.0)
    return 2.0 * k * agitation / (turn * slip)


@law
def shear_over_bulk(poisson_ratio):
    """G/K [-] = 3 (1 - 2 nu)/(2 (1 + nu)) of an isotropic elastic solid, 0 < nu < 0.5."""
    return 1.5 * (1.0 - 2.0 * poisson_ratio) / (1.0 + poisson_ratio)
