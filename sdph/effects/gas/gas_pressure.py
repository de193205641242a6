"""Pressure gradient of the gas on the grains: -grad P / rho_p per mass (alpha_p cancels; paper section 2.1)."""

from __future__ import annotations

import math
from typing import NamedTuple

from sdph.effects.effect import Effect, Judgement
from sdph.schema import record


@record
class GasPressure:
    """Has no input of its own."""


class GasPressureP(NamedTuple):
    """Grain density [kg/m3]."""

    grain_density: float


def kernel(case) -> GasPressureP:
    return GasPressureP(case.grains.density)


def call(scales) -> Judgement:
    """Share of the gas's force on grains that its pressure gradient gives: that of the displaced mixture."""
    share = scales.alpha_p + scales.gas.density / scales.grains.density if scales.slip else 0.0
    # how far the gas moves grains
    grip = 0.0 if scales.resting else scales.rim * -math.expm1(-scales.end / scales.drag_time)
    source = "Anderson & Jackson 1967: grad P carries alpha_p of the gas's force"
    return Judgement("alpha_p + rho_g/rho_p", share, 0.01, source, share * grip)


EFFECT = Effect(
    name="gas_pressure", summary="pressure gradient of the gas on the grains", parameters=GasPressure, kernel=kernel,
    sources=("alpha_g",), moves=True, call=call,
)  # fmt: skip
