"""Liquid that leaves the tank through its outlet, as much as is commanded.

`debt`: the lowest particle loses mass as it is commanded, its volume with it, and goes when it has none left. The mass
in the tank is the commanded one at every instant.
`paper`: whole particles go, as many as have been commanded so far, rounded (paper T, Eq. 12, cumulatively). Each goes
to the outlet's end within `interval` at an even speed (Eq. 13), with the pressure of a wall, and its push on the others
fades (Eq. 14). Its speed, an outcome of the interval, is left out of what the others feel.
"""

from __future__ import annotations

import itertools
import math
from typing import NamedTuple

from sdph.effects.around import tank
from sdph.effects.around.streams import streams_of
from sdph.effects.effect import Effect, Judgement
from sdph.engine import lattice, regions
from sdph.schema import CaseError, choice, quantity, record

FORMS = ("debt", "paper")


@record
class Drain:
    """The commanded fill falls evenly from that at `start` to `fill` at `end`."""

    form: str = choice(*FORMS)
    interval: float = quantity("s", 0.01, above=0.0)  # of `paper`: in which a particle leaves, the paper's dynamic step
    fill: float = quantity("", least=0.0, most=1.0)
    start: float = quantity("s", 0.0, least=0.0)
    end: float = quantity("s", above=0.0)


class DrainP(NamedTuple):
    """0: debt, 1: whole particles."""

    form: int


def kernel(case) -> DrainP:
    own, first = case.parameters["drain"], filled(case)
    *across, down = case.domain.gravity
    if any(case.domain.gravity) and not -down > max(map(abs, across)):
        raise CaseError(
            f"domain.gravity_m_s2 = {list(case.domain.gravity)}, but a drain takes out what lies lowest along the last "
            "axis: gravity must point down it; turn the case, or leave the drain out"
        )
    command(own, first)
    if own.fill > first:
        raise CaseError(
            f"drain.fill = {own.fill:g} is more than the {first:g} of the tank that pools, and nozzles until "
            "drain.start_s, have filled; a drain takes out"
        )
    return DrainP(FORMS.index(own.form))


def filled(case) -> float:
    """Share of the tank that is full when the drain opens, by the pools of a case and by what nozzles have brought."""
    room, d = tank.shape_of(case).volume, case.dimensions
    _refuse_unknown_fill(case)
    pools = case.pools.values()
    share = sum(pool.fill if pool.shape == "tank" else regions.closed_form(pool, d) / room for pool in pools)
    return min(share + sum(_brought(case, nozzle) for nozzle in case.nozzles.values()) / room, 1.0)


def _refuse_unknown_fill(case) -> None:
    """CaseError where the pools of a case do not tell how full its tank is: they overlap, or stand beside its own."""
    for one, other in itertools.combinations(case.pools, 2):
        here, there = case.pools[one], case.pools[other]
        if "tank" in (here.shape, there.shape):
            raise CaseError(
                f"effects holds drain, and pools.{one} and pools.{other} do not tell how full the tank is: give one "
                'pool of shape "tank", or boxes, discs and spheres'
            )
        places = lattice.lattice(there, case.resolution.spacing, case.dimensions)
        if regions.holds(here, places).any():
            raise CaseError(f"effects holds drain, and pools.{one} and pools.{other} overlap: cut one of them short")


def _brought(case, nozzle) -> float:
    """Volume [m^d] of liquid that a nozzle has brought when the drain opens."""
    streams, closes = streams_of(case, nozzle), math.inf if nozzle.end is None else nozzle.end
    rate = streams.mass / streams.pitch * float(streams.speed.sum()) / case.liquid.density
    return rate * max(min(case.parameters["drain"].start, closes) - nozzle.start, 0.0)


def command(own: Drain, first: float):
    """t -> commanded fill, from `first` at the start."""
    if own.end <= own.start:
        raise CaseError(f"drain.end_s = {own.end:g} must come after drain.start_s = {own.start:g}")

    def fill(time: float) -> float:
        share = min(max((time - own.start) / (own.end - own.start), 0.0), 1.0)
        return first + share * (own.fill - first)

    return fill


def speed(case, drawn: float = 0.0) -> float:
    """Mean speed [m/s] at which the commanded liquid goes through the outlet pipe, or one that is `drawn` in the tank
    itself, of so large a section [m^(d-1)]; 0 without a pipe."""
    own, radius = case.parameters["drain"], case.parameters["tank"].outlet_radius
    area = (math.pi * radius**2 if case.dimensions == 3 else 2.0 * radius) or drawn
    drained = (filled(case) - own.fill) * tank.shape_of(case).volume
    return drained / (own.end - own.start) / area if area else 0.0


def call(scales) -> Judgement:
    """Share of the liquid that is to leave within the run."""
    own = scales.case.parameters["drain"]
    first = filled(scales.case)
    share = 1.0 - command(own, first)(scales.end) / first if first else 0.0
    return Judgement("share that is drained", share, 0.01, "the command", share)


EFFECT = Effect(
    name="drain",
    summary="commanded outflow of a liquid",
    parameters=Drain,
    kernel=kernel,
    moves=True,
    matter=("liquid",),
    call=call,
)
