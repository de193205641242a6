"""Lift on grains and droplets, L (v_g - v_p) x curl v_g, held over a window; the gas gets the opposite."""

from __future__ import annotations

import math
from typing import NamedTuple

from sdph.effects.effect import Effect, Judgement
from sdph.effects.gas import sizes
from sdph.laws import lift as law
from sdph.laws.compiled import inlined, serial
from sdph.schema import choice, record

LAWS = ("saffman_mei", "saffman")


@record
class Lift:
    law: str = choice(*LAWS)


class LiftP(NamedTuple):
    """Law as a place in LAWS; gas viscosity [Pa s]; grain density [kg/m3]."""

    law: int
    viscosity: float
    grain_density: float


def kernel(case) -> LiftP:
    return LiftP(LAWS.index(case.parameters["lift"].law), case.gas.viscosity, case.grains.density)


@serial
def coefficient(p, slip, spin, d, gas_density):
    """L [kg/m3] of the law chosen."""
    if p.law == 0:
        return law.saffman_mei(slip, spin, d, gas_density, p.viscosity)
    return law.saffman(slip, spin, d, gas_density, p.viscosity)


@inlined
def force(p, sizes_p, s, i, around, slip):
    """(x, y, z) [N] on all grains of particle i in the gas `around` (sdph.exchange.equations.Around): mass average over
    its sizes."""
    if len(p) == 0:
        return 0.0, 0.0, 0.0
    x, y, z = around.vorticity[i, 0], around.vorticity[i, 1], around.vorticity[i, 2]
    spin, total, whole = math.sqrt(x * x + y * y + z * z), 0.0, 0.0
    own = sizes.birth(sizes_p, s, i)
    for q in range(sizes.classes(sizes_p)):
        d, mass = sizes.grain(sizes_p, s, i, own, q)
        if mass == 0.0:  # gone; what comes after is smaller still
            break
        total += mass * coefficient(p, slip, spin, d, around.density[i])
        whole += mass
    rho = s.grain_density[i] if len(s.grain_density) else p.grain_density
    push = s.mass[i] / rho * total / whole
    u, v, w = around.apart[i, 0], around.apart[i, 1], around.apart[i, 2]
    return push * (v * z - w * y), push * (w * x - u * z), push * (u * y - v * x)


def call(scales) -> Judgement:
    """Lift over drag of the fastest gas past the grains, that changes over the length on which their motion does."""
    s, source = scales, "Mei 1992; Crowe, Sommerfeld & Tsuji 1998, ch. 4"
    if not s.slip:
        return Judgement("lift / drag", 0.0, 0.01, source, 0.0)
    shear = s.slip / s.shear_length
    own = law.saffman_mei(s.slip, shear, s.grains.diameter, s.gas.density, s.gas.viscosity)
    share = own * shear * s.drag_time / s.grains.density
    return Judgement("lift / drag", share, 0.01, source, min(1.0, share * s.rim * -math.expm1(-s.end / s.drag_time)))


EFFECT = Effect(
    name="lift",
    summary="lift of sheared gas on grains and droplets",
    parameters=Lift,
    kernel=kernel,
    arrays=("diameter", "diameter_variance"),
    sources=("alpha_g", "momentum", "heat"),
    fields=("vorticity",),
    holds_force=True,
    moves=True,
    sums=("impulse_of_gone_kg_m_s",),
    call=call,
)
