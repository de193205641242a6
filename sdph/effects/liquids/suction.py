"""Gas at rest sucks at the crests of waves on a sheet of moving particles, and tears it where they have grown by e^12.

Waves are 0.15 to 0.55 mm long and begin e^12 times smaller than the sheet's break: no particle shows them. So each
particle adds up the growth of the fastest wave along its path, with the thickness and the speed that it has, and
where the sum is ln(eta_b/eta_0) = 12 the sheet is perforated, a hole on each square of a wave's length (swirl-sheet.md,
section 6, b; Senecal et al. 1999, Int. J. Multiph. Flow 25, 1073).
"""

from __future__ import annotations

from typing import NamedTuple

from sdph.effects.effect import Effect, Judgement
from sdph.effects.liquids.perforation import annulus, refuse, rim_limit, way
from sdph.laws import sheets
from sdph.schema import quantity, record, whole


@record
class Suction:
    gas_density: float = quantity("kg_m3", above=0.0)  # of gas at rest
    seed: int = whole(1, least=0)  # of the draw of places that tear


class SuctionP(NamedTuple):
    """rho, rho_g [kg/m3], sigma [N/m]."""

    density: float
    gas_density: float
    tension: float


def kernel(case) -> SuctionP:
    refuse(case, "suction")
    sigma = case.parameters["free_energy_tension"].coefficient
    return SuctionP(case.liquid.density, case.parameters["suction"].gas_density, sigma)


def call(scales) -> Judgement:
    """Way of the sheet over that at which it breaks; of other liquid the growth of waves in the run over 12."""
    case, found = scales.case, annulus(scales.case)
    if not (tension := case.parameters.get("free_energy_tension")) or not tension.coefficient:
        ratio = 0.0
    elif found:
        r_0, h_0, nozzle = found
        rest = case.liquid.density, case.parameters["suction"].gas_density, tension.coefficient
        ratio = way(case, nozzle) / sheets.suction_length(r_0, h_0, nozzle.speed, nozzle.swirl, *rest)
    else:
        half, slip, gas = 0.5 * scales.length, scales.speed, case.parameters["suction"].gas_density
        k = sheets.fastest_wave(half, slip, gas, tension.coefficient)
        rate = sheets.wave_growth(k, half, slip, case.liquid.density, gas, tension.coefficient)
        ratio = rate * scales.end / sheets.TORN
    source = "Squire 1953; Dombrowski & Johns 1963; Senecal et al. 1999"
    return Judgement("way of the sheet / way to its break by waves", ratio, 1.0, source, float(ratio >= 1.0))


EFFECT = Effect(
    name="suction",
    summary="waves that gas makes grow on a sheet of moving particles, and that tear it",
    parameters=Suction,
    kernel=kernel,
    moves=True,
    matter=("liquid",),
    dt_limit=rim_limit,
    call=call,
)
