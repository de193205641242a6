"""Viscosity of a liquid that depends on its shear rate; it takes the place of `laminar_viscosity`.

Each particle has the viscosity of its own shear rate, from velocities around it corrected for how neighbours lie;
no-slip walls count with the velocity that friction gives them, at the place where a linear flow would have it. Pairs
take the harmonic mean in Morris' form, div(mu grad v), which is exact where flow is parallel (channels, films); what it
leaves out, (grad v)^T grad mu, matters where viscosity changes along streamlines. (Monaghan's form has it, and is 6 %
off between plates at h = 1.5 dx.)
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import prange

from sdph.effects.effect import Effect, Judgement, diffusive_limit
from sdph.engine import kernels as smoothing
from sdph.engine.geometry import apart, faster
from sdph.engine.gradients import NO_MATRIX, NO_SUMS, added, divided, in_plane
from sdph.engine.rows import entry, length
from sdph.engine.state import LIQUID
from sdph.engine.world import here
from sdph.laws import thinning as law
from sdph.laws.compiled import fast_parallel, parallel, serial
from sdph.schema import CaseError, choice, quantity, record

MODELS = ("power_law", "carreau", "herschel_bulkley")
NEEDS = {"power_law": (), "carreau": ("time",), "herschel_bulkley": ("time", "yield_stress")}  # beside what all need


@record
class ShearThinning:
    """`liquid.viscosity_Pa_s` is that at rest (carreau) or at a shear rate of 1/s (the others: K in Pa s^n)."""

    model: str = choice(*MODELS)
    index: float = quantity("", above=0.0, most=10.0)  # n: 1 Newtonian, below 1 thinning, above 1 thickening
    least_viscosity: float = quantity("Pa_s", above=0.0)
    most_viscosity: float = quantity("Pa_s", above=0.0)  # it rules the step where the liquid rests
    time: float | None = quantity("s", None, above=0.0)  # lambda of carreau; m of herschel_bulkley
    infinite_viscosity: float = quantity("Pa_s", 0.0, least=0.0)  # of carreau
    yield_stress: float | None = quantity("Pa", None, least=0.0)  # of herschel_bulkley


class ThinningP(NamedTuple):
    """Model as a place in MODELS; K or mu_0 [Pa s], n, least and most viscosity [Pa s], time
    [s], viscosity when sheared fast [Pa s], yield stress [Pa]."""

    model: int
    viscosity: float
    exponent: float
    least: float
    most: float
    time: float
    infinite: float
    yield_stress: float


def kernel(case) -> ThinningP:
    own = case.parameters["shear_thinning"]
    if "laminar_viscosity" in case.effects:
        raise CaseError("effects holds laminar_viscosity and shear_thinning, which takes its place; leave one out")
    if case.gas_phase is not None:
        raise CaseError("effects holds shear_thinning, which knows one phase; leave it or [gas_phase] out")
    if own.least_viscosity > own.most_viscosity:
        given = f"shear_thinning.least_viscosity_Pa_s = {own.least_viscosity:g}"
        raise CaseError(f"{given}; it must not be above most_viscosity_Pa_s = {own.most_viscosity:g}")
    for name in NEEDS[own.model]:
        if getattr(own, name) is None:
            key = {"time": "time_s", "yield_stress": "yield_stress_Pa"}[name]
            raise CaseError(f"shear_thinning.{key} is missing; model = {own.model!r} needs it")
    return _constants(case, own)


def _constants(case, own) -> ThinningP:
    limits = own.least_viscosity, own.most_viscosity
    more = own.time or 0.0, own.infinite_viscosity, own.yield_stress or 0.0
    return ThinningP(MODELS.index(own.model), case.liquid.viscosity, own.index, *limits, *more)


@serial
def viscosity(p, shear_rate):
    """Viscosity [Pa s] at a shear rate [1/s], within the limits."""
    if p.model == 0:
        found = law.power_law(shear_rate, p.viscosity, p.exponent)
    elif p.model == 1:
        found = law.carreau(shear_rate, p.viscosity, p.exponent, p.time, p.infinite)
    else:
        found = law.herschel_bulkley(shear_rate, p.viscosity, p.exponent, p.time, p.yield_stress)
    return min(max(found, p.least), p.most)


@fast_parallel
def images(kernel, s, rows, box, walls, volume, out):
    """Points at which a linear flow has the velocity of wall particles (sdph.methods.liquids.walls, the mean of the
    liquid in front, turned round): the mirror image of the middle of that liquid, from the particle, into out (N, 3)
    [m]."""
    for n in prange(len(walls)):
        i = walls[n]
        weight = x = y = z = 0.0
        for k in range(length(rows, i)):
            dx, dy, dz = apart(s, box, i, entry(rows, i, k))
            value = smoothing.value(kernel, math.sqrt(dx * dx + dy * dy + dz * dz))
            value = value if volume[entry(rows, i, k)] > 0.0 else 0.0
            weight += value
            x -= value * dx
            y -= value * dy
            z -= value * dz
        far = math.sqrt(x * x + y * y + z * z)
        scale = 2.0 * s.depth[i] / far - 1.0 / weight if weight > 0.0 and far > 0.0 else 0.0
        out[i, 0], out[i, 1], out[i, 2] = scale * x, scale * y, scale * z


@fast_parallel
def shear_rates(kernel, s, rows, box, active, volume, stick, image, out):
    """sqrt(2 D:D) [1/s] of the particles `active`, into out (N,); walls count `stick`, at their images; 0 where too few
    are near."""
    for n in prange(len(active)):
        i = active[n]
        matrix, sums = NO_MATRIX, NO_SUMS
        for k in range(length(rows, i)):
            j = entry(rows, i, k)
            dx, dy, dz = apart(s, box, i, j)
            du, dv, dw = faster(s, box, i, j)
            share = smoothing.slope(kernel, math.sqrt(dx * dx + dy * dy + dz * dz))
            share *= volume[j] if volume[j] > 0.0 else -stick * volume[j]
            dx, dy, dz = dx - image[j, 0], dy - image[j, 1], dz - image[j, 2]
            matrix, sums = added(matrix, sums, share, dx, dy, dz, du, dv, dw)
        ux, uy, uz, vx, vy, vz, wx, wy, wz = divided(in_plane(matrix, len(s.z) == 0), sums)
        across = (uy + vx) * (uy + vx) + (vz + wy) * (vz + wy) + (wx + uz) * (wx + uz)
        out[i] = math.sqrt(2.0 * (ux * ux + vy * vy + wz * wz) + across)


@parallel
def thin(p, active, out):
    """Shear rates (N,) [1/s] of the particles `active` become their viscosities [Pa s], in place."""
    for n in prange(len(active)):
        out[active[n]] = viscosity(p, out[active[n]])


def renew(p, method) -> None:
    """Shear rates, and viscosities by them."""
    s, common, image = (
        method.state,
        (method.kernel, method.state, method.rows, method.neighbours.box),
        np.zeros((len(method.state.x), 3)),
    )
    images(*common, method.walls, method.volume, image)
    method.domain.refresh(image)
    shear_rates(*common, method.active, method.volume, method.wall.stick, image, s.viscosity)
    thin(p, method.active, s.viscosity)
    method.domain.refresh(s.viscosity)


def dt_limit(p, case, state) -> float:
    """Sub-step limit [s] by the largest viscosity of now; before there is one, by that of the liquid at rest."""
    largest = float(state.viscosity.max(initial=0.0)) or viscosity(p, 0.0)
    return diffusive_limit(case.smoothing_length, largest / case.liquid.density)


def tells(p, state) -> dict[str, float]:
    """Smallest and largest viscosity [Pa s], and how many particles the limits hold."""
    own, world = state.viscosity[state.kind == LIQUID], here()
    held = {"at_least_viscosity": float((own <= p.least).sum()), "at_most_viscosity": float((own >= p.most).sum())}
    held = world.sums(held)
    smallest, largest = world.least(float(own.min(initial=p.most))), world.most(float(own.max(initial=p.least)))
    return {"viscosity_smallest_Pa_s": smallest, "viscosity_largest_Pa_s": largest} | held


def call(scales) -> Judgement:
    """Viscosity at the shear rate of the liquid's speed over its width, over that without the effect."""
    own = scales.case.parameters["shear_thinning"]
    p = _constants(scales.case, own)
    ratio = viscosity(p, scales.speed / scales.length) / p.viscosity if p.viscosity else math.inf
    apart = min(1.0, abs(math.log(ratio))) if 0.0 < ratio < math.inf else 1.0
    return Judgement("|ln mu(U/L)/mu|", apart, 0.01, "Bird, Armstrong & Hassager 1987, ch. 4", apart)


EFFECT = Effect(
    name="shear_thinning",
    summary="viscosity of a liquid that depends on its shear rate",
    parameters=ShearThinning,
    kernel=kernel,
    arrays=("viscosity", "depth"),
    moves=True,
    matter=("liquid",),
    dt_limit=dt_limit,
    renew=renew,
    tells=tells,
    call=call,
)
