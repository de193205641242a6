"""Shares of grains that a limiter holds, as effects tell them in `held` (sdph.effects.effect)."""

from __future__ import annotations

from numba import prange

from sdph.engine import arrays, softening
from sdph.engine.state import GRAIN, by_material
from sdph.engine.world import here
from sdph.laws import granular
from sdph.laws.compiled import parallel


def share(state, held) -> float:
    """Mean of `held` (N,), true or false or a part of 1, over the particles in the gas, of all processes; 0 where there
    are none."""
    inside = state.kind == GRAIN
    if len(state.copy):
        inside &= state.copy == 0
    return here().mean(held if inside.all() else held[inside])


def capped(p, state) -> dict[str, float]:
    """Share of the particles that closures take for less packed than they are (sdph.laws.granular.capped_fraction)."""
    most = granular.capped_fraction(1.0, p.packing)
    return {
        "alpha_p_capped_share": share(state, state.density / by_material(state.grain_density, p.grain_density) > most)
    }


def unenclosed(method) -> dict[str, float]:
    """Share of the particles that neighbours do not enclose, so that viscosity, of agitation and of contacts, is of
    Morris' form."""
    return {"unenclosed_share": share(method.state, method.scratch.strain[2] == 0.0)}


def softened(p, method) -> dict[str, float]:
    """The part that r^2 + 0.01 h^2 in place of r^2 takes off the pairs in the gas (sdph.engine.softening)."""
    s = method.state
    return softening.held(method, "cubic_spline", arrays.chosen(s.kind == GRAIN), s.mass)


def streaming(p, state, factor: float, name: str) -> dict[str, float]:
    """Share of the particles whose free path `granular.streaming_share` limits, and the mean part of the kinetic
    coefficient `name` that this takes away."""
    taken = arrays.empty(len(state.x), state.x)
    _taken(p, state.density / by_material(state.grain_density, p.grain_density), state.diameter, factor, taken)
    return {f"knudsen_{name}_share": share(state, taken > 0.0), f"knudsen_{name}_rel": share(state, taken)}


@parallel
def _taken(p, alpha_p, diameter, factor, part):
    for i in prange(len(part)):
        a = granular.capped_fraction(alpha_p[i], p.packing)
        g0 = granular.sinclair_jackson(a, p.packing)
        part[i] = 1.0 - granular.streaming_share(a, p.restitution, g0, diameter[i], factor, p.h)
