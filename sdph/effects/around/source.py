"""The nozzles of a case as they run: streams of particles that move at the nozzle's speed until they are through it.

Upstream of each nozzle a few layers of particles wait on a lattice that ends at the mouth (`kind` INFLOW). They press
and warm like others but feel nothing, so that the density at the mouth is that of the stream. Layer n of a stream is a
pitch further back than the last, `(n + 1/2) pitch` behind the mouth at the start: the mass that came in is the rate
times time to within half a layer, whatever the steps. `nozzle` says where a particle comes from, `entering` that it is
not yet half a layer through the mouth: what other nozzles are near does not matter to it.

A nozzle of liquid is full: its particles stand still before it opens and after it closes, and their pressure is that of
the liquid in front (sdph.methods.liquids.openings).
"""

from __future__ import annotations

import numpy as np
import scipy

from sdph.effects.around import by_nozzle, rates, sizes
from sdph.effects.around.drops import Replays
from sdph.effects.around.streams import (
    in_mouth,
    layers_of,
    matter_of,
    streams_of,
    swirling,
    turned,
    without,
)
from sdph.engine import state as particles
from sdph.engine.kept import Unfit
from sdph.engine.state import GRAIN, INFLOW, LIQUID
from sdph.laws.constants import ROUND_OFF

DEPTH = 4.0  # smoothing lengths of particles upstream: the density of those that the first grain sees is whole too
BEHIND = 1.0  # l0 behind what the first of moving particles sees; swirl-sheet.md, section 2, 10
ARRAYS = ("nozzle", "entering")


class Source:
    """The nozzles of a case as they run: how many layers each stream has made, and what came in so far.

    Streams of all nozzles stand one after the other, S of them; `of` (S,) is the nozzle of each, counted from 0.
    Several sizes (sdph.effects.around.sizes) are as many streams at one place.
    """

    KEPT = ("layers", "replays", "next_ident", "mass", "energy", "motion", "masses", "momentum")  # see sdph.engine.kept

    def __init__(self, case, names, first_ident: int):
        self.case, self.names, self.pitch = case, {*names, *ARRAYS}, case.resolution.spacing
        self.inside_kind = GRAIN if case.grains else LIQUID
        self.nozzles = list(case.nozzles.values())
        self.streams = [streams_of(case, nozzle) for nozzle in self.nozzles]
        own = [sizes.of_nozzle(case, nozzle) for nozzle in self.nozzles]
        self.several = several = [len(each.share) for each in own]
        self.of = np.repeat(np.arange(len(own)), [len(s.speed) * k for s, k in zip(self.streams, several)])
        self.mouth = np.concatenate([np.repeat(s.mouth, k, axis=0) for s, k in zip(self.streams, several)])
        self.speed = np.concatenate([np.repeat(s.speed, k) for s, k in zip(self.streams, several)])
        self.most = np.concatenate(
            [np.repeat(layers_of(n, s), k) for n, s, k in zip(self.nozzles, self.streams, several)]
        )
        self.size = sizes.Sizes(
            *(
                np.concatenate([np.tile(each[part], len(s.speed)) for each, s in zip(own, self.streams)])
                for part in range(len(sizes.Sizes._fields))
            )
        )
        self.centre, self.start = np.array([n.centre for n in self.nozzles]), np.array([n.start for n in self.nozzles])
        self.end = np.array([np.inf if n.end is None else n.end for n in self.nozzles])
        self.axis = np.stack([s.axis for s in self.streams])
        widths = [
            np.linalg.norm(s.mouth - n.centre, axis=1).max(initial=0.0) for n, s in zip(self.nozzles, self.streams)
        ]
        self.reach = np.array(widths) + self.pitch
        self.values = {name: np.array(column) for name, column in self._columns().items()}
        self.trees = [scipy.spatial.cKDTree(s.mouth) for s in self.streams]
        self.replays = Replays(case)
        self.layers, self.next_ident = np.zeros(len(self.of), np.int64), first_ident
        self.mass, self.energy, self.motion = 0.0, 0.0, 0.0  # through the mouths [kg], heat and motion [J]
        self.masses = np.zeros(len(self.nozzles))  # the same of each nozzle [kg]
        self.momentum = np.zeros(3)  # [kg m/s]
        self.now = 0.0  # time [s] of the last `fill`

    @property
    def heaviest(self) -> float:
        """Largest mass [kg] of a particle that the nozzles give."""
        return max([self.replays.heaviest, *(streams.mass for streams in self.streams)])

    def _columns(self) -> dict[str, list]:
        """Array of the state -> what a particle of each nozzle has there."""
        found = {
            "mass": [s.mass for s in self.streams],
            "density": [s.alpha_p * matter_of(self.case, n).density for n, s in zip(self.nozzles, self.streams)],
            "nozzle": list(range(1, len(self.nozzles) + 1)),
        }
        if not self.case.grains:
            return found
        own = [(self.case.number(n.material), *self.case.of(n.material).of_particles) for n in self.nozzles]
        found |= dict(zip(particles.OF_MATERIAL, zip(*own)))
        return found | {"temperature": [n.temperature for n in self.nozzles]}

    def fill(self, state, time: float, dt: float):
        """The state with the layers that the window from `time` of `dt` [s] needs, and what tables give till then."""
        self.now = time
        for more in self.replays.come(self, time):
            self._count(more)
            state = particles.join(state, more)
        more = np.maximum(0, self._wanted(time, dt) - self.layers)
        if not more.any():
            return state
        gone = self.gone(time)
        stream = np.repeat(np.arange(len(more)), more)
        layer = np.arange(len(stream)) - (np.cumsum(more) - more - self.layers)[stream]
        self.layers = self.layers + more
        place = gone[stream] - (layer + 0.5) * self.pitch
        axis = self.axis[self.of[stream]]
        points, velocity = self.mouth[stream] + place[:, None] * axis, self.speed[stream, None] * axis
        for k, nozzle in enumerate(self.nozzles):
            if nozzle.shape == "annulus":
                own, first = self.of[stream] == k, np.searchsorted(self.of, k)
                points[own], velocity[own] = turned(
                    nozzle, self.streams[k], stream[own] - first, layer[own], place[own], k
                )
        return particles.join(state, self._streamed(stream, layer, points, velocity))

    def _streamed(self, stream, layer, points, velocity):
        """Particles of streams (n,) and their layers (n,), each with the size and the mass of its own; none of
        layers in which a nozzle pauses."""
        made, thickness = self.make(self.of[stream], points, velocity), np.ones(len(stream))
        for k, nozzle in enumerate(self.nozzles):
            if nozzle.rates:
                own = self.of[stream] == k
                thickness[own] = rates.thickness(nozzle, self.speed[stream[own]], self.pitch, layer[own])
        made.mass[:] *= self.size.share[stream] * thickness
        made.density[:] *= thickness
        for name, values in (("diameter", self.size.diameter), ("diameter_variance", self.size.variance)):
            if len(getattr(made, name)):
                getattr(made, name)[:] = values[stream]
        return particles.born(particles.take(made, thickness > ROUND_OFF))

    def _wanted(self, time: float, dt: float) -> np.ndarray:
        """(S,) layers that the streams make for the window from `time` of `dt` [s]."""
        gone = self.gone(time)
        depth = depth_of(self.case) + self.speed * dt
        wanted = np.floor((depth + gone) / self.pitch - 0.5 + ROUND_OFF).astype(np.int64) + 1
        return np.maximum(0, np.minimum(wanted, self.most) if self.case.grains else wanted)

    def gone(self, time: float) -> np.ndarray:
        """(S,) way [m] that the streams have gone at `time` [s]; liquid stands before its nozzle opens and after."""
        since = time if self.case.grains else np.clip(time, self.start, self.end)[self.of]
        return self.speed * (since - self.start[self.of])

    def admit_at(self, time: float, kept: dict) -> None:
        """Unfit where not the layers were made that are needed at `time` [s], or other particles than these hold."""
        layers = kept["layers"]
        least, most = self._wanted(time, 0.0), self._wanted(time, 2.0 * self.case.coupling.window_largest) + 1
        if (
            kept["next_ident"] != self.next_ident + int(layers.sum()) + sum(kept["replays"]["given"])
            or kept["replays"]["given"] != self.replays.due(time)
            or not ((layers >= least) & (layers <= most)).all()
        ):
            raise Unfit(f"the nozzles cannot have made and numbered what they have made at {time:g} s")

    def make(self, nozzle, points, velocity):
        """Particles (n,) of the nozzles (n,), counted from 0."""
        state = particles.empty(len(points), self.names, self.case.dimensions)
        speeds = zip((state.u, state.v, state.w), velocity.T)
        for array, column in (*zip(particles.axes(state), points.T), *speeds):
            array[:] = column
        for name, values in self.values.items():
            if len(getattr(state, name)):
                getattr(state, name)[:] = values[nozzle]
        state.kind[:], state.entering[:] = INFLOW, 1
        if len(state.theta):
            state.theta[:] = self.case.grains.granular_temperature
        state.ident[:] = np.arange(self.next_ident, self.next_ident + len(points))
        self.next_ident += len(points)
        return particles.born(state)

    def mouths(self, dummies) -> np.ndarray:
        """Number, from 1, of the nozzle in whose mouth or upstream of it each dummy of the walls (W,) stands; 0:
        none."""
        places = np.stack((dummies.x, dummies.y, dummies.z)[: self.case.dimensions], axis=1)
        found = np.zeros(len(places), np.int64)
        for k, nozzle in enumerate(self.nozzles):
            if len(self.streams[k].mouth):  # a table's drops come from nowhere
                along, _ = self._beyond(k, places)
                near = (along <= 0.0) & (along >= -depth_of(self.case))  # a wall further back has no mouth
                found[near & in_mouth(nozzle, places - self.centre[k])] = k + 1
        return found

    def giving(self, state, world) -> np.ndarray:
        """(nozzles + 1,) mask of the nozzles, from 1, that have particles that wait, of any process."""
        own = np.isin(np.arange(len(self.nozzles) + 1), state.nozzle[state.kind == INFLOW])
        return world.most(own.astype(float)) > 0.0

    def open(self, mouths, rows) -> None:
        """Take the dummies that stand in open mouths (W,) out of the rows of particles."""
        without(mouths, rows)

    def inside(self, state, after: float = 0.0) -> np.ndarray:
        """Share of each particle (N,) that will be through its mouth when `after` [s] has gone.

        A particle stands for a layer one pitch long, which comes in bit by bit: so the gas is displaced at an even
        rate, and not by a whole layer in the window in which its middle passes. A grain that has come in stays half in
        at least.
        """
        share, rows = np.ones(len(state.x)), np.flatnonzero(state.entering)
        if not len(rows):  # nobody has no axes to count
            return share
        along, _ = self._beyond(state.nozzle[rows] - 1, _places(state, rows, after))
        share[rows] = np.clip(along / self.pitch + 0.5, np.where(state.kind[rows] == INFLOW, 0.0, 0.5), 1.0)
        return share

    def _beyond(self, nozzle, places) -> tuple[np.ndarray, np.ndarray]:
        """Distances [m] of places (n, 3) beyond the mouths of their nozzles (n,), or of one, from 0; and from the
        axis."""
        apart, axis = places[:, : self.case.dimensions] - self.centre[nozzle], self.axis[nozzle]
        along = (apart * axis).sum(axis=1)
        return along, np.linalg.norm(apart - along[:, None] * axis, axis=1)

    def stream(self, state, rows) -> np.ndarray:
        """(n,) stream, among S, of particles (n,) that wait; of several at one place the first."""
        nozzle, places, found = state.nozzle[rows] - 1, _places(state, rows), np.zeros(len(rows), np.int64)
        along, _ = self._beyond(nozzle, places)
        for k in np.unique(nozzle):
            own = nozzle == k
            there = places[own] - along[own, None] * self.axis[k]
            found[own] = np.searchsorted(self.of, k) + self.several[k] * self.trees[k].query(there)[1]
        return found

    def release(self, state) -> None:
        """Let go of the particles that are through their mouth, with the velocity of their stream.

        Those that are half a layer away from it have entered, whatever they do later.
        """
        rows = np.flatnonzero(state.entering)
        if not len(rows):
            return
        places = _places(state, rows)
        along, aside = self._beyond(state.nozzle[rows] - 1, places)
        through = (state.kind[rows] == INFLOW) & (along > 0.0)
        self._let_go(state, rows[through], places[through, : self.case.dimensions])
        away = (np.abs(along) >= 0.5 * self.pitch) | (aside > self.reach[state.nozzle[rows] - 1])
        state.entering[rows[away & (state.kind[rows] == self.inside_kind)]] = 0

    def _let_go(self, state, rows, places) -> None:
        """Make grains or liquid of particles (n,) that are at places (n, d), and count them."""
        if not len(rows):
            return
        nozzle = state.nozzle[rows] - 1
        for k in np.unique(nozzle):
            own = nozzle == k
            velocity = self._velocity(k, places[own])
            for array, column in zip((state.u, state.v, state.w), velocity.T):
                array[rows[own]] = column
        state.kind[rows] = self.inside_kind
        self._count(particles.take(state, rows))
        if len(state.entered):
            state.entered[rows] = self.now

    def _count(self, out) -> None:
        """Count what has come in."""
        self.mass += float(out.mass.sum())
        self.masses = self.masses + by_nozzle.masses(self.case, out.nozzle, out.mass)
        if len(out.temperature):
            warmth, capacity = out.mass * out.temperature, out.grain_capacity
            of_one = self.case.grains.heat_capacity
            self.energy += float(warmth @ capacity) if len(capacity) else float(warmth.sum() * of_one)
        self.motion += particles.energy_of_motion(out)
        self.momentum = self.momentum + (out.mass[:, None] * particles.velocities(out)).sum(axis=0)

    def _velocity(self, k: int, places) -> np.ndarray:
        """Velocities (n, d) [m/s] with which places (n, d) [m] in the mouth of nozzle k are passed."""
        if self.nozzles[k].shape == "annulus":
            return swirling(self.nozzles[k], self.streams[k], places)
        return self.streams[k].velocity[self.trees[k].query(places)[1]]


def depth_of(case) -> float:
    """Depth [m] of what waits upstream of a nozzle."""
    if case.incompressible:
        return (case.method.sees(case) + BEHIND) * case.resolution.spacing
    return DEPTH * case.smoothing_length


def _places(state, rows, after: float = 0.0) -> np.ndarray:
    """(n, d) positions [m] of some particles when `after` [s] has gone."""
    moving = zip(particles.axes(state), (state.u, state.v, state.w))
    return np.stack([place[rows] + after * speed[rows] for place, speed in moving], axis=1)
