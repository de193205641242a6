"""Heat exchange between grains and gas: eps (T_g - T_p), paper Eq. 4 and 5."""

from __future__ import annotations

import math
from typing import NamedTuple

from sdph.effects.effect import Effect, Judgement
from sdph.effects.gas import sizes
from sdph.laws import heat as law
from sdph.laws.compiled import inlined, serial
from sdph.schema import choice, record

LAWS = ("gunn", "gunn_interstitial", "ranz_marshall")
CLOSURES = ("geometric", "paper")


@record
class Heat:
    law: str = choice(*LAWS)
    closure: str = choice(*CLOSURES)  # 6 alpha_p/d, or that times alpha_g (paper Eq. 4)


class HeatP(NamedTuple):
    """law and closure as places in LAWS and CLOSURES; gas k [W/m/K], mu [Pa s], Pr; grain density [kg/m3]."""

    law: int
    closure: int
    conductivity: float
    viscosity: float
    prandtl: float
    grain_density: float


def kernel(case) -> HeatP:
    gas, chosen = case.gas, case.parameters["heat"]
    prandtl = law.prandtl_number(gas.viscosity, gas.heat_capacity, gas.conductivity)
    places = LAWS.index(chosen.law), CLOSURES.index(chosen.closure)
    return HeatP(*places, gas.conductivity, gas.viscosity, prandtl, case.grains.density)


@serial
def nusselt(p, alpha_g, reynolds):
    if p.law == 0:
        return law.gunn(alpha_g, reynolds, p.prandtl)
    if p.law == 1:
        return law.gunn_interstitial(alpha_g, reynolds, p.prandtl)
    return law.ranz_marshall(alpha_g, reynolds, p.prandtl)


@inlined
def conductance(p, sizes_p, s, i, alpha_p, slip, gas_density):
    """Heat exchanged per kelvin [W/K] by the grains of particle i; `slip` [m/s]. Eq. 20: mass average over sizes."""
    if len(p) == 0:
        return 0.0
    alpha_g, total, whole = 1.0 - alpha_p, 0.0, 0.0
    own = sizes.birth(sizes_p, s, i)
    for q in range(sizes.classes(sizes_p)):
        d, mass = sizes.grain(sizes_p, s, i, own, q)
        if mass == 0.0:  # gone; what comes after is smaller still
            break
        nu = nusselt(p, alpha_g, gas_density * slip * d / p.viscosity)
        if p.closure == 0:
            eps = law.exchange_geometric(alpha_g, nu, p.conductivity, d)
        else:
            eps = law.exchange_paper(alpha_g, nu, p.conductivity, d)
        total += mass * eps
        whole += mass
    rho = s.grain_density[i] if len(s.grain_density) else p.grain_density
    return s.mass[i] / rho * total / whole


def call(scales) -> Judgement:
    """Time of the run over the time in which grains or the gas among them take each other's temperature."""
    both = not scales.case.coupling.one_way
    time = min(scales.heat_time, scales.gas_heat_time) if both else scales.heat_time
    felt = scales.end / time if scales.span and scales.alpha_p else 0.0
    source = "Crowe, Sommerfeld & Tsuji 1998, ch. 2: thermal response time"
    return Judgement("run / thermal response time", felt, 0.01, source, -math.expm1(-felt))


EFFECT = Effect(
    name="heat",
    summary="heat exchange between grains and gas",
    parameters=Heat,
    kernel=kernel,
    arrays=("temperature", "diameter", "diameter_variance", "received", "exchanged"),
    sources=("alpha_g", "heat", "heat_coefficient"),
    call=call,
)
