"""Holes in a sheet of moving particles, where it has thinned to a given thickness (swirl-sheet.md, section 6, a).

A hole begins at a speck or bubble that goes with the liquid, and opens where the sheet is no thicker than it
(Dombrowski & Fraser 1954, Phil. Trans. R. Soc. A 247, 101). So sites are particles, drawn by number and seed, as many
as give one hole on each square of `spacing` where the sheet is `thickness` thick.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from sdph.effects.effect import Effect, Judgement
from sdph.laws import sheets
from sdph.schema import CaseError, quantity, record, whole

STEP = 0.2  # of a spacing: way of a rim in a step, as that of neighbours to each other; swirl-sheet.md, section 2, 12


@record
class Perforation:
    """h_c, well above a spacing; 1 mm between holes: rims at 1.1 m/s (50 um) then meet within the 10 mm of the
    specification."""

    thickness: float = quantity("um", above=0.0)
    spacing: float = quantity("mm", 1.0, above=0.0)
    seed: int = whole(1, least=0)


class PerforationP(NamedTuple):
    """h_c [m], share of the particles that are sites, seed of their draw."""

    thickness: float
    share: float
    seed: int


def kernel(case) -> PerforationP:
    own, unit = case.parameters["perforation"], case.resolution.spacing
    refuse(case, "perforation")
    most = case.parameters["free_energy_tension"].reach * unit
    if own.thickness > most:
        raise CaseError(
            f"perforation.thickness_um = {1e6 * own.thickness:g}; particles tell the thickness of a sheet up to "
            f"free_energy_tension.reach spacings, {1e6 * most:g}: give less"
        )
    share = unit**3 / (own.thickness * own.spacing**2)
    if share > 1.0:
        raise CaseError(
            f"perforation.spacing_mm = {1e3 * own.spacing:g} asks for more holes than there are particles; give "
            f"{1e3 * math.sqrt(unit**3 / own.thickness):.3g} or more"
        )
    return PerforationP(own.thickness, share, own.seed)


def refuse(case, name: str) -> None:
    """CaseError where there can be no holes."""
    tension = case.parameters.get("free_energy_tension") if "free_energy_tension" in case.effects else None
    if case.dimensions != 3 or not tension or not tension.coefficient or "tank" in case.effects:
        raise CaseError(
            f"effects holds {name}; it takes a sheet of moving particles with free_energy_tension above 0, in three "
            "dimensions and without a tank: leave it out"
        )


def rim_limit(p, case, state) -> float:
    """Longest step [s]: the rim of a hole in the thinnest sheet that can be told, a particle within reach of none,
    goes STEP of a spacing."""
    own, unit = case.parameters["free_energy_tension"], case.resolution.spacing
    least = unit / (math.pi * own.reach**2)
    return STEP * unit / sheets.taylor_culick(own.coefficient, case.liquid.density, least)


def annulus(case):
    """(r_0 [m], h_0 [m], nozzle) of the sheet of an annular nozzle; None where there is none."""
    for nozzle in case.nozzles.values():
        if nozzle.shape == "annulus":
            return 0.5 * (nozzle.inner_radius + nozzle.radius), nozzle.radius - nozzle.inner_radius, nozzle
    return None


def way(case, nozzle) -> float:
    """Way [m] along the axis that a sheet goes within the run and the domain."""
    return min(nozzle.speed * case.run.end_time, max(case.domain.size))


def call(scales) -> Judgement:
    """h_c over the thickness at the end of the way: from 1 on the sheet is perforated."""
    own, found = scales.case.parameters["perforation"], annulus(scales.case)
    thinnest = scales.length
    if found:
        r_0, h_0, nozzle = found
        thinnest = float(sheets.thickness(way(scales.case, nozzle), r_0, h_0, nozzle.swirl))
    ratio = own.thickness / thinnest
    return Judgement("h_c / least thickness of the sheet", ratio, 1.0, "straight flight", float(ratio >= 1.0))


EFFECT = Effect(
    name="perforation",
    summary="holes in a sheet of moving particles that has thinned to a given thickness",
    parameters=Perforation,
    kernel=kernel,
    moves=True,
    matter=("liquid",),
    dt_limit=rim_limit,
    call=call,
)
