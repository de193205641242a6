"""Grains or liquid that come in through nozzles (sdph.effects.around.source)."""

from __future__ import annotations

from typing import NamedTuple

from sdph.effects.around import sizes
from sdph.effects.around.nozzles import check
from sdph.effects.around.source import ARRAYS
from sdph.effects.around.streams import Patch, streams_of, unit
from sdph.effects.effect import Effect, Judgement
from sdph.engine import state as particles
from sdph.engine.state import INFLOW
from sdph.schema import CaseError, record


@record
class Inflow:
    """Has no input of its own: see [nozzles]."""

    def patches(self, case) -> list:
        """Grains that come in, one patch a nozzle, for `sdph.methods.grains.scales`."""
        for name, nozzle in case.nozzles.items():
            check(case, name, nozzle)
        return [_patch(case, nozzle) for nozzle in case.nozzles.values()]


def _patch(case, nozzle) -> Patch:
    half = 0.5 * (nozzle.width or 2.0 * (nozzle.radius or 0.0))
    velocity = tuple(nozzle.speed * a for a in unit(nozzle.direction))
    lower, upper = (tuple(c + sign * half for c in nozzle.centre) for sign in (-1.0, 1.0))
    alpha_p, diameter = streams_of(case, nozzle).alpha_p, sizes.own_diameter(case, nozzle)
    largest = sizes.largest(case, nozzle)
    return Patch(alpha_p, nozzle.temperature, velocity, lower, upper, nozzle.half_angle, diameter, largest)


class InflowP(NamedTuple):
    """Number of nozzles."""

    nozzles: int


def kernel(case) -> InflowP:
    if not case.nozzles:
        raise CaseError("the effect inflow needs a nozzle; give one in [nozzles.some_name]")
    for name, nozzle in case.nozzles.items():
        check(case, name, nozzle)
    return InflowP(len(case.nozzles))


def held(p, method) -> dict[str, float]:
    """Number of particles upstream of a nozzle, outside the domain, which stand in for its edge in the gas."""
    s = method.domain.own(method.state)
    places, domain = particles.positions(s)[s.kind == INFLOW], method.case.domain
    low, high = (*domain.corner, 0.0)[:3], (*domain.upper, 0.0)[:3]
    beside = int(((places < low) | (places > high)).any(axis=1).sum())
    return {"upstream_particles": float(method.world.sum(beside))}


def call(scales) -> Judgement:
    """Nozzles that the case has."""
    count = len(scales.case.nozzles)
    return Judgement("nozzles", float(count), 1.0, "the case", float(count > 0))


EFFECT = Effect(
    name="inflow",
    summary="grains or liquid that come in through nozzles",
    parameters=Inflow,
    kernel=kernel,
    arrays=ARRAYS,
    moves=True,
    matter=("grains", "liquid"),
    held=held,
    sums=("injected_kg", "left_kg"),
    call=call,
)
