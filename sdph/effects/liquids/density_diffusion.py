"""delta-SPH: density diffuses between neighbours, which quiets the pressure of a weakly compressible liquid.

Written for p/c^2 in place of rho (equal to first order): a hydrostatic pressure is linear in depth to the last bit,
so the corrected form leaves it alone.
"""

from __future__ import annotations

from typing import NamedTuple

from sdph.effects.effect import Effect, Judgement
from sdph.laws.compiled import serial
from sdph.schema import choice, quantity, record

FORMS = ("antuono", "molteni")


@record
class DensityDiffusion:
    delta: float = quantity("", 0.1, above=0.0, most=0.5)  # Antuono et al. 2010
    form: str = choice(*FORMS)


class DiffusionP(NamedTuple):
    """delta h/c [s]; 1 with the gradient correction, 0 without (Molteni & Colagrossi 2009)."""

    strength: float
    corrected: float


def kernel(case) -> DiffusionP:
    own = case.parameters["density_diffusion"]
    return DiffusionP(own.delta * case.smoothing_length / case.liquid.sound_speed, 1.0 - FORMS.index(own.form))


@serial
def pair(p, rise, along):
    """Over V_j (dW/dr)/r: rise = p_j - p_i [Pa], along = (grad p_i + grad p_j).r_ij [Pa].

    psi_ij.r_ij of Antuono, Colagrossi, Marrone & Molteni 2010, Comput. Phys. Commun. 181, 532, Eq. 6.
    """
    if len(p) == 0:
        return 0.0
    return -p.strength * (2.0 * rise + p.corrected * along)


# of the answer, once sound has crossed the liquid: 0.0025 to 0.012 in five scenes, validation/<scene>/cost.csv; our
# choice
NOISE = 0.015


def call(scales) -> Judgement:
    """Sound that nothing damps goes to and fro as noise of the pressure; a channel that starts from rest makes none."""
    gas = scales.case.gas_phase
    if gas and gas.density_by == "summation":  # with it the effect is refused (sdph.case.check)
        return Judgement("densities that are advanced", 0.0, 1.0, "Hu & Adams 2006, Eq. 7: they are summed", 0.0)
    made = scales.pull[0] or scales.shaken or scales.thrown
    crossings = scales.liquid.sound_speed * scales.end / scales.length if made else 0.0
    return Judgement(
        "c t/L, crossings of sound", crossings, 1.0, "Marrone et al. 2011, CMAME 200, 1526", NOISE * min(1.0, crossings)
    )


EFFECT = Effect(
    name="density_diffusion",
    summary="diffusion of density in a liquid (delta-SPH)",
    parameters=DensityDiffusion,
    kernel=kernel,
    moves=True,
    matter=("liquid",),
    call=call,
)
