"""Several bubbles in a liquid: their voids told apart, each with a content of its own.

All voids together are what one bubble's is (sdph.methods.liquids.bubble). Each has the share of it that its room has on
a grid (sdph.methods.liquids.rooms), whose radius is corrected by what the grid missed at the start. Two in one room
merge: masses and heat add up. One whose room is gone, or that has shrunk to less than a particle, is closed: its vapour
condenses on the liquid there, which gets mass and latent heat. (Particles cannot tell so small a void from a gap of
theirs: none would ever fill it.) The pressure at a particle is that of the bubble whose room is nearest: rooms have any
shape, and what drifts in one, as the shreds of a film that tore, hides no part of its face.
"""

from __future__ import annotations

import math

import numpy as np

from sdph.effects.liquids import bubble as effect
from sdph.engine import state as particles
from sdph.engine.kept import Maybe
from sdph.laws import cavities
from sdph.methods.liquids import pores, rooms
from sdph.methods.liquids.bubble import Void, faced, share_of
from sdph.methods.liquids.content import Content

FACE_WITHIN = 4.0  # spacings behind the outermost row, in which a face may lie; our choice
ABOUT = 2.0  # spacings about a bubble that is gone, in which its vapour condenses; our choice


class Part(Content):
    """One of several: its middle (2,) [m], radius that the grid misses [m], whether it is still there."""

    # see sdph.engine.kept
    KEPT = (
        "area", "pressure", "mass", "temperature", "heat", "warmed", "owed", "vented", "rim", "missed", "held",
        "first", "short", "width",
    )  # fmt: skip
    FORMS = {"short": Maybe(0.0)}

    def __init__(self, p, hole):
        self.rim, self.missed = np.array(hole.centre), 0.0
        self.fill(p, cavities.void(hole.radius, 2))

    def holds(self, other) -> bool:
        """Tell whether the place of another is in this void, when both were looked for in one grid."""
        return self.pore is not None and bool(self.pore.depth[self.grid.at(*other.rim)] <= 0.0)

    def end(self) -> None:
        """Be gone."""
        self.held, self.area, self.mass, self.owed, self.pressure = False, 0.0, 0.0, 0.0, 0.0


class Voids(Void):
    """Bubbles; area, mass and so on are those of all that are left, pressure and temperature their means."""

    # see sdph.engine.kept
    KEPT = (
        "area", "passed", "rim", "missed", "corners", "named", "merged", "closed", "condensed", "torn", "unclosed",
        "pushed",
    )  # fmt: skip
    found = None  # rooms of where the particles are now, when boiling has looked for them

    def _begin(self, case, state) -> float:
        self.named = {str(n): Part(self.p, hole) for n, hole in enumerate(effect.holes_of(case), 1)}
        self.parts = list(self.named.values())
        self.merged, self.closed, self.condensed = 0, 0, 0.0
        self.area = sum(part.area for part in self.parts)
        found = self._rooms(state)
        for number, part in enumerate(self.parts):
            room = rooms.of(found, part.rim, part.radius)
            if not room or room in [rooms.of(found, other.rim, other.radius) for other in self.parts[:number]]:
                continue  # the first step closes it or merges the two
            part.missed = part.radius - math.sqrt(rooms.measure(found, room)[0] / math.pi)
        return self.area

    @property
    def left(self) -> list[Part]:
        """Bubbles that are still there."""
        return [part for part in self.parts if part.held]

    def _sum(self, name: str) -> float:
        return sum(getattr(part, name) for part in self.parts)

    def _mean(self, name: str) -> float:
        """Mean of those left by their void, of all where none is."""
        held = self.left or self.parts
        values, areas = ([getattr(part, each) for part in held] for each in (name, "area"))
        return float(np.average(values, weights=areas if self.left else None))

    mass = property(lambda self: self._sum("mass"))
    heat = property(lambda self: self._sum("heat"))
    warmed = property(lambda self: self._sum("warmed"))
    owed = property(lambda self: self._sum("owed"))
    vented = property(lambda self: self._sum("vented"))
    held = property(lambda self: bool(self.left))
    width = property(lambda self: max((part.width for part in self.left), default=0.0))
    pressure = property(lambda self: self._mean("pressure"))
    temperature = property(lambda self: self._mean("temperature"))

    def _rooms(self, state) -> rooms.Rooms:
        wet = particles.wet(state)
        points, volume = np.stack([state.x[wet], state.y[wet]], axis=1), (state.mass / state.density)[wet]
        if self.carrier:
            kept = ~self.carrier.loose()
            points = np.concatenate([points, self.carrier.places()[kept, :2]])
            volume = np.append(volume, self.carrier.volume[kept])
        return rooms.find(points, volume, self.spacing)

    def _outside(self, stepper) -> np.ndarray:
        s, reach = stepper.state, 2.0 * stepper.kernel.h
        found, self.found = self.found, None
        if not self.torn:
            self.area, found = self._whole(s), found or self._rooms(s)
            self._tell_apart(stepper, found)
        for part in self.left:
            part.swell(part.area, stepper.guard)
        depth, nearest = self._depths(s, found)
        pressure = np.array([part.pressure for part in self.parts])
        return pressure[nearest] * share_of(depth, reach)

    def _flood(self, stepper, grid: pores.Grid) -> None:
        found = []
        for part in sorted(self.left, key=lambda part: -part.area):
            part.look(grid)
            one = next((other for other in found if other.holds(part)), None)
            if one is None:
                found.append(part)
            else:
                self._merge(one, part)
                one.short = None
        for part in found:
            part.flood()
        self.area = self._sum("area")

    def _tell_apart(self, stepper, found: rooms.Rooms) -> None:
        """Give each its share of the area; merge those in one room, close those that have none, or no particle's."""
        whose, wanted = {}, {}
        for part in sorted(self.left, key=lambda part: -part.area):
            room = rooms.of(found, part.rim, part.radius)
            if room in whose:
                self._merge(whose[room], part)
            elif room and part.area > self.spacing**2:
                whose[room], (size, part.rim) = part, rooms.measure(found, room)
                wanted[id(part)] = math.pi * (math.sqrt(size / math.pi) + part.missed) ** 2
            elif len(self.left) > 1:
                self._close(stepper, part)
            else:  # what the grid no longer sees: as it was
                wanted[id(part)] = part.area
        whole = sum(wanted[id(part)] for part in self.left)
        for part in self.left:
            part.area = self.area * wanted[id(part)] / whole

    def _merge(self, part: Part, other: Part) -> None:
        """Put `other` into `part`."""
        v, boiling = self.p.vapour, 0.0
        if v:
            pairs = ((part.mass, other.mass), (part.area, other.area), (part.temperature, other.temperature))
            common, boiling = cavities.merged(v, *pairs)
            part.temperature, boiling = float(common), float(boiling)
            part.mass += other.mass + boiling
            part.owed, part.warmed = part.owed + other.owed + boiling, part.warmed - v.latent_heat * boiling
        else:  # by p A^kappa, each of its own: the gas that there is
            part.first += other.first
        part.area += other.area
        self.merged += 1
        self._tell_merged(*(self.parts.index(each) + 1 for each in (part, other)))
        other.end()

    def _tell_merged(self, one: int, other: int) -> None:
        self.news.append(f"bubble {other} has merged into bubble {one}, which goes on with what both held")

    def _close(self, stepper, part: Part) -> None:
        """Condense what is left of a bubble on the liquid about it."""
        s, own, mass = stepper.state, stepper.active, part.mass - part.owed
        share, latent = self._about(s, own, part.rim), part.mass * (self.p.vapour.latent_heat if self.p.vapour else 0.0)
        before = s.mass[own].copy()
        self.take(stepper, own, -mass * share)
        stepper.acceleration[own] *= (before / s.mass[own])[:, None]  # by the forces of now
        if stepper.heat:
            stepper.heat.give_back(own, latent * share)
        part.heat -= latent
        self.closed, self.condensed = self.closed + 1, self.condensed + mass
        part.end()

    def _about(self, s, own, place) -> np.ndarray:
        """(P,) shares of the particles `own` about a place, of the nearest alone if none is."""
        far = np.hypot(s.x[own] - place[0], s.y[own] - place[1])
        near = s.mass[own] * (far <= max(ABOUT * self.spacing, far.min()))
        return near / near.sum()

    def _depths(self, state, found: rooms.Rooms | None = None) -> tuple[np.ndarray, np.ndarray]:
        """(N,) how far [m] particles of liquid lie behind the nearest face of a bubble, infinite of others; number of
        that bubble. `found` are the rooms, where they are known."""
        depth, wet = np.full((len(self.parts), len(state.x)), np.inf), particles.wet(state)
        if wet.any() and self.torn:
            for part in self.left:
                depth[self.parts.index(part)] = np.where(wet, part.depth(state), np.inf)
        elif wet.any() and self.held:
            self._behind(found or self._rooms(state), particles.positions(state)[wet, :2], wet, depth)
        nearest = depth.argmin(axis=0)
        return depth[nearest, np.arange(len(state.x))], nearest

    def _behind(self, found: rooms.Rooms, places, wet, depth) -> None:
        """Set depth (parts, N) [m] of the `wet`, at places (W, 2) [m], behind the face of the bubble next to each. One
        that the grid does not see is round."""
        held = {number: rooms.of(found, part.rim, part.radius) for number, part in enumerate(self.parts) if part.held}
        far, room = rooms.behind(found, [own for own in held.values() if own], places)
        for number, own in held.items():
            if own:
                depth[number, wet] = np.where(room == own, far, np.inf)
            else:
                part = self.parts[number]
                depth[number, wet] = np.hypot(*(places - part.rim).T) - part.radius

    def _facing_each(self, stepper):
        """Each that is left, and (N,) [1/m] how much of its face each particle has."""
        depth, nearest = self._depths(stepper.state, self.found)
        facing = faced(stepper, depth < FACE_WITHIN * self.spacing)
        return [(part, np.where(nearest == self.parts.index(part), facing, 0.0)) for part in self.left]

    def near(self, state) -> np.ndarray:
        depth, _ = self._depths(state)
        return depth < FACE_WITHIN * self.spacing

    def boil(self, stepper, dt: float) -> None:
        s, own = stepper.state, stepper.active
        self._facing(stepper, np.zeros(len(s.x)))
        self.found = None if self.torn else self._rooms(s)  # pressing needs them next, of the same places
        for part, facing in self._facing_each(stepper):
            lost = part.evaporate(dt, s.mass[own] * facing[own])
            if lost is not None:
                self.take(stepper, own, lost)

    def take_up(self, stepper, conductance, dt: float) -> tuple[np.ndarray, np.ndarray]:
        _, nearest = self._depths(stepper.state)
        heat, lost = np.zeros_like(conductance), np.zeros_like(conductance)
        for number, part in enumerate(self.parts):
            if part.held:
                own = np.where(nearest == number, conductance, 0.0)
                gave, boiled = part.soak(own, stepper.state.temperature, dt)
                heat, lost = heat + gave, lost + boiled
        return heat, lost

    def vent(self, dt: float) -> None:
        for part in self.left:
            part.vent(dt)

    def row(self) -> dict[str, float]:
        told = super().row() | {"bubbles_left": len(self.left)}
        for number, part in enumerate(self.parts, 1):
            told |= {f"bubble_{number}_diameter_m": 2.0 * part.radius, f"bubble_{number}_pressure_Pa": part.pressure}
            if self.p.vapour:
                told |= {f"bubble_{number}_kg": part.mass, f"bubble_{number}_K": part.temperature}
        return told

    def summary(self) -> dict[str, float]:
        told = {f"bubble_{number}_diameter_m": 2.0 * part.radius for number, part in enumerate(self.parts, 1)}
        counts = {"bubbles_left": len(self.left), "bubbles_merged": self.merged, "bubbles_closed": self.closed}
        return super().summary() | told | counts | {"condensed_at_closure_kg": self.condensed}


def of(case, p, state, bodies) -> Void:
    """The bubble of a case where it is one in the middle of the liquid, or its bubbles, wherever they are."""
    first, *others = effect.holes_of(case)
    central = math.dist(first.centre, effect.pool_of(case).centre) <= effect.SAME * first.radius
    return (Void if central and not others else Voids)(case, p, state, bodies)
