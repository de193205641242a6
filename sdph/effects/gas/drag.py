"""Drag between grains and gas, beta (v_g - v_p), and the heat it makes."""

from __future__ import annotations

import math
from typing import NamedTuple

from sdph.effects.effect import Effect, Judgement
from sdph.effects.gas import sizes
from sdph.laws import drag as law
from sdph.laws.compiled import inlined, serial
from sdph.schema import CaseError, choice, quantity, record

LAWS = (
    "gidaspow",
    "ergun",
    "wen_yu",
    "gidaspow_paper",
    "gidaspow_switch",
    "syamlal_obrien",
    "di_felice",
    "beetstra",
    "schiller_naumann",
    "putnam",
    "stokes",
)


@record
class Drag:
    law: str = choice(*LAWS)
    filter: str = choice("none", "igci")
    filter_cells: float = quantity("", 2.0, above=0.0)  # as MFIX


class DragP(NamedTuple):
    """Law as a place in LAWS; gas viscosity [Pa s]; grain density [kg/m3]; share of clusters
    that cells do not resolve [-] (sdph.laws.drag.igci_filter)."""

    law: int
    viscosity: float
    grain_density: float
    unresolved: float = 0.0


def kernel(case) -> DragP:
    own = case.parameters.get("drag") or Drag()  # who judges whether a case calls for drag asks without it
    unresolved = law.igci_filter(filter_width(case)) if own.filter == "igci" else 0.0
    return DragP(LAWS.index(own.law), case.gas.viscosity, case.grains.density, unresolved)


def terminal(s) -> float:
    """Speed [m/s] at which a lone grain of the scales `s` falls in the end, however short the run."""
    heavy = math.hypot(*s.weight)
    return law.terminal_velocity(s.grains.diameter, s.grains.density, s.gas.density, s.gas.viscosity, heavy)


def filter_width(case) -> float:
    """Width of the filter g Delta/v_t^2 [-], Delta of `filter_cells` cells; those of an own mesh count with the width
    that the case gives."""
    gas, grains, gravity = case.gas, case.grains, math.hypot(*case.domain.gravity)
    terminal = law.terminal_velocity(grains.diameter, grains.density - gas.density, gas.density, gas.viscosity, gravity)
    if not terminal:
        raise CaseError(
            'drag.filter = "igci" goes by the speed at which a grain falls, and here it does not: give '
            "domain.gravity_m_s2 and grains heavier than the gas, or leave it out"
        )
    return gravity * case.parameters["drag"].filter_cells * case.resolution.cell / terminal**2


@serial
def coefficient(p, alpha_p, slip, d, gas_density):
    """beta/alpha_p [kg/m3/s] of the law chosen."""
    mu = p.viscosity
    if p.law == 0:
        return law.gidaspow(alpha_p, slip, d, gas_density, mu)
    if p.law == 1:
        return law.ergun(alpha_p, slip, d, gas_density, mu)
    if p.law == 2:
        return law.wen_yu(alpha_p, slip, d, gas_density, mu)
    if p.law == 3:
        return law.gidaspow_paper(alpha_p, slip, d, gas_density, mu)
    if p.law == 4:
        return law.gidaspow_switch(alpha_p, slip, d, gas_density, mu)
    if p.law == 5:
        return law.syamlal_obrien(alpha_p, slip, d, gas_density, mu)
    if p.law == 6:
        return law.di_felice(alpha_p, slip, d, gas_density, mu)
    if p.law == 7:
        return law.beetstra(alpha_p, slip, d, gas_density, mu)
    if p.law == 8:
        return law.schiller_naumann(alpha_p, slip, d, gas_density, mu)
    if p.law == 9:
        return law.putnam(alpha_p, slip, d, gas_density, mu)
    return law.stokes(alpha_p, slip, d, gas_density, mu)


@inlined
def damping(p, sizes_p, s, i, alpha_p, slip, gas_density):
    """beta/(alpha_p rho_p) [1/s] of particle i: the mass average over its sizes (paper section 2.1, R'^SPH)."""
    if len(p) == 0:
        return 0.0
    total = whole = 0.0
    own = sizes.birth(sizes_p, s, i)
    for q in range(sizes.classes(sizes_p)):
        d, mass = sizes.grain(sizes_p, s, i, own, q)
        if mass == 0.0:  # gone; what comes after is smaller still
            break
        total += mass * coefficient(p, alpha_p, slip, d, gas_density)
        whole += mass
    return resolved(p, alpha_p) * total / whole / (s.grain_density[i] if len(s.grain_density) else p.grain_density)


@serial
def resolved(p, alpha_p):
    """Share of the drag that is left by clusters which cells do not resolve; 1 without a filter."""
    return 1.0 - p.unresolved * law.igci_clusters(alpha_p) if p.unresolved else 1.0


def of_one_size(p, grains, alpha_p: float, slip: float, gas_density: float) -> float:
    """beta/(alpha_p rho_p) [1/s] of the mean size of `grains`, a section of a case, in a `slip` [m/s]."""
    found = coefficient(p, alpha_p, slip, grains.diameter, gas_density) / grains.density
    return resolved(p, alpha_p) * found


def call(scales) -> Judgement:
    """Time of the run over the time in which drag stops a grain or, sooner, the gas among grains."""
    felt = scales.end / min(scales.drag_time, scales.gas_drag_time) if scales.slip else 0.0
    source = "Crowe, Sommerfeld & Tsuji 1998, ch. 2: momentum response time"
    return Judgement("run / drag response time", felt, 0.01, source, -math.expm1(-felt))


EFFECT = Effect(
    name="drag",
    summary="drag between grains and gas, and its heat",
    parameters=Drag,
    kernel=kernel,
    arrays=("diameter", "diameter_variance"),
    sources=("alpha_g", "momentum", "momentum_coefficient", "heat"),
    moves=True,
    call=call,
)
