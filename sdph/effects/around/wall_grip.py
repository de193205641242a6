"""Hold of a wall on grains: as rough as they are, or as rough as its friction or its specularity tells.

Agitated grains leave the stress of Johnson & Jackson 1987 on it. Its specularity is given, or follows from Coulomb's
coefficient of a grain on the wall and from how fast grains slide (Li & Benyahia 2012). Of lasting contacts it takes the
part of the traction that makes Coulomb's stress of it where they yield.
"""

from __future__ import annotations

import math

from sdph.engine.walls.dummies import normal_part
from sdph.laws import friction as law
from sdph.laws import granular
from sdph.laws.compiled import inlined, serial

NO_SLIP = -1.0


def specularity(own, restitution: float) -> tuple[float, float]:
    """Specularity of the parameters of walls (NO_SLIP where they have none), and the coefficient of a collision by
    which it falls as grains slide (0 where it does not); a grain bounces off a wall as off a grain: our choice."""
    if own.specularity is not None or own.friction is None:
        return NO_SLIP if own.specularity is None else own.specularity, 0.0
    return law.sticking_specularity(own.friction, restitution), law.sliding(own.friction, restitution)


def coulomb(case, own) -> tuple[float, float]:
    """Coefficient of a contact that slides on a wall, at most sin(phi) of the grains, which then slide over each other;
    the part of their traction that the wall takes."""
    sine = math.sin(case.parameters["friction"].angle) if "friction" in case.effects else 0.0
    if own.friction is None:
        return (0.0, 0.0) if own.specularity == 0.0 else (sine, 1.0)
    if sine == 0.0:
        return own.friction, float(own.friction > 0.0)
    rubs = min(own.friction, sine)
    return rubs, rubs / sine


@inlined
def held(p, wall, w, x, y, z):
    """Part of a vector (velocity or traction of contacts) that a wall takes hold of: `bears` of it where it grips, and
    that along the normal."""
    nx, ny, nz = normal_part(wall, w, x, y, z)
    grips = wall.stick[w] * p.bears
    return nx + grips * (x - nx), ny + grips * (y - ny), nz + grips * (z - nz)


@inlined
def slip(nx, ny, nz, du, dv, dw):
    """Speed [m/s] along a wall of normal n of the velocity d relative to it."""
    along = du * nx + dv * ny + dw * nz
    return math.sqrt(max(du * du + dv * dv + dw * dw - along * along, 0.0))


@serial
def grip(p, stick, y, density, grain_density, theta, shear, speed):
    """Share of the no-slip stress: y/(y + b) at the distance y [m] from the wall, with the slip length b = mu/k of the
    law tau = k v; all of it where theta [m2/s2] is not known (nan). `speed` [m/s] is that of the grains along it, which
    stands for that at the wall itself."""
    if p.specularity < 0.0 or stick == 0.0 or math.isnan(theta):
        return stick * (p.specularity != 0.0)
    y = max(y, p.contact)
    a = granular.capped_fraction(density / grain_density, p.packing)
    g0 = granular.sinclair_jackson(a, p.packing)
    diffuse = p.specularity
    if p.sliding > 0.0:
        diffuse = law.sliding_specularity(diffuse, p.sliding, speed, theta)
        diffuse *= law.load_of_pressure(a, p.bounce, g0, p.packing)
    k = law.johnson_jackson_wall(diffuse, a, theta, g0, grain_density, p.packing)
    return k * y / (k * y + shear) if k > 0.0 else 0.0
