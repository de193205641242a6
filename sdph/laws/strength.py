"""Strength of solids: log-strain Hooke at finite strain, radial return to von Mises' yield surface, flow stress and
damage of Johnson and Cook.

Stress is Kirchhoff's, tau = J sigma, of the principal logarithmic elastic strains e_a (Simo 1992, Comput. Methods Appl.
Mech. Engrg. 99, 61). p is the equivalent plastic strain [-], r what of it hardens, dr = (1 - D) dp, D damage.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from sdph.laws.compiled import law

TRIAXIAL = 3.0  # |mean/equivalent stress| is taken as no larger: beyond, exp(D3 s*) tells of nothing measured
ROUNDS = 60  # of the radial return at most: each halves what encloses the root or does better
NEAR = 1e-13  # of the trial stress: the radial return is exact to this


class Plastic(NamedTuple):
    """Flow stress of Johnson and Cook: A [Pa], B [Pa], n, C, eps_0 [1/s], and 1 - T*^m of the body's temperature."""

    yield_stress: float
    hardening: float
    exponent: float
    rate_factor: float
    reference_rate: float
    softening: float


class Damage(NamedTuple):
    """Damage of Johnson and Cook: D1 to D4, 1 + D5 T*, damage D_c at which a particle has failed, p_d from which on it
    grows."""

    d1: float
    d2: float
    d3: float
    d4: float
    warmth: float
    critical: float
    begin: float


@law
def bulk_modulus(youngs, poisson):
    """K [Pa] = E/(3 (1 - 2 nu)) of Young's modulus E [Pa] and Poisson's ratio nu [-]."""
    return youngs / (3.0 * (1.0 - 2.0 * poisson))


@law
def shear_modulus(youngs, poisson):
    """G [Pa] = E/(2 (1 + nu)) of Young's modulus E [Pa] and Poisson's ratio nu [-]."""
    return youngs / (2.0 * (1.0 + poisson))


@law
def sound_speed(bulk, shear, density):
    """c [m/s] = sqrt((K + 4/3 G)/rho), of waves of compression. K, G [Pa], rho [kg/m3]."""
    return math.sqrt((bulk + 4.0 / 3.0 * shear) / density)


@law
def elastic_energy(bulk, shear, volume, equivalent):
    """Energy [J/m3] of the undeformed volume: K v^2/2 + q^2/(6 G). v = ln J_e [-], q equivalent stress (Kirchhoff)
    [Pa]."""
    return 0.5 * bulk * volume * volume + equivalent * equivalent / (6.0 * shear)


@law
def rate_share(factor, rate, reference):
    """1 + C ln max(rate/eps_0, 1) [-]. Rates [1/s]. Johnson & Cook 1983, Proc. 7th Int. Symp. Ballistics, 541."""
    return 1.0 + factor * math.log(rate / reference) if rate > reference else 1.0


@law
def flow_stress(plastic, r, rate, damage):
    """sigma_y [Pa] = (1 - D)(A + B r^n)(1 + C ln max(r'/eps_0, 1))(1 - T*^m). r [-], rate r' [1/s], D [-].

    Johnson & Cook 1983; with damage Lemaitre 1985, J. Eng. Mater. Technol. 107, 83. Gel-droplet paper, Eq. 11.
    """
    hard = plastic.yield_stress + (plastic.hardening * r**plastic.exponent if r > 0.0 else 0.0)
    return (1.0 - damage) * hard * rate_share(plastic.rate_factor, rate, plastic.reference_rate) * plastic.softening


@law
def plastic_strain(plastic, trial, shear, jacobian, r, damage, dt):
    """Plastic strain dp [-] of a step of dt [s] by radial return.

    q - 3 G dp = J sigma_y(r + (1 - D) dp, (1 - D) dp/dt), trial q [Pa]: equivalent Kirchhoff stress with no flow;
    G [Pa]; J [-]. The difference falls as dp grows: the root lies between 0 and q/(3 G), and regula falsi (Illinois)
    closes in on it.
    """
    whole = 1.0 - damage
    low, below = 0.0, trial - jacobian * flow_stress(plastic, r, 0.0, damage)
    if below <= 0.0:
        return 0.0
    high = trial / (3.0 * shear)
    above = -jacobian * flow_stress(plastic, r + whole * high, whole * high / dt, damage)
    middle = high
    for _ in range(ROUNDS):
        middle = (low * above - high * below) / (above - below)
        left = trial - 3.0 * shear * middle
        left -= jacobian * flow_stress(plastic, r + whole * middle, whole * middle / dt, damage)
        if abs(left) <= NEAR * trial:
            break
        if left > 0.0:
            low, below, above = middle, left, 0.5 * above
        else:
            high, above, below = middle, left, 0.5 * below
    return middle


@law
def failure_strain(damage, triaxiality, rate, reference):
    """p_f [-] = [D1 + D2 exp(D3 s*)][1 + D4 ln max(p'/eps_0, 1)][1 + D5 T*], s* = mean/equivalent stress within +-3.

    Johnson & Cook 1985, Eng. Fract. Mech. 21, 31. Gel-droplet paper, Eq. 13; rates [1/s].
    """
    s = min(max(triaxiality, -TRIAXIAL), TRIAXIAL)
    return (damage.d1 + damage.d2 * math.exp(damage.d3 * s)) * rate_share(damage.d4, rate, reference) * damage.warmth


@law
def damage_growth(damage, p, dp, failure):
    """dD [-] = D_c dp/(p_f - p_d) where p is beyond p_d, else 0. Gel-droplet paper, Eq. 12: failure is at p = p_f
    whatever D_c is, and at once where p_f is no more than p_d."""
    if p <= damage.begin or dp <= 0.0:
        return 0.0
    return damage.critical * dp / (failure - damage.begin) if failure > damage.begin else damage.critical
