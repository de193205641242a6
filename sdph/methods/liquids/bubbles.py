"""The bubbles of a liquid: their voids told apart, what is in each, and their pressure on the liquid.

All voids together are sdph.methods.liquids.hollow's. Each has the share of it that its room has on a grid
(sdph.methods.liquids.rooms), whose radius is corrected by what the grid missed at the start. Two in one room merge:
masses and heat add up. One whose room is gone, or that has shrunk to less than a particle, is closed: its vapour
condenses on the liquid there, which gets mass and latent heat. (Particles cannot tell so small a void from a gap of
theirs: none would ever fill it.) In a torn shell voids are flooded once a window (sdph.methods.liquids.pores), from the
area on that they have then.

Pressure: -2 p_b is added to p_i + p_j of pairs behind the face of a bubble, a share of it that falls to 0 within two
reaches of the kernel. The sum of V_j grad W vanishes inside, which leaves p_b on the face alone. p_b is that of the
bubble whose room is nearest: rooms have any shape, and what drifts in one, as the shreds of a film that tore, hides no
part of its face. What is given back is not equal and opposite pair by pair: what the sum over closed voids misses is
taken back (sdph.methods.liquids.closed). Of one with a way out it is the thrust of what leaves, in
`impulse_of_bubble_*`.
"""

from __future__ import annotations

import math

import numpy as np

from sdph.effects.liquids import bubble as effect
from sdph.engine import state as particles
from sdph.laws import cavities
from sdph.methods.liquids import closed, faces, pores, rooms, totals
from sdph.methods.liquids.content import Content
from sdph.methods.liquids.hollow import Hollow

FACE_WITHIN = 4.0  # spacings behind the outermost row, in which a face may lie; our choice
ABOUT = 2.0  # spacings about a bubble that is gone, in which its vapour condenses; our choice


class Bubbles:
    """Bubbles; area, mass and so on are those of all that are left, pressure and temperature their means.

    passed (5,): mass, momentum and energy that the liquid gave to them, and mass that they still owe, of this step's
    warming; unclosed (2,) and pushed: impulse [N s] that their push was off by while closed, and all its impulses."""

    # see sdph.engine.kept
    KEPT = ("area", "passed", "hollow", "named", "merged", "closed", "condensed", "torn", "unclosed", "pushed")
    found = None  # rooms of where the particles are now, when boiling has looked for them

    def __init__(self, case, p, state, bodies=None):
        self.p, self.spacing, self.torn = p, case.resolution.spacing, False
        self.carrier = bodies.carrier if bodies and bodies.carrier.shell else None
        self.named = {str(n): Content(p, hole) for n, hole in enumerate(effect.holes_of(case), 1)}
        self.parts = list(self.named.values())
        self.merged, self.closed, self.condensed, self.area = 0, 0, 0.0, self._sum("area")
        self._correct(state)
        self.hollow = Hollow(state, effect.pool_of(case).centre, self.carrier, self.area)
        self.passed, self.unclosed, self.pushed = np.zeros(5), np.zeros(2), 0.0
        self.news: list[str] = []  # for the user, until somebody has passed them on

    def revive(self) -> None:
        """Forget news of the start: they were told before the checkpoint."""
        self.news.clear()

    def _correct(self, state) -> None:
        """Find what the grid misses of each bubble's radius; two in one room are left to the first step, which merges
        them, and one without a room to what closes it."""
        found = self._rooms(state)
        own = [rooms.of(found, part.rim, part.radius) for part in self.parts]
        for number, (part, room) in enumerate(zip(self.parts, own)):
            if room and room not in own[:number]:
                part.missed = part.radius - math.sqrt(rooms.measure(found, room)[0] / math.pi)

    @property
    def left(self) -> list[Content]:
        """Bubbles that are still there."""
        return [part for part in self.parts if part.held]

    def _sum(self, name: str) -> float:
        return sum(getattr(part, name) for part in self.parts)

    def _mean(self, name: str) -> float:
        """Mean of those left by their void, of all where none is."""
        held = self.left or self.parts
        values, areas = ([getattr(part, each) for part in held] for each in (name, "area"))
        return float(np.average(values, weights=areas if self.left else None))

    radius = property(lambda self: math.sqrt(self.area / math.pi))  # [m] of a round void as large as all
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

    def press(self, stepper, dt: float) -> None:
        """Add to the accelerations of a stepper, which hold for `dt` [s]; what was added is its `inflating` (N, 3)
        [m/s2]."""
        self._facing(stepper, self._outside(stepper))
        if not self.width:
            self._close_up(stepper, dt)
        stepper.acceleration += stepper.inflating

    def _close_up(self, stepper, dt: float) -> None:
        """Take from `inflating` what pushes or turns the liquid as a whole, and count it."""
        own, mass = stepper.active, stepper.state.mass[stepper.active]
        places = particles.positions(stepper.state)[own, :2]
        taken, net, whole = closed.close(places, mass[:, None] * stepper.inflating[own, :2])
        stepper.inflating[own, :2] -= taken / mass[:, None]
        self.unclosed, self.pushed = self.unclosed + dt * net, self.pushed + dt * whole

    def open(self, stepper) -> None:
        """Flood, before a window, what a torn shell still holds, and find its way out."""
        shell = self.carrier
        self.torn = bool(shell and shell.torn)
        if self.torn and self.held:
            wet = particles.positions(stepper.state)[stepper.active, :2]
            points = np.concatenate([wet, shell.places()[~shell.loose(), :2], shell.links()])
            self._flood(pores.find(points, self.spacing))

    def _outside(self, stepper) -> np.ndarray:
        """(N,) [Pa] that is taken off pairs of particles."""
        s, reach = stepper.state, 2.0 * stepper.kernel.h
        found, self.found = self.found, None
        if not self.torn:
            self.area, found = self.hollow.area(s, self.area), found or self._rooms(s)
            self._tell_apart(stepper, found)
        for part in self.left:
            part.swell(part.area, stepper.guard)
        depth, nearest = self._depths(s, found)
        pressure = np.array([part.pressure for part in self.parts])
        return pressure[nearest] * faces.share_of(depth, reach)

    def _facing(self, stepper, outside) -> None:
        s = stepper.state
        faces.press(
            stepper.kernel, s, stepper.rows, stepper.neighbours.box, stepper.active, stepper.volume, outside,
            stepper.inflating, stepper.facing,
        )  # fmt: skip

    def _flood(self, grid: pores.Grid) -> None:
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
        """Give each its share of the area; merge those in one room, close those that have none, but the last one."""
        whose, wanted = {}, {}
        for part in sorted(self.left, key=lambda part: -part.area):
            room = rooms.of(found, part.rim, part.radius)
            if room in whose:
                self._merge(whose[room], part)
            elif room and part.area > self.spacing**2:
                whose[room], (size, part.rim) = part, rooms.measure(found, room)
                wanted[part] = math.pi * (math.sqrt(size / math.pi) + part.missed) ** 2
            elif len(self.left) > 1:
                self._close(stepper, part)
        sizes = [wanted.get(part, part.area) for part in self.left]
        for part, size in zip(self.left, sizes):
            part.area = self.area * size / sum(sizes)

    def _merge(self, part: Content, other: Content) -> None:
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

    def _close(self, stepper, part: Content) -> None:
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

    def face(self, stepper) -> tuple[np.ndarray, np.ndarray]:
        """(N,) [1/m] how much of a bubble's face each particle has, and the number of that bubble."""
        depth, nearest = self._depths(stepper.state, self.found)
        return faces.at(stepper, depth < FACE_WITHIN * self.spacing), nearest

    def boil(self, stepper, dt: float) -> None:
        """Boil for `dt` [s]: take mass off the liquid at the faces, by how much of each particle is at one."""
        s, own = stepper.state, stepper.active
        self._facing(stepper, np.zeros(len(s.x)))
        self.found = None if self.torn else self._rooms(s)  # pressing needs them next, of the same places
        facing, nearest = self.face(stepper)
        for part in self.left:
            lost = part.evaporate(dt, s.mass[own] * np.where(nearest == self.parts.index(part), facing, 0.0)[own])
            if lost is not None:
                self.take(stepper, own, lost)

    def take_up(self, stepper, conductance, dt: float) -> tuple[np.ndarray, np.ndarray]:
        """Heat (N,) [J] of the particles, and mass (N,) [kg] that boils off them, as `soak` has them; a conductance
        (N,) [W m/K] is that of as much face."""
        facing, nearest = self.face(stepper)
        heat, lost = np.zeros_like(conductance), np.zeros_like(conductance)
        for part in self.left:
            own = np.where(nearest == self.parts.index(part), conductance * facing, 0.0)
            gave, boiled = part.soak(own, stepper.state.temperature, dt)
            heat, lost = heat + gave, lost + boiled
        return heat, lost

    def take(self, stepper, own, lost) -> None:
        """Take mass (P,) [kg] off the particles `own`, with what it carries."""
        s, (kinetic, elastic) = stepper.state, totals.specific_energies(stepper, own)
        self.passed += [lost.sum(), *(lost @ particles.velocities(s)[own]), float(lost @ (kinetic + elastic))]
        s.mass[own] -= lost
        if stepper.heat:
            stepper.heat.carry(own, lost)

    def vent(self, dt: float) -> None:
        """Let vapour out for dt [s] through the ways out."""
        for part in self.left:
            part.vent(dt)

    def row(self) -> dict[str, float]:
        """Columns of history.csv."""
        told = {"bubble_area_m2": self.area, "bubble_pressure_Pa": self.pressure}
        if self.p.vapour:
            told |= {"bubble_mass_kg": self.mass, "bubble_temperature_K": self.temperature, "vented_kg": self.vented}
        told["bubbles_left"] = len(self.left)
        for number, part in enumerate(self.parts, 1):
            told |= {f"bubble_{number}_diameter_m": 2.0 * part.radius, f"bubble_{number}_pressure_Pa": part.pressure}
            if self.p.vapour:
                told |= {f"bubble_{number}_kg": part.mass, f"bubble_{number}_K": part.temperature}
        return told

    def summary(self) -> dict[str, float]:
        """Bubbles in the end; `bubble_impulse_rel` is the impulse that is off over all that closed voids push."""
        off = float(np.hypot(*self.unclosed))
        told = {f"bubble_{number}_diameter_m": 2.0 * part.radius for number, part in enumerate(self.parts, 1)}
        told |= {"bubbles_left": len(self.left), "bubbles_merged": self.merged, "bubbles_closed": self.closed}
        told["bubble_impulse_rel"] = off / self.pushed if self.pushed else 0.0
        return told | {"condensed_at_closure_kg": self.condensed}
