"""Eddies of a turbulent gas that push grains and droplets about: drag sees them beside the mean velocity."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import prange

from sdph.effects.effect import Effect, Judgement
from sdph.laws import dispersion as law
from sdph.laws import drag, turbulence
from sdph.laws.compiled import parallel
from sdph.schema import CaseError, quantity, record, whole

MODELS = ("kEpsilon", "kOmegaSST")  # of the gas, that solve for k and a rate of its loss
AXES = ("eddy_x", "eddy_y", "eddy_z")  # arrays of the state


@record
class TurbulentDispersion:
    lifetime: float = quantity("", law.LIFETIME, above=0.0)
    seed: int = whole(0, least=0)


class TurbulentDispersionP(NamedTuple):
    """Lifetime of eddies over k/epsilon [-]; seed; density of grains [kg/m3] and viscosity of the gas [Pa s]."""

    lifetime: float
    seed: int
    grain_density: float
    viscosity: float


def kernel(case) -> TurbulentDispersionP:
    own, gas = case.parameters["turbulent_dispersion"], case.gas
    if not gas.turbulent or gas.turbulence.model not in MODELS:
        raise CaseError(
            "the effect turbulent_dispersion needs k and epsilon of the gas; give [gas.turbulence] a model of these: "
            f"{', '.join(MODELS)}"
        )
    return TurbulentDispersionP(own.lifetime, own.seed, case.grains.density, gas.viscosity)


def stir(p, state, seen, drift, time: float, dt: float) -> tuple[np.ndarray, np.ndarray]:
    """Mean velocity of eddies past each particle over a window of `dt` [s] from `time` [s] on, (N, 3) [m/s], and n
    (N, 3) at its end (sdph.laws.dispersion). drift (N,) [m/s] is the slip of the mean of the grains, by which they
    fall through eddies: their own slip is of the eddies too. Chance is told by seed, time and number of a particle,
    so that a window taken again, or by a run continued, has the same."""
    before = np.zeros((len(state.x), 3))
    for axis, name in enumerate(AXES):
        if len(getattr(state, name)):
            before[:, axis] = getattr(state, name)
    after, mean = np.zeros_like(before), np.zeros_like(before)
    when = np.array([time]).view(np.uint64)[0] ^ np.uint64(p.seed % 2**64)
    fields = (seen.fields[name] for name in EFFECT.fields)
    axes = 3 if len(state.eddy_z) else 2
    _stir(p, state.ident, state.diameter, drift, seen.density, *fields, when, dt, axes, before, after, mean)
    return mean, after


@parallel
def _stir(p, ident, diameter, drift, density, k, epsilon, slope, when, dt, axes, before, after, mean):
    """The loop of `stir`; slope (N, 3) [m/s2] is the gradient of k."""
    for i in prange(len(ident)):
        sigma, T = law.fluctuation(k[i]), law.memory(k[i], epsilon[i], drift[i], p.lifetime)
        stopping = p.grain_density / drag.schiller_naumann(0.0, drift[i], diameter[i], density[i], p.viscosity)
        x, follows = dt / T, T / (T + stopping)
        drawn = before[i, 0] != 0.0  # of those that are new nothing is known: they are drawn now
        along, apart = law.spreads_of_mean(x)
        for axis in range(axes):
            word = law.scrambled(when + np.uint64(3 * ident[i] + axis))
            first, second = law.two_normal(word)
            begun = before[i, axis] if drawn else law.two_normal(law.scrambled(word))[0]
            pull = follows * slope[i, axis] / (3.0 * sigma) * T
            after[i, axis] = pull + law.kept(x) * (begun - pull) + law.spread(x) * first
            share = law.kept_in_mean(x)
            mean[i, axis] = sigma * (pull + share * (begun - pull) + along * first + apart * second)


def apply(state, after) -> None:
    """Keep n (N, 3) of a window that has been."""
    for axis, name in enumerate(AXES):
        if len(getattr(state, name)):
            getattr(state, name)[:] = after[:, axis]


def begins_with(gas, speed: float) -> tuple[float, float]:
    """k [m2/s2] and epsilon [m2/s3] of a gas at its start, whose fastest inlet has a `speed` [m/s]; 0 and 1 without a
    model that knows them."""
    own = gas.turbulence
    if not gas.turbulent or own.model not in MODELS:
        return 0.0, 1.0
    k = turbulence.kinetic_energy(speed, own.intensity) if own.k is None else own.k
    if own.mixing_length:
        return k, turbulence.dissipation(k, own.mixing_length)
    return k, turbulence.C_MU * k * own.omega if own.epsilon is None else own.epsilon


def call(scales) -> Judgement:
    """Way that eddies spread grains over the run, by Taylor's law, over the width of what they are in."""
    name, source = "way of eddies / width", "Taylor 1921, Proc. London Math. Soc. 20, 196"
    k, epsilon = begins_with(scales.gas, scales.jet)
    if not k:
        return Judgement(name, 0.0, 0.01, source, 0.0)
    T = law.memory(k, epsilon, 0.0, law.LIFETIME)
    x = scales.end / T
    way = law.fluctuation(k) * T * math.sqrt(2.0 * (x + math.expm1(-x))) * T / (T + scales.drag_time)
    return Judgement(name, way / scales.length, 0.01, source, min(1.0, way / scales.length))


EFFECT = Effect(
    name="turbulent_dispersion",
    summary="eddies of a turbulent gas spread grains and droplets",
    parameters=TurbulentDispersion,
    kernel=kernel,
    arrays=("diameter", "diameter_variance", *AXES),
    sources=("alpha_g", "momentum", "momentum_coefficient", "heat"),
    fields=("turbulent_energy", "turbulent_dissipation", "turbulent_energy_gradient"),
    moves=True,
    call=call,
)
