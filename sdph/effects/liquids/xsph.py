"""XSPH: particles of one phase move with the mean velocity around them, which keeps phases from mingling."""

from __future__ import annotations

from typing import NamedTuple

from sdph.effects.effect import Effect, Judgement
from sdph.laws.compiled import serial
from sdph.schema import quantity, record


@record
class Xsph:
    # epsilon of Monaghan 1992; of the gas-liquid paper too: liquids.md, part L
    strength: float = quantity("", 0.5, above=0.0, most=1.0)


JUMP, MINGLED = 10.0, 0.1  # of densities; share of the liquid that mingles with the gas without: our estimate


class XsphP(NamedTuple):
    """epsilon [-]."""

    strength: float


def kernel(case) -> XsphP:
    return XsphP(case.parameters["xsph"].strength)


@serial
def share(p, m_j, rho_i, rho_j, value):
    """Share of v_j - v_i that particle i moves with: eps m_j W/rho_ij, rho_ij the mean. Monaghan 1992, Annu. Rev.
    Astron. Astrophys. 30, 543, Eq. 2.12."""
    return p.strength * m_j * value / (0.5 * (rho_i + rho_j))


def call(scales) -> Judgement:
    """Phases mingle where nothing but p_i + p_j holds them apart; the Riemann form needs no XSPH."""
    gas = scales.case.gas_phase
    jump = scales.liquid.density / gas.density if gas and gas.interaction == "plain" else 0.0
    return Judgement(
        "rho/rho_gas of plain pairs",
        jump,
        JUMP,
        "Colagrossi & Landrini 2003, J. Comput. Phys. 191, 448",
        MINGLED if jump >= JUMP else 0.0,
    )


EFFECT = Effect(
    name="xsph",
    summary="a liquid's particles move with the mean velocity around them (XSPH)",
    parameters=Xsph,
    kernel=kernel,
    moves=True,
    matter=("liquid",),
    call=call,
)
