"""Shells that a bubble inflates until they tear: cylinders (`dims` 2, plane strain) and spheres (3), thick or thin.

Volumes give every r from that of the inner face, r^dims = R^dims + g, g [m^dims] its growth: a layer's volume changes
by J alone, ln J = J (mean stress)/K. The equivalent strain is e = k (ln(r/R) - ln(J)/dims), and equilibrium
d sigma_r/dr = k q/r, with k = 2/sqrt(3) of a cylinder and 2 of a sphere (Hill 1950, The Mathematical Theory of
Plasticity, ch. 5); layers add their pressures up. Stress q and damage are those of `strength`. J is that of the step
before: an error of first order in the step, on what is 9 % of the elastic displacement at nu = 0.45.
"""

import math

import numpy as np

from sdph.laws import strength
from sdph.laws.compiled import law
from sdph.laws.constants import HALVINGS

FLOW, HARD, HARM, SWELL = 0, 1, 2, 3  # rows of layers: plastic strain with its sign, r of `strength`, damage, ln J
FIRST_SEARCH = 1e-9  # of hoop strain: the first step of a search for the spot's strain, which then doubles
DOUBLINGS = 29  # of it: from 1e-9 to 0.5


@law
def strain_factor(dims):
    """k [-], as above."""
    return 2.0 / math.sqrt(3.0) if dims == 2 else 2.0


@law
def grown(radius, growth, dims):
    """r [m] of a place that lay at R [m], after growth g [m^dims]."""
    return (radius**dims + growth) ** (1.0 / dims)


@law
def layer_pressure(stress, inner, outer, dims):
    """Pressure [Pa] that a layer between two radii [m] bears: k q ln(ro/ri), q [Pa] its equivalent stress.

    Plastic all through, q = sigma_y: Hill 1950, section 5.2, the limit pressure of tubes and spheres.
    """
    return strain_factor(dims) * stress * math.log(outer / inner)


@law
def hoop_stress(radial, stress, dims):
    """sigma_theta [Pa] = sigma_r + k q/(dims - 1)."""
    return radial + strain_factor(dims) * stress / (dims - 1)


@law
def mean_stress(radial, stress, dims):
    """Mean stress [Pa]: sigma_r + q/sqrt(3) of a cylinder (sigma_z half way), sigma_r + 2/3 q of a sphere."""
    return radial + (stress / math.sqrt(3.0) if dims == 2 else 2.0 / 3.0 * stress)


@law
def yielded(plastic, shear, strain, flow, r, damage, swell, dt):
    """Equivalent stress [Pa], with the sign of its strain, and plastic strain of a step of dt [s] to a `strain` [-] by
    radial return; flow, r, damage, ln J [-] those at its start, shear G [Pa]."""
    elastic, jacobian = strain - flow, math.exp(swell)
    dp = strength.plastic_strain(plastic, 3.0 * shear * abs(elastic), shear, jacobian, r, damage, dt)
    return 3.0 * shear / jacobian * math.copysign(abs(elastic) - dp, elastic), math.copysign(dp, elastic)


@law
def harmed(damage, reference_rate, stress, radial, dims, strain, dt):
    """Damage dD [-] of a plastic strain in dt [s] under an equivalent stress [Pa] and a radial one [Pa]."""
    if strain == 0.0:
        return 0.0
    triaxiality = mean_stress(radial, stress, dims) / abs(stress)
    failure = strength.failure_strain(damage, triaxiality, abs(strain) / dt, reference_rate)
    return strength.damage_growth(damage, abs(strain), abs(strain), failure)


@law
def sheared(hoop, swell, dims):
    """Equivalent strain [-] of hoop strain ln(r/R) and ln J, as above."""
    return strain_factor(dims) * (hoop - swell / dims)


@law
def outer_growth(dims, edges, growth, rows):
    """g [m^dims] of the outer face, from that of the inner face and the layers between; edges as in `loaded`."""
    for n in range(len(edges) - 1):
        growth += math.expm1(rows[SWELL, n]) * (edges[n + 1] ** dims - edges[n] ** dims)
    return growth


@law
def loaded(dims, edges, growth, plastic, damage, bulk, shear, dt, before, after):
    """Pressure [Pa] inside a shell that has grown by g [m^dims] after dt [s]; rows (4, n) of its n layers, those of the
    start `before`, go to `after`. edges (n + 1,) [m]: radii between layers, unloaded, from inside out; K, G [Pa]."""
    pressure, beyond = 0.0, outer_growth(dims, edges, growth, before)
    for n in range(len(edges) - 2, -1, -1):  # from outside in: the layers beyond press on this one
        flow, r, harm, swell = before[FLOW, n], before[HARD, n], before[HARM, n], before[SWELL, n]
        within = beyond - math.expm1(swell) * (edges[n + 1] ** dims - edges[n] ** dims)
        inner, outer = grown(edges[n], within, dims), grown(edges[n + 1], beyond, dims)
        hoop = math.log((inner + outer) / (edges[n] + edges[n + 1]))
        stress, dp = yielded(plastic, shear, sheared(hoop, swell, dims), flow, r, harm, swell, dt)
        own = layer_pressure(stress, inner, outer, dims)
        radial = -(pressure + 0.5 * own)
        after[FLOW, n], after[HARD, n] = flow + dp, r + (1.0 - harm) * abs(dp)
        after[HARM, n] = harm + harmed(damage, plastic.reference_rate, stress, radial, dims, dp, dt)
        after[SWELL, n] = math.exp(swell) * mean_stress(radial, stress, dims) / bulk
        pressure, beyond = pressure + own, within
    return pressure


@law
def stresses(dims, edges, growth, shear, rows, out):
    """Equivalent Kirchhoff stresses (n,) [Pa], with the sign of their strain, of layers as `loaded` left them, into out
    (n,)."""
    for n in range(len(edges) - 1):
        beyond = growth + math.expm1(rows[SWELL, n]) * (edges[n + 1] ** dims - edges[n] ** dims)
        within, without = grown(edges[n], growth, dims), grown(edges[n + 1], beyond, dims)
        hoop = math.log((within + without) / (edges[n] + edges[n + 1]))
        out[n] = 3.0 * shear * (sheared(hoop, rows[SWELL, n], dims) - rows[FLOW, n])
        growth = beyond


@law
def tension(pressure, inner, outer, dims):
    """Hoop force by length [N/m] all through a shell under a pressure [Pa]: p ri of a cylinder, p ri^2/(ri + ro) of a
    sphere. Balance of a half."""
    return pressure * inner if dims == 2 else pressure * inner * inner / (inner + outer)


@law
def spot_tension(stress, thickness, pressure, dims):
    """Hoop force by length [N/m] of a thin spot of a thickness [m]: (k q/(dims - 1) - p/2) t; sigma_r is -p/2 in the
    mean."""
    return hoop_stress(-0.5 * pressure, stress, dims) * thickness


@law
def _pull(dims, thickness, pressure, plastic, shear, dt, spot, hoop):
    """`spot_tension` at a hoop strain; thickness [m] that of the spot unloaded, spot (4,) its flow, r, damage, ln J."""
    stress, _ = yielded(plastic, shear, sheared(hoop, spot[3], dims), *spot, dt)
    return spot_tension(stress, thickness * math.exp(spot[3] - (dims - 1) * hoop), pressure, dims)


@law
def necked(dims, thickness, pressure, pull, plastic, damage, bulk, shear, dt, hoop, spot):
    """Hoop strain ln(lambda) at which a spot that is thinner than the rest bears the same pull [N/m] after dt [s].

    hoop [-] is that of the start, spot (4,) its rows, which become those of the end. Returns inf where no strain near
    bears the pull: then the spot runs away within the step. Long waves: the spot has the pressure and the curvature of
    the rest, and nothing holds its sides (Marciniak & Kuczynski 1967, Int. J. Mech. Sci. 9, 609).
    """
    own = (spot[FLOW], spot[HARD], spot[HARM], spot[SWELL])
    near = far = hoop
    missing = pull - _pull(dims, thickness, pressure, plastic, shear, dt, own, near)
    step, sign = FIRST_SEARCH, 1.0 if missing > 0.0 else -1.0
    for _ in range(DOUBLINGS):
        far = near + sign * step
        if sign * (pull - _pull(dims, thickness, pressure, plastic, shear, dt, own, far)) <= 0.0:
            break
        near, step = far, 2.0 * step
    else:
        return math.inf
    for _ in range(HALVINGS):
        middle = 0.5 * (near + far)
        if sign * (pull - _pull(dims, thickness, pressure, plastic, shear, dt, own, middle)) > 0.0:
            near = middle
        else:
            far = middle
    stress, dp = yielded(plastic, shear, sheared(far, own[3], dims), *own, dt)
    spot[FLOW], spot[HARD] = own[0] + dp, own[1] + (1.0 - own[2]) * abs(dp)
    spot[HARM] += harmed(damage, plastic.reference_rate, stress, -0.5 * pressure, dims, dp, dt)
    spot[SWELL] = math.exp(own[3]) * mean_stress(-0.5 * pressure, stress, dims) / bulk
    return far


def layers(inner: float, outer: float, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Edges (count + 1,) [m] of layers of equal thickness, and their rows (4, count) at rest."""
    return np.linspace(inner, outer, count + 1), np.zeros((4, count))
