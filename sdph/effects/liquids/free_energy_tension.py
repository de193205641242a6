"""Surface tension of moving particles as a force of pairs, by free energy: no second phase, no normals.

Kondo, Koshizuka & Takimoto 2007, Trans. JSCES 20070021: F = C (r - r_0)(r - r_t), repelling below r_0 = 1.5 l0, and
attracting to r_t. The lattice carries a cohesion pressure by it, which is no pressure of the liquid (`Mps.points` takes
it out). C is divided by what a resting film of the lattice is pulled together with (`film_pull`), so that sheets and
rims feel sigma.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from sdph.effects.effect import NO_LIMIT, Effect, Judgement
from sdph.laws import moving_particles
from sdph.laws.constants import CAPILLARY
from sdph.laws.sheets import taylor_culick
from sdph.schema import quantity, record


@record
class FreeEnergyTension:
    coefficient: float = quantity("N_m", least=0.0)
    # r_t in spacings: 3.1, or 4.1 with weaker traces of a lattice; nearer than 3 the few pairs pull by less, and below
    # 2.27 a film is pushed apart (sdph.laws.moving_particles.film_pull)
    reach: float = quantity("", 3.1, least=3.0, most=6.0)


class FreeTensionP(NamedTuple):
    """C in units of force [N, N/m in two dimensions]: F = coefficient (r/l0 - r_0)(r/l0 - r_t); r_t [m]; cohesion
    pressure [Pa], negative."""

    coefficient: float
    reach: float
    cohesion: float


def kernel(case) -> FreeTensionP:
    own, unit, d = case.parameters["free_energy_tension"], case.resolution.spacing, case.dimensions
    sigma = own.coefficient / moving_particles.film_pull(own.reach, d)
    strength = moving_particles.tension_coefficient(own.reach, d) * sigma * unit ** (d - 2)
    return FreeTensionP(strength, own.reach * unit, moving_particles.cohesion_pressure(own.reach, d) * sigma / unit)


def dt_limit(p, case, state) -> float:
    """Capillary step [s] of waves one spacing long."""
    sigma = case.parameters["free_energy_tension"].coefficient
    if sigma == 0.0:
        return NO_LIMIT
    return CAPILLARY * math.sqrt(case.liquid.density * case.resolution.spacing**3 / (2.0 * math.pi * sigma))


def call(scales) -> Judgement:
    """Way that the rim of a film as thick as the liquid is narrow goes within the run, over that thickness."""
    sigma, length = scales.case.parameters["free_energy_tension"].coefficient, scales.length
    way = taylor_culick(sigma, scales.liquid.density, length) * scales.end
    return Judgement("way of a rim / thickness", way / length, 0.01, "Taylor 1959; Culick 1960", min(1.0, way / length))


EFFECT = Effect(
    name="free_energy_tension",
    summary="surface tension of moving particles as a force of pairs (free energy)",
    parameters=FreeEnergyTension,
    kernel=kernel,
    moves=True,
    matter=("liquid",),
    dt_limit=dt_limit,
    call=call,
)
