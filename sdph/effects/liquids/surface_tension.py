"""Surface tension between two phases, as a continuum surface force (Brackbill, Kothe & Zemach 1992).

The gradient of colour takes the inter-particle average of Adami, Hu & Adams 2010, J. Comput. Phys. 229, 5011, which
is that of the pressure: with one curvature everywhere the force is balanced to round-off. Walls have no force of their
own; with a contact angle they bend the interface (sdph.methods.liquids.wetting).
"""

from __future__ import annotations

import math
from typing import NamedTuple

from sdph.effects.effect import Effect, Judgement
from sdph.laws.constants import CAPILLARY, TINY
from sdph.schema import CaseError, quantity, record


@record
class SurfaceTension:
    """`contact_angle`: at which the interface meets walls, through the liquid; None: walls take no part."""

    coefficient: float = quantity("N_m", above=0.0)
    contact_angle: float | None = quantity("deg", None, least=0.0, most=180.0)


class TensionP(NamedTuple):
    """sigma [N/m]; |grad c| below which a particle is off the interface [1/m]."""

    coefficient: float
    least: float


class WettingP(NamedTuple):
    """The same; cosine and sine of the contact angle; spacing [m] of the walls' particles."""

    coefficient: float
    least: float
    cosine: float
    sine: float
    spacing: float


FAINT = 0.01  # of 1/h: Morris 2000, Int. J. Numer. Methods Fluids 33, 333, Eq. 20


def kernel(case) -> TensionP | WettingP:
    own, least = case.parameters["surface_tension"], FAINT / case.smoothing_length
    if own.contact_angle is None:
        return TensionP(own.coefficient, least)
    angle = own.contact_angle
    if "tank" not in case.effects and not case.bodies:
        given = f"surface_tension.contact_angle_deg = {math.degrees(angle):g}"
        raise CaseError(f"{given}; there are no walls that the liquid could meet: add the effect tank, or leave it out")
    return WettingP(own.coefficient, least, math.cos(angle), math.sin(angle), case.resolution.spacing)


def dt_limit(p, case, state) -> float:
    """Capillary step [s] of waves one h long, of the mean density of both phases."""
    rho = 0.5 * (case.liquid.density + case.gas_phase.density)
    return CAPILLARY * math.sqrt(rho * case.smoothing_length**3 / (2.0 * math.pi * p.coefficient))


def call(scales) -> Judgement:
    """Capillary against dynamic and hydrostatic pressure: 1 over the larger of the Weber and Bond numbers."""
    weber, bond = scales.capillary(scales.case.parameters["surface_tension"].coefficient)
    ratio = 1.0 / max(weber, bond, TINY)
    return Judgement("1/max(Weber, Bond)", ratio, 0.01, "by their definitions", min(1.0, ratio))


EFFECT = Effect(
    name="surface_tension",
    summary="surface tension between a liquid and a gas (continuum surface force)",
    parameters=SurfaceTension,
    kernel=kernel,
    moves=True,
    matter=("liquid",),
    dt_limit=dt_limit,
    call=call,
    two_phases=True,
)
