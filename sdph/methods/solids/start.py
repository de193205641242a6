"""Particles of bodies at the start of a case, and what they are made of."""

from __future__ import annotations

import itertools
import math

import numpy as np
from scipy.spatial import KDTree

from sdph.engine import lattice
from sdph.engine import state as particles
from sdph.engine.regions import disordered
from sdph.engine.state import SOLID
from sdph.laws import strength
from sdph.laws.solids import cantilever
from sdph.methods.solids.equations import Material
from sdph.methods.solids.weights import sorted_by_cell
from sdph.schema import CaseError


class Made:
    """Particles of a case, sorted by cell: state, number of the body that each belongs to (N,), those that are held
    (N,), and undeformed volumes (N,) [m^d]. `ident` counts them body by body."""

    def __init__(self, case):
        if not case.bodies:
            raise CaseError("no body: give it in a section such as [bodies.plate]")
        placed = [places(case, body) for body in case.bodies.values()]
        for name, (own, _) in zip(case.bodies, placed):
            if not len(own):
                raise CaseError(f"bodies.{name} holds no particle; enlarge it, or give a finer resolution.spacing_mm")
        _refuse_overlap(case, [points for points, _ in placed])
        points = np.concatenate([points for points, _ in placed])
        order = sorted_by_cell(points, 2.0 * case.smoothing_length)
        counts = [len(volumes) for _, volumes in placed]
        bodies = list(case.bodies.values())
        held = np.concatenate([_held(*row, points) for row, (points, _) in zip(case.bodies.items(), placed)])
        velocity = np.concatenate([_velocity(case, body, points) for body, (points, _) in zip(bodies, placed)])
        velocity[held] = 0.0
        self.body = np.repeat(np.arange(len(placed)), counts).astype(np.int32)[order]
        self.volume = np.concatenate([volumes for _, volumes in placed])[order]
        self.held = held[order]
        self.state = self._state(case, points[order], velocity[order])
        self.state.ident[:] = order

    def _state(self, case, points, velocity) -> particles.State:
        state = particles.empty(len(points), dimensions=case.dimensions)
        for axis, column in zip(particles.axes(state), points.T):
            axis[:] = column
        for array, column in zip((state.u, state.v, state.w), velocity.T):
            array[:] = column
        state.kind[:], state.density[:] = SOLID, case.solid.density
        state.mass[:] = case.solid.density * self.volume
        return state


def _refuse_overlap(case, placed: list) -> None:
    """CaseError where particles of two bodies are nearer than half a spacing."""
    trees = {name: KDTree(points) for name, points in zip(case.bodies, placed)}
    for one, other in itertools.combinations(trees, 2):
        found = trees[one].count_neighbors(trees[other], 0.5 * case.resolution.spacing)
        if found:
            raise CaseError(f"bodies.{one} and bodies.{other} overlap, {found} pairs of particles do: move them apart")


def places(case, body) -> tuple[np.ndarray, np.ndarray]:
    """Points (N, d) [m] of a body and their volumes (N,) [m^d], which fill it."""
    points, volumes = _even(body, case.resolution.spacing, case.dimensions)
    return disordered(points, body.disorder, body.seed, case.resolution.spacing), volumes


def _even(body, spacing: float, d: int) -> tuple[np.ndarray, np.ndarray]:
    """The same without disorder."""
    if body.shape == "ring":
        return flawed(body, *rings(body.centre, body.inner_radius, body.radius, spacing))
    if body.shape == "box":
        points = lattice.lattice(body, spacing, d)
        volume = math.prod(b - a for a, b in zip(body.lower, body.upper))
    else:
        points, volume = _round(body, spacing, d)
    return points, np.full(len(points), volume / max(1, len(points)))


def rings(centre, inner: float, outer: float, spacing: float) -> tuple[np.ndarray, np.ndarray]:
    """Points (N, 2) [m] of a ring in circles of as many points each, as wide as a spacing in the middle, and their
    areas (N,) [m2]."""
    layers = max(1, round((outer - inner) / spacing))
    count = _around(inner, outer, spacing)
    edges = np.linspace(inner, outer, layers + 1)
    angle = 2.0 * math.pi * np.arange(count) / count
    middle = 0.5 * (edges[1:] + edges[:-1])
    points = np.stack([np.outer(middle, np.cos(angle)), np.outer(middle, np.sin(angle))], axis=-1).reshape(-1, 2)
    areas = np.repeat(math.pi * (edges[1:] ** 2 - edges[:-1] ** 2) / count, count)
    return points + np.array(centre), areas


def flawed(body, points, areas) -> tuple[np.ndarray, np.ndarray]:
    """Points (N, 2) [m] and areas (N,) [m2] of a ring whose layers are thinner where its flaw is; its inner face
    stays."""
    away = points - np.array(body.centre)
    turn = np.arctan2(away[:, 1], away[:, 0]) - body.flaw_at
    thin = np.abs((turn + math.pi) % (2.0 * math.pi) - math.pi) <= body.flaw_half_width
    share = np.where(thin, 1.0 - body.flaw, 1.0)
    radius = np.hypot(*away.T)
    moved = body.inner_radius + share * (radius - body.inner_radius)
    return np.array(body.centre) + away * (moved / radius)[:, None], areas * share * moved / radius


def circles(case, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Numbers (N,) of the particles of the innermost and of the outermost circle of a ring, counterclockwise, as
    `Made` counts them."""
    first = 0
    for other, body in case.bodies.items():
        count = len(places(case, body)[1])
        if other == name:
            around = _around(body.inner_radius, body.radius, case.resolution.spacing)
            return first + np.arange(around), first + count - around + np.arange(around)
        first += count
    raise KeyError(name)


def _around(inner: float, outer: float, spacing: float) -> int:
    """Points of each circle of a ring."""
    return round(math.pi * (inner + outer) / spacing)


def _round(body, spacing: float, dimensions: int) -> tuple[np.ndarray, float]:
    """Points of a disc, or of a cylinder along the last axis, and its volume."""
    reach = math.ceil(body.radius / spacing)
    across = (np.arange(-reach, reach) + 0.5) * spacing
    disc = lattice.grid([across, across])
    disc = disc[(disc**2).sum(axis=1) <= body.radius**2]
    area = math.pi * body.radius**2
    if dimensions == 2:
        return disc + np.array(body.centre), area
    count = max(1, round(body.length / spacing))
    along = ((np.arange(count) + 0.5) / count - 0.5) * body.length
    points = np.concatenate([np.column_stack([disc, np.full(len(disc), z)]) for z in along])
    return points + np.array(body.centre), area * body.length


def _held(name: str, body, points) -> np.ndarray:
    if body.held_lower is None:
        return np.zeros(len(points), bool)
    held = ((points >= np.array(body.held_lower)) & (points <= np.array(body.held_upper))).all(axis=1)
    if not held.any():
        raise CaseError(
            f"bodies.{name}: no particle lies between held_lower_m = {list(body.held_lower)} and held_upper_m = "
            f"{list(body.held_upper)}, so that nothing holds it; its particles begin half a spacing inside its faces"
        )
    return held


def _velocity(case, body, points) -> np.ndarray:
    velocity = np.zeros((len(points), case.dimensions))
    if body.velocity is not None:
        velocity += np.array(body.velocity)
    if body.motion == "cantilever":
        free = body.held_upper[0]
        along = (points[:, 0] - free) / (body.upper[0] - free)
        velocity[:, 1] += body.speed * np.where(along > 0.0, cantilever(along), 0.0)
    return velocity


def moduli(case) -> tuple[float, float]:
    """K and G [Pa] of a case."""
    own = case.solid
    return (
        float(strength.bulk_modulus(own.youngs_modulus, own.poisson_ratio)),
        float(strength.shear_modulus(own.youngs_modulus, own.poisson_ratio)),
    )


def sound(case) -> float:
    """Speed [m/s] of waves of compression."""
    return float(strength.sound_speed(*moduli(case), case.solid.density))


def material(case) -> Material:
    """Elastic constants, density, sound and what steadies, for kernels."""
    own = case.solid
    return Material(*moduli(case), own.youngs_modulus, own.density, sound(case), own.viscosity, own.hourglass)


def plastic(case):
    """Parameters of plastic flow for kernels; () of an elastic solid."""
    own = case.solid
    if own.yield_stress is None:
        return ()
    softening = 1.0 - own.temperature_share**own.softening_exponent if own.temperature_share else 1.0
    return strength.Plastic(
        own.yield_stress, own.hardening, own.hardening_exponent, own.rate_factor, own.reference_rate, softening
    )


def damage(case):
    """Parameters of damage for kernels; () of a solid that does not fail."""
    own = case.solid
    if not own.failure:
        return ()
    d1, d2, d3, d4, d5 = own.failure
    warmth = 1.0 + d5 * own.temperature_share
    return strength.Damage(d1, d2, d3, d4, warmth, own.critical_damage, own.damage_begins_at)
