"""Pressure gradient of the gas on the grains: -grad P / rho_p per mass (alpha_p cancels; paper section 2.1)."""

from __future__ import annotations

from typing import NamedTuple

from sdph.effects.effect import Effect
from sdph.schema import record


@record
class GasPressure:
    """Has no input of its own."""


class GasPressureP(NamedTuple):
    """Grain density [kg/m3]."""

    grain_density: float


def kernel(case) -> GasPressureP:
    return GasPressureP(case.grains.density)


EFFECT = Effect(
    name="gas_pressure", summary="pressure gradient of the gas on the grains", parameters=GasPressure, kernel=kernel,
    sources=("alpha_g",), moves=True,
)  # fmt: skip
