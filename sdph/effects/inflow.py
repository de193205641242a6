"""Grains that come in through nozzles: streams of particles that move at the nozzle's speed until they are through it.

Upstream of each nozzle a few layers of particles wait on a lattice that ends at the mouth (`kind` INFLOW and up). They
press and warm like others but feel nothing, so that the density at the mouth is that of the stream. Layer n of a stream
is half a pitch further back than the last, `(n + 1/2) pitch` behind the mouth at the start: the mass that came in is
the rate times time to within half a layer, whatever the steps.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from sdph import particles
from sdph.effects.effect import Effect, Judgement
from sdph.particles import GRAIN, INFLOW
from sdph.schema import CaseError, choice, quantity, record, vector

DEPTH = 4.0  # smoothing lengths of particles upstream: the density of those that the first grain sees is whole too
ROUND_OFF = 1e-9  # of a layer, or of a length


@record
class Nozzle:
    """A mouth that grains leave at `speed`: a slot, a disc, or a cone, whose streams spread up to `half_angle`."""

    shape: str = choice("slot", "disc", "cone")
    centre: tuple = vector("m")
    direction: tuple = vector("")
    speed: float = quantity("m_s", above=0.0)  # mean over the mouth
    temperature: float = quantity("K", above=0.0)
    volume_fraction: float | None = quantity("", None, above=0.0, most=1.0)  # either this
    rate: float | None = quantity("kg_s", None, above=0.0)  # or this, per metre of depth in two dimensions
    profile: str = choice("uniform", "parabolic")  # of the speed; parabolic: none at the rim
    width: float | None = quantity("m", None, above=0.0)  # of a slot
    length: float | None = quantity("m", None, above=0.0)  # of a slot in three dimensions
    across: tuple | None = vector("", None)  # direction of its width
    radius: float | None = quantity("m", None, above=0.0)  # of a disc or cone; in two dimensions half the mouth's width
    half_angle: float = quantity("deg", 0.0, least=0.0, most=80.0)
    diameter: float | None = quantity("mm", None, above=0.0)  # of the grains; none: those of [grains]
    diameter_std: float | None = quantity("mm", None, least=0.0)
    start: float = quantity("s", 0.0, least=0.0)
    end: float | None = quantity("s", None, above=0.0)


@record
class Inflow:
    """Has no input of its own: see [nozzles]."""

    def patches(self, case) -> list:
        """What comes in, for `sdph.explain.scales`."""
        from sdph.explain.scales import Patch

        for name, nozzle in case.nozzles.items():
            _check(case, name, nozzle)
        return [_patch(case, nozzle, Patch) for nozzle in case.nozzles.values()]


def _patch(case, nozzle, patch):
    half = 0.5 * (nozzle.width or 2.0 * (nozzle.radius or 0.0))
    velocity = tuple(nozzle.speed * a for a in unit(nozzle.direction))
    lower, upper = (tuple(c + sign * half for c in nozzle.centre) for sign in (-1.0, 1.0))
    return patch(streams_of(case, nozzle).alpha_p, nozzle.temperature, velocity, lower, upper, nozzle.half_angle)


class InflowP(NamedTuple):
    """Number of nozzles."""

    nozzles: int


def kernel(case) -> InflowP:
    if not case.nozzles:
        raise CaseError("the effect inflow needs a nozzle; give one in [nozzles.some_name]")
    for name, nozzle in case.nozzles.items():
        _check(case, name, nozzle)
    return InflowP(len(case.nozzles))


def _check(case, name: str, nozzle: Nozzle) -> None:
    where = f"nozzles.{name}"
    if (nozzle.volume_fraction is None) == (nozzle.rate is None):
        raise CaseError(f"{where}: give either volume_fraction or rate_kg_s")
    for key, unit_of in (("centre", "_m"), ("direction", "")):
        if len(getattr(nozzle, key)) != case.dimensions:
            raise CaseError(f"{where}.{key}{unit_of} has {len(getattr(nozzle, key))} components; dimensions = {case.dimensions} asks for {case.dimensions}")
    if nozzle.shape == "disc" and case.dimensions == 2:
        raise CaseError(f"{where}.shape = 'disc' is for three dimensions; in two a mouth is a slot or a cone")
    needs = ("width", "length")[: case.dimensions - 1] if nozzle.shape == "slot" else ("radius",)
    for key in needs:
        if getattr(nozzle, key) is None:
            raise CaseError(f"{where}.{key}_m is missing; a {nozzle.shape} in {case.dimensions} dimensions needs it")
    if nozzle.half_angle and nozzle.shape != "cone":
        raise CaseError(f"{where}.half_angle_deg is of a cone; shape = {nozzle.shape!r}")
    if not np.linalg.norm(nozzle.direction) > 0.0:
        raise CaseError(f"{where}.direction = {list(nozzle.direction)}; it must point somewhere")
    if nozzle.across and case.dimensions == 3 and _parallel(nozzle.across, nozzle.direction):
        aside = f"it must point aside of direction = {list(nozzle.direction)}"
        raise CaseError(f"{where}.across = {list(nozzle.across)}; {aside}")
    if nozzle.end is not None and nozzle.end <= nozzle.start:
        raise CaseError(f"{where}.end_s = {nozzle.end:g} must come after start_s = {nozzle.start:g}")
    alpha_p = streams_of(case, nozzle).alpha_p
    if alpha_p > case.grains.packing_limit:
        raise CaseError(f"{where} makes a volume fraction of {alpha_p:.3g}, above grains.packing_limit = {case.grains.packing_limit}; slow down or widen it")


def _parallel(a, b) -> bool:
    """Whether two vectors of space span no plane."""
    return bool(np.linalg.norm(np.cross(a, b)) <= ROUND_OFF * np.linalg.norm(a) * np.linalg.norm(b))


def unit(vector_) -> np.ndarray:
    """A vector of length 1."""
    a = np.asarray(vector_, float)
    return a / np.linalg.norm(a)


class Streams(NamedTuple):
    """S streams of one nozzle: places in the mouth (S, d) [m], axis (d,), speed along it (S,) [m/s], velocity at the mouth
    (S, d), mass of a particle [kg], layer pitch [m], volume fraction."""

    mouth: np.ndarray
    axis: np.ndarray
    speed: np.ndarray
    velocity: np.ndarray
    mass: float
    pitch: float
    alpha_p: float


def streams_of(case, nozzle: Nozzle) -> Streams:
    """The streams of a nozzle, on a lattice of the case's spacing that is fitted to the area of the mouth."""
    spacing, axis = case.resolution.spacing, unit(nozzle.direction)
    offsets, area, reach = _mouth(case, nozzle, axis)
    distance = np.linalg.norm(offsets, axis=1)
    speed = np.full(len(offsets), nozzle.speed)
    if nozzle.profile == "parabolic":
        along = np.abs(offsets @ _tangents(nozzle, axis)[0]) if nozzle.shape == "slot" else distance
        speed = 1.0 - (along / reach) ** 2
        speed *= nozzle.speed / speed.mean()
    angle = nozzle.half_angle * distance / reach
    outward = offsets / np.maximum(distance, 1e-300)[:, None]
    velocity = speed[:, None] * (np.cos(angle)[:, None] * axis + np.sin(angle)[:, None] * outward)
    speed = speed * np.cos(angle)
    alpha_p = nozzle.volume_fraction or nozzle.rate / (case.grains.density * area * speed.mean())
    mass = alpha_p * case.grains.density * area / len(offsets) * spacing
    return Streams(np.array(nozzle.centre) + offsets, axis, speed, velocity, mass, spacing, alpha_p)


def _tangents(nozzle: Nozzle, axis) -> list[np.ndarray]:
    """Unit vectors in the plane of the mouth; the first along the width."""
    if len(axis) == 2:
        return [np.array([-axis[1], axis[0]])]
    given = nozzle.across or np.eye(3)[np.argmin(np.abs(axis))]
    first = unit(given - (np.asarray(given) @ axis) * axis)
    return [first, np.cross(axis, first)]


def _mouth(case, nozzle: Nozzle, axis) -> tuple[np.ndarray, float, float]:
    """Offsets (S, d) [m] of the streams from the centre, area of the mouth [m2 or m], distance of its rim [m]."""
    spacing, tangents = case.resolution.spacing, _tangents(nozzle, axis)
    if nozzle.shape == "slot" or case.dimensions == 2:
        sizes = (nozzle.width, nozzle.length) if nozzle.shape == "slot" else (2.0 * nozzle.radius,)
        sizes = sizes[: len(tangents)]
        ticks = [_ticks(size, spacing) for size in sizes]
        grid = np.stack([m.ravel() for m in np.meshgrid(*ticks, indexing="ij")], axis=1)
        return grid @ np.stack(tangents), math.prod(sizes), 0.5 * sizes[0]
    n = math.ceil(nozzle.radius / spacing) + 1
    ticks = (np.arange(-n, n) + 0.5) * spacing
    grid = np.stack([m.ravel() for m in np.meshgrid(ticks, ticks, indexing="ij")], axis=1)
    grid = grid[(grid**2).sum(axis=1) <= nozzle.radius**2]
    if not len(grid):
        raise CaseError(f"resolution.spacing_mm = {spacing * 1e3:g} is too coarse for a nozzle of radius {nozzle.radius * 1e3:g} mm; give it less")
    area = math.pi * nozzle.radius**2
    return grid * math.sqrt(area / len(grid)) / spacing @ np.stack(tangents), area, nozzle.radius


def _ticks(size: float, spacing: float) -> np.ndarray:
    count = max(1, round(size / spacing))
    return size * ((np.arange(count) + 0.5) / count - 0.5)


class Source:
    """The nozzles of a case as they run: how many layers each stream has made, and what came in so far."""

    KEPT = ("layers", "next_ident", "mass", "energy", "momentum")  # see sdph.restart

    def __init__(self, case, names, first_ident: int):
        self.case, self.names = case, names
        self.nozzles = list(case.nozzles.values())
        self.streams = [streams_of(case, nozzle) for nozzle in self.nozzles]
        self.reach = [
            np.linalg.norm(s.mouth - np.array(n.centre), axis=1).max() + s.pitch for s, n in zip(self.streams, self.nozzles)
        ]
        self.layers = [np.zeros(len(streams.speed), np.int64) for streams in self.streams]
        self.next_ident = first_ident
        self.mass, self.energy, self.momentum = 0.0, 0.0, np.zeros(3)  # through the mouths [kg], [J], [kg m/s]

    def fill(self, state, time: float, dt: float):
        """The state with the layers that the window from `time` of `dt` [s] needs."""
        for k in range(len(self.nozzles)):
            fresh = self._fresh(k, time, dt)
            state = particles.join(state, fresh) if len(fresh.x) else state
        return state

    def _fresh(self, k: int, time: float, dt: float):
        nozzle, streams = self.nozzles[k], self.streams[k]
        gone = streams.speed * (time - nozzle.start)
        depth = DEPTH * self.case.smoothing_length + streams.speed * dt
        wanted = np.floor((depth + gone) / streams.pitch - 0.5 + ROUND_OFF).astype(np.int64) + 1
        if nozzle.end is not None:
            wanted = np.minimum(wanted, np.round(streams.speed * (nozzle.end - nozzle.start) / streams.pitch).astype(np.int64))
        made, more = self.layers[k], np.maximum(0, wanted - self.layers[k])
        stream = np.repeat(np.arange(len(more)), more)
        layer = np.concatenate([np.arange(a, a + n) for a, n in zip(made, more)]) if more.sum() else np.zeros(0)
        self.layers[k] = made + more
        place = gone[stream] - (layer + 0.5) * streams.pitch
        return self._particles(k, streams.mouth[stream] + place[:, None] * streams.axis, streams.speed[stream, None] * streams.axis)

    def _particles(self, k: int, points, velocity):
        nozzle, grains, d = self.nozzles[k], self.case.grains, self.case.dimensions
        state = particles.empty(len(points), self.names, d)
        for array, column in zip(particles.axes(state), points.T):
            array[:] = column
        for array, column in zip((state.u, state.v, state.w)[:d], velocity.T):
            array[:] = column
        values = {
            "mass": self.streams[k].mass,
            "density": self.streams[k].alpha_p * grains.density,
            "kind": INFLOW + k,
            "temperature": nozzle.temperature,
            "diameter": nozzle.diameter or grains.diameter,
            "diameter_variance": (grains.diameter_std if nozzle.diameter_std is None else nozzle.diameter_std) ** 2,
            "theta": grains.granular_temperature,
        }
        for name, value in values.items():
            getattr(state, name)[:] = value
        state.ident[:] = np.arange(self.next_ident, self.next_ident + len(points))
        self.next_ident += len(points)
        return particles.born(state)

    def waiting(self, state) -> np.ndarray:
        """Mask of the particles that are upstream of their mouth."""
        mask = np.zeros(len(state.x), bool)
        for k in range(len(self.streams)):
            rows = np.flatnonzero(state.kind == INFLOW + k)
            if len(rows):
                mask[rows] = self._beyond(k, particles.positions(state)[rows])[0] <= 0.0
        return mask

    def inside(self, state, after: float = 0.0) -> np.ndarray:
        """Share of each particle (N,) that will be through its mouth when `after` [s] has gone.

        A particle stands for a layer one pitch long, which comes in bit by bit: so the gas is displaced at an even
        rate, and not by a whole layer in the window in which its middle passes.
        """
        share = np.ones(len(state.x))
        places = particles.positions(state) + after * particles.velocities(state)
        for k, streams in enumerate(self.streams):
            rows = np.flatnonzero((state.kind == INFLOW + k) | (state.kind == GRAIN))
            along, aside = self._beyond(k, places[rows])
            near = (np.abs(along) < 0.5 * streams.pitch) & (aside <= self.reach[k])
            share[rows[near]] = along[near] / streams.pitch + 0.5
            behind = (state.kind[rows] >= INFLOW) & (along <= -0.5 * streams.pitch)
            share[rows[behind]] = 0.0
        return share

    def _beyond(self, k: int, places) -> tuple[np.ndarray, np.ndarray]:
        """Distances [m] of places (n, 3) beyond the mouth of nozzle k, and from its axis."""
        apart = places[:, : self.case.dimensions] - np.array(self.nozzles[k].centre)
        along = apart @ self.streams[k].axis
        return along, np.linalg.norm(apart - np.outer(along, self.streams[k].axis), axis=1)

    def release(self, state) -> None:
        """Let go of the particles that are through their mouth, with the direction of their stream."""
        through = (state.kind >= INFLOW) & ~self.waiting(state)
        if not through.any():
            return
        d = self.case.dimensions
        for k in np.unique(state.kind[through]) - INFLOW:
            rows = np.flatnonzero(through & (state.kind == INFLOW + k))
            streams = self.streams[k]
            offset = particles.positions(state)[rows, :d] - np.array(self.nozzles[k].centre)
            offset -= np.outer(offset @ streams.axis, streams.axis)
            nearest = ((offset[:, None] + np.array(self.nozzles[k].centre) - streams.mouth[None]) ** 2).sum(axis=2).argmin(axis=1)
            for array, column in zip((state.u, state.v, state.w)[:d], streams.velocity[nearest].T):
                array[rows] = column
        state.kind[through] = GRAIN
        velocity = particles.velocities(state)[through]
        self.mass += float(state.mass[through].sum())
        if len(state.temperature):
            self.energy += float((state.mass[through] * state.temperature[through]).sum() * self.case.grains.heat_capacity)
        self.momentum = self.momentum + (state.mass[through, None] * velocity).sum(axis=0)


def call(scales) -> Judgement:
    """Nozzles that the case has."""
    count = len(scales.case.nozzles)
    return Judgement("nozzles", float(count), 1.0, "the case", float(count > 0))


EFFECT = Effect(name="inflow", summary="grains that come in through nozzles", parameters=Inflow, kernel=kernel, moves=True, call=call)
