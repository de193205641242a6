"""Lasting contacts: Johnson-Jackson frictional pressure, and Schaeffer's friction, which yields at |tau| = p_fr
sin(phi).

Schaeffer's viscosity p_fr sin(phi)/(2 sqrt(I2D)) is infinite at rest. A bound on it makes a bed creep, and one that
holds a bed takes steps far below those of sound. Here the contacts are elastic below yield (Bui, Fukagawa, Sako & Ohno
2008, Int. J. Numer. Anal. Methods Geomech. 32, 1537, with Johnson and Jackson's bulk modulus): grains that do not yield
are at rest, grains that yield have Schaeffer's stress, and the step is that of sound.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from sdph.effects import limiter
from sdph.effects.effect import DIFFUSIVE, Effect, Judgement
from sdph.engine import arrays
from sdph.engine.geometry import deep
from sdph.engine.state import by_material
from sdph.laws import constants, granular
from sdph.laws import friction as law
from sdph.laws.compiled import inlined, serial
from sdph.schema import quantity, record

ARRAYS = ("contact_xx", "contact_yy", "contact_xy", "contact_yz", "contact_zx")  # of the state [Pa]
REORDERED = 1e-9  # of a viscosity that loops have reordered; our choice
NEAR = 0.95  # of the onset: grains that close get there when they settle; our choice


@record
class Friction:
    # alpha_p where contacts begin to last (sdph-notes, section 2)
    onset: float = quantity("", 0.60, above=0.0, most=1.0)
    angle: float = quantity("deg", 28.5, least=0.0, most=60.0)  # OpenFOAM tutorials
    fr: float = quantity("Pa", constants.FRICTION_FR, least=0.0)  # Johnson & Jackson 1987, OpenFOAM tutorials
    # of contacts that do not yield; loose sand has 0.2 to 0.4
    poisson_ratio: float = quantity("", 0.4, above=0.0, most=0.49)


class FrictionP(NamedTuple):
    """Onset [-], packing limit [-], Fr [Pa], sine of the friction angle, grain density [kg/m3], shear over bulk modulus
    [-], h [m], density of the lightest grains [kg/m3]."""

    onset: float
    packing: float
    fr: float
    sine: float
    grain_density: float
    stiffness: float
    h: float
    lightest: float


def kernel(case) -> FrictionP:
    chosen = case.parameters["friction"]
    packing, density = case.grains.packing_limit, case.grains.density
    stiffness = law.shear_over_bulk(chosen.poisson_ratio)
    return FrictionP(
        chosen.onset,
        packing,
        chosen.fr,
        math.sin(chosen.angle),
        density,
        stiffness,
        case.smoothing_length,
        min(grains.density for grains in case.kinds),
    )


@serial
def pressure(p, alpha_p):
    """p_fr [Pa] and its slope [Pa]; goes on along its tangent past PACKING_MARGIN below the limit, where it has a
    pole."""
    if len(p) == 0:
        return 0.0, 0.0
    a = granular.capped_fraction(alpha_p, p.packing)
    slope = law.johnson_jackson_slope(a, p.onset, p.packing, p.fr, constants.FRICTION_ETA, constants.FRICTION_P)
    own = law.johnson_jackson_pressure(a, p.onset, p.packing, p.fr, constants.FRICTION_ETA, constants.FRICTION_P)
    return own + slope * (alpha_p - a), slope


@serial
def sound_squared(p, slope):
    """c^2 [m2/s2] of a wave along which contacts are strained elastically: bulk modulus, by the slope of their pressure
    [Pa], and 4/3 of the shear modulus."""
    if len(p) == 0:
        return 0.0
    return slope / p.grain_density * (1.0 + 4.0 / 3.0 * p.stiffness)


@inlined
def stress(p, pressures, kernel, s, box, i, D, spin, dt):
    """Deviator of the elastic stress of contacts [Pa] after dt (xx, yy, zz, xy, yz, zx), and their viscosity [Pa s].

    `pressures` is a sdph.methods.grains.equations.Scratch, D (6) the deviator of the rate of strain [1/s], spin (xy,
    yz, zx) its antisymmetric part: the stress turns with the grains (Jaumann), grows by 2 G D dt, and is joined by
    2 mu D with the largest mu that an explicit step bears, so that contacts come to rest; both are cut down together
    where their sum is past yield.
    """
    frictional_pressure = pressures.lasting[i] * s.density[i] ** 2
    rho, lightest = densities(p, kernel, s, i)
    bulk = s.density[i] / rho * pressures.stiffness[i]
    xx, yy, zz, xy, yz, zx = trial(s, box, i, D, spin, 2.0 * p.stiffness * bulk, dt)
    mu = stiffest(p, lightest, dt)
    m = 2.0 * mu
    squared = law.second_invariant(
        xx + m * D[0], yy + m * D[1], zz + m * D[2], xy + m * D[3], yz + m * D[4], zx + m * D[5]
    )
    share = law.yield_share(frictional_pressure, p.sine, squared) * (frictional_pressure > 0.0)
    return (share * xx, share * yy, share * zz, share * xy, share * yz, share * zx), share * mu


@inlined
def densities(p, kernel, s, i):
    """rho_p of a particle, and alpha_p times that of the lightest grains there are [kg/m3]."""
    if len(kernel) == 2:
        return p.grain_density, s.density[i]
    return s.grain_density[i], s.density[i] * (p.lightest / s.grain_density[i])


@serial
def stiffest(p, density, dt):
    """Most viscosity [Pa s] that a step of dt [s] bears at a density [kg/m3], of the lightest grains there."""
    return DIFFUSIVE * p.h * p.h / dt * density


@inlined
def trial(s, box, i, D, spin, modulus, dt):
    """Stress of contacts [Pa] after dt if none yields; modulus = 2 G [Pa]."""
    xx, yy, xy = s.contact_xx[i], s.contact_yy[i], s.contact_xy[i]
    yz, zx = (s.contact_yz[i], s.contact_zx[i]) if deep(box) else (0.0, 0.0)
    zz, strain = -xx - yy, modulus * dt
    a, b, c = spin[0] * dt, spin[1] * dt, spin[2] * dt
    return (
        xx + 2.0 * (a * xy - c * zx) + strain * D[0],
        yy + 2.0 * (b * yz - a * xy) + strain * D[1],
        zz + 2.0 * (c * zx - b * yz) + strain * D[2],
        xy + a * (yy - xx) + b * zx - c * yz + strain * D[3],
        yz + b * (zz - yy) + c * xy - a * zx + strain * D[4],
        zx + c * (xx - zz) + a * yz - b * xy + strain * D[5],
    )


@serial
def power(tau, D):
    """tau:D [W/m3]."""
    return tau[0] * D[0] + tau[1] * D[1] + tau[2] * D[2] + 2.0 * (tau[3] * D[3] + tau[4] * D[4] + tau[5] * D[5])


def held(p, method) -> dict[str, float]:
    """Shares of the particles beyond the packing at which the pressure goes on along its tangent, and of those whose
    contacts do not yield, so that their viscosity is the most that the last step bore; and of those that neighbours do
    not enclose."""
    s, found = method.state, limiter.capped(p, method.state) | limiter.unenclosed(method)
    stiff = arrays.zeros(len(s.x), s.x, np.bool_)
    if method.step:
        density = s.density * (p.lightest / by_material(s.grain_density, p.grain_density))
        stiff = method.scratch.rubbing >= (1.0 - REORDERED) * (stiffest(p, 1.0, method.step) * density)
    return found | {"contact_viscosity_share": limiter.share(s, stiff)}


def call(scales) -> Judgement:
    """Volume fraction over the onset of contacts, which it gets to where grains settle; the error by what presses them
    on each other: their weight on a wall, or the gas that holds up the foremost."""
    onset = scales.case.parameters["friction"].onset
    ratio = max(scales.alpha_p / onset, 1.0 if scales.settles(onset) else 0.0)
    fall = scales.gravity * scales.end
    weight = fall / (fall + scales.speed) if fall and scales.to_walls.over_gap >= 1.0 else 0.0
    held_up = scales.rim * -math.expm1(-scales.end / scales.drag_time) if scales.thrown else 0.0
    source = "Johnson & Jackson 1987: contacts last from the onset on; grains at 95 % of it get there"
    return Judgement("alpha_p / onset", ratio, NEAR, source, max(weight, held_up) if ratio >= NEAR else 0.0)


EFFECT = Effect(
    name="friction",
    summary="lasting contacts of grains (Johnson-Jackson pressure, Schaeffer friction)",
    parameters=Friction,
    kernel=kernel,
    arrays=("theta", *ARRAYS),
    moves=True,
    held=held,
    call=call,
)
