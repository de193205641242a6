"""Contact: particles of two kinds of matter, or of two bodies, that come nearer than a spacing push each other apart.

    F_ij = k dx (1 - r/dx) r_ij/r  for r < dx,   k = rho c^2 dx^(d-2)

a spring as stiff as the liquid around (our choice: a particle pressed in by half a spacing feels rho c^2/2 on its
face), equal and opposite, so that what one loses the other gains. Between methods it is found once a window and holds
over it; between bodies of one method it is found every step, and its energy comes back.
"""

from __future__ import annotations

import math

import numpy as np
import scipy

from sdph.engine import state as particles
from sdph.engine.kept import GROWING, Maybe, Unfit
from sdph.laws.compiled import serial

STEADY = 0.2  # of sqrt(m/k), the time of the spring: longest that its force may be held; our choice


SKIN = 1.0  # spacings by which pairs that may touch are looked for beyond contact; our choice


class Contact:
    """Springs between the particles of two methods: `spacing` [m], `stiffness` k [N/m]."""

    def __init__(self, spacing: float, stiffness: float):
        self.spacing, self.stiffness = spacing, stiffness

    def limit(self, lightest: float) -> float:
        """Longest window [s] over which the force on a particle of a mass [kg] may hold."""
        return STEADY * math.sqrt(lightest / self.stiffness)

    def near(self, first: np.ndarray, second: np.ndarray) -> bool:
        """True where any two are so near, within two spacings, that they may touch in the next window."""
        return (
            bool(len(first) and len(second))
            and scipy.spatial.cKDTree(first).count_neighbors(scipy.spatial.cKDTree(second), 2.0 * self.spacing) > 0
        )

    def forces(self, first: np.ndarray, second: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Forces (N, 3) and (M, 3) [N] on particles at `first` (N, 3) and `second` (M, 3) [m]."""
        on_first, on_second = np.zeros_like(first), np.zeros_like(second)
        if not len(first) or not len(second):
            return on_first, on_second
        found = scipy.spatial.cKDTree(first).sparse_distance_matrix(
            scipy.spatial.cKDTree(second), self.spacing, output_type="ndarray"
        )
        i, j, r = found["i"], found["j"], found["v"]
        apart = (first[i] - second[j]) / np.maximum(r, np.finfo(float).tiny)[:, None]
        force = (self.stiffness * (self.spacing - r))[:, None] * apart
        np.add.at(on_first, i, force)
        np.add.at(on_second, j, -force)
        return on_first, on_second


def between(case) -> Contact:
    """Contact of grains with the liquid of a case, or of any method with it."""
    spacing, own = case.resolution.spacing, case.liquid
    return Contact(spacing, own.density * own.sound_speed**2 * spacing ** (case.dimensions - 2))


class Touching:
    """The same springs among particles of one method that no link holds: bodies against each other, and what has
    broken off against all. Two that are nearer than a spacing when one of them breaks off push from that distance on:
    else the tear would throw them."""

    KEPT = ("near", "rest", "built")  # see sdph.engine.kept
    FORMS = {"near": GROWING, "rest": GROWING, "built": Maybe(np.zeros((0, 3)))}

    def __init__(self, contact: Contact, body):
        self.contact, self.body = contact, body
        self.pairs, self.lengths, self.built = np.zeros((0, 2), np.int64), np.zeros(0), None
        self.near, self.rest = np.zeros(0, np.int64), np.zeros(0)  # pairs, as `_keys` names them, and distances [m]

    def admit(self, kept: dict) -> None:
        """Unfit where distances are not one a pair, or pairs stand in no order."""
        if len(kept["near"]) != len(kept["rest"]) or (np.diff(kept["near"]) <= 0).any():
            raise Unfit("distances of what has broken off are not one a pair")
        if kept["built"] is not None and len(kept["built"]) != len(self.body):
            raise Unfit("pairs that may touch are of other particles")

    def break_off(self, state, before, free) -> None:
        """Remember the distances of those that are nearer than a spacing and are loose now, but were not `before`."""
        pairs = _within(here := particles.positions(state), self.contact.spacing)
        pairs = pairs[self._loose(pairs, free) & ~self._loose(pairs, before)]
        keys = np.concatenate([self.near, self._keys(pairs)])
        rest = np.concatenate([self.rest, particles.lengths(here[pairs[:, 0]] - here[pairs[:, 1]])])
        order = np.argsort(keys)
        self.near, self.rest, self.built = keys[order], rest[order], None

    def update(self, state, free) -> None:
        """Find the pairs that may touch, where particles have moved by half the skin; `free` (N,) 1 of what has broken
        off."""
        here = particles.positions(state)
        if self.built is not None:
            far = ((here - self.built) ** 2).sum(axis=1).max(initial=0.0)
            if far < (0.5 * SKIN * self.contact.spacing) ** 2:
                return
        self.built = here
        self.find(free)

    def find(self, free) -> None:
        """Make the pairs of where particles were at the last look, if there was one."""
        if self.built is None:
            return
        pairs = _within(self.built, (1.0 + SKIN) * self.contact.spacing)
        pairs = pairs[self._loose(pairs, free)]
        self.pairs = pairs[np.lexsort(pairs.T)]  # in one order, whenever they were found
        self.lengths = np.full(len(pairs), self.contact.spacing)
        found = np.isin(keys := self._keys(self.pairs), self.near)
        self.lengths[found] = self.rest[np.searchsorted(self.near, keys[found])]

    def forces(self, state, acceleration) -> float:
        """Add to accelerations (N, 3) [m/s2]; the energy [J] of the springs."""
        return _press(self.contact.stiffness, state, self.pairs, self.lengths, acceleration)

    def _loose(self, pairs, free) -> np.ndarray:
        first, second = pairs.T
        return (self.body[first] != self.body[second]) | (free[first] != 0) | (free[second] != 0)

    def _keys(self, pairs) -> np.ndarray:
        """One number for each pair."""
        return pairs[:, 0] * len(self.body) + pairs[:, 1]


def _within(places, reach: float) -> np.ndarray:
    """Pairs (M, 2) of `places` (N, 3) nearer than `reach` [m]."""
    return scipy.spatial.cKDTree(places).query_pairs(reach, output_type="ndarray")


@serial
def _press(stiffness, s, pairs, lengths, acceleration):
    energy = 0.0
    for n in range(len(pairs)):
        i, j = pairs[n]
        dx, dy, dz = s.x[i] - s.x[j], s.y[i] - s.y[j], s.z[i] - s.z[j] if len(s.z) else 0.0
        r = math.sqrt(dx * dx + dy * dy + dz * dz)
        if r < lengths[n]:
            force = stiffness * (lengths[n] - r) / r
            energy += 0.5 * stiffness * (lengths[n] - r) ** 2
            for a, apart in enumerate((dx, dy, dz)):
                acceleration[i, a] += force * apart / s.mass[i]
                acceleration[j, a] -= force * apart / s.mass[j]
    return energy
