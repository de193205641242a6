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
ROUNDS = 60  # of the radial return at most; it takes 2 or 3, and 9 were the most seen
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
def hardening(plastic, r):
    """A + B r^n [Pa] of a strain r [-]. Johnson & Cook 1983."""
    return plastic.yield_stress + (plastic.hardening * r**plastic.exponent if r > 0.0 else 0.0)


@law
def flow_stress(plastic, r, rate, damage):
    """sigma_y [Pa] = (1 - D)(A + B r^n)(1 + C ln max(r'/eps_0, 1))(1 - T*^m). r [-], rate r' [1/s], D [-].

    Johnson & Cook 1983; with damage Lemaitre 1985, J. Eng. Mater. Technol. 107, 83. Gel-droplet paper, Eq. 11.
    """
    share = rate_share(plastic.rate_factor, rate, plastic.reference_rate)
    return (1.0 - damage) * hardening(plastic, r) * share * plastic.softening


@law
def plastic_strain(plastic, trial, shear, jacobian, r, damage, dt):
    """Plastic strain dp [-] of a step of dt [s] by radial return.

    q - 3 G dp = J sigma_y(r + (1 - D) dp, (1 - D) dp/dt), trial q [Pa]: equivalent Kirchhoff stress with no flow;
    G [Pa]; J [-]. Of y = ln dp the difference of the two sides falls, ever more steeply. So Newton's method in y, begun
    where that is negative, comes to the root from that side alone. It begins with the least of what dp is without
    hardening and rate, and what it is by the rate alone.
    """
    whole, factor = 1.0 - damage, plastic.rate_factor
    scale = jacobian * whole * plastic.softening
    beyond = trial - scale * hardening(plastic, r)
    if beyond <= 0.0:
        return 0.0
    flow = beyond / (3.0 * shear)
    if not whole > 0.0:
        return flow
    slowest = plastic.reference_rate * dt / whole  # dp at eps_0
    if factor > 0.0 and flow > slowest:
        by_rate = beyond / (trial - beyond) / factor  # ln of rate over eps_0
        if by_rate < math.log(flow / slowest):
            flow = slowest * math.exp(by_rate)
    for _ in range(ROUNDS):
        strain = r + whole * flow
        hard, share = hardening(plastic, strain), rate_share(factor, whole * flow / dt, plastic.reference_rate)
        left = trial - 3.0 * shear * flow - scale * hard * share
        if abs(left) <= NEAR * trial:
            break
        steep = plastic.exponent * (hard - plastic.yield_stress) * whole * flow / strain * share
        steep += hard * factor if flow > slowest else 0.0
        flow *= math.exp(left / (3.0 * shear * flow + scale * steep))
    return flow


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
