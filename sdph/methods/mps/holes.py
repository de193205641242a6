"""Holes of a sheet: where they begin, and how their rims go.

Tension of pairs moves a rim at 0.15 to 0.43 of the speed of Taylor and Culick (validation/moving_particles), and hardly
pulls a sheet thinner than a layer. So a rim is carried: within a circle that grows at that speed u from half the
thickness on, about a middle that flies with the sheet, whatever goes outward slower than u goes at u. What one particle
gains the others of the circle lose: the kicks of a hole have no sum.

Where circles meet there is a ligament, and none pushes; what comes in faster than u/2 is of another rim and flies on.
Circles do not stretch with the sheet.
"""

from __future__ import annotations

import functools
from typing import NamedTuple

import numpy as np
import scipy

from sdph.engine import state as particles
from sdph.engine.kept import GROWING, Unfit
from sdph.engine.world import ALONE
from sdph.laws import sheets
from sdph.methods.mps import films

# of the reach: a sheet goes on all round where the middle of the neighbours, along it, is nearer; an edge has 0.42
ALL_ROUND = 0.25
BESIDE = 0.5  # l0 along the sheet from a site to the middle of its hole, so that the site leaves it too; our choice
IN = 0.5  # of a rim's speed: what comes in faster is of another one; our choice
FEWEST = 3  # neighbours that make a plane


class Opened(NamedTuple):
    """Holes (M,) that have opened, as columns: site's number, time [s], speed of the rim [m/s], radius at first [m],
    middle then (M, 3) [m], its velocity (M, 3) [m/s], normal of the sheet (M, 3), 1 where their spacing is held."""

    site: np.ndarray
    born: np.ndarray
    speed: np.ndarray
    radius: np.ndarray
    middle: np.ndarray
    velocity: np.ndarray
    normal: np.ndarray
    held: np.ndarray


def nothing() -> Opened:
    return Opened(*(np.zeros(0) for _ in range(4)), *(np.zeros((0, 3)) for _ in range(3)), np.zeros(0))


def joined(one: Opened, other: Opened) -> Opened:
    return Opened(*(np.concatenate(pair) for pair in zip(one, other)))


def drawn(ident, seed: int) -> np.ndarray:
    """(N,) of [0, 1), one for each number of a particle and a seed: SplitMix64 (Steele, Lea & Flood 2014)."""
    z = (np.asarray(ident).astype(np.uint64) + np.uint64((seed << 40) % 2**64)) * np.uint64(0x9E3779B97F4A7C15)
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return ((z ^ (z >> np.uint64(31))) >> np.uint64(11)).astype(float) * 2.0**-53


class Holes:
    """Holes of a stepper, by `perforation` and by `suction`; `growth` (n,): ln(eta/eta_0) of each number of a
    particle. Both are known to all processes of a world."""

    KEPT, FORMS = ("opened", "growth"), {"opened": GROWING, "growth": GROWING}  # see sdph.engine.kept

    def __init__(self, case, p, world=ALONE):
        self.world, self.case = world, case
        self.perforation, self.suction = p["perforation"], p["suction"]
        self.reach, self.unit = p["free_energy_tension"].reach, case.resolution.spacing
        self.sigma = case.parameters["free_energy_tension"].coefficient
        self.period = np.array(case.liquid_period)
        self.opened, self.growth = nothing(), np.zeros(0)

    def admit(self, kept: dict) -> None:
        """Unfit where columns of the holes are not of one length."""
        if len({len(column) for column in kept["opened"].values()}) > 1:
            raise Unfit("its holes are not whole")

    def advance(self, stepper, dt: float) -> np.ndarray:
        """Change (N, 3) of the velocities [m/s] in a step of `dt` [s], the next one; sites open first."""
        stepper.tell_velocities()
        s, count = stepper.state, len(stepper.state.x)
        self.thickness = np.empty(count)
        films.see(self.reach, self.unit**3, s, stepper.rows, stepper.neighbours.box, self.thickness)
        self.tree = scipy.spatial.cKDTree(self._round(particles.positions(s)), boxsize=self.period)
        sites, liquid, spacing = np.zeros(count, bool), np.zeros(count, bool), np.zeros(count)
        liquid[stepper.active] = True
        if self.perforation:
            sites = self._thin(s, liquid)
        if self.suction:
            torn, spacing = self._waves(s, liquid, dt)
            sites = sites | torn
        self._open(s, np.flatnonzero(sites & liquid), spacing, stepper.time)
        return self._pushed(s, liquid, stepper.time, dt)

    def _round(self, places) -> np.ndarray:
        """Places (N, 3) [m] that have gone round the periodic axes."""
        on = self.period > 0.0
        places[:, on] = np.mod(places[:, on], self.period[on])
        return places

    def _thin(self, s, liquid) -> np.ndarray:
        """Mask (N,) of the sites among own `liquid` (N,) that have not opened, where the sheet is thin and goes on all
        round."""
        own, places = self.perforation, particles.positions(s)
        found = (drawn(s.ident, own.seed) < own.share) & (self.thickness < own.thickness) & liquid
        found &= ~np.isin(s.ident, self.opened.site)
        for i in np.flatnonzero(found):
            off, axes = self._axes(places, i)
            aside = off.mean(axis=0) @ axes[:, 1:]
            found[i] = np.linalg.norm(aside) < ALL_ROUND * self.reach
        return found

    def _near(self, places, i: int) -> list[int]:
        """Particles within reach of one of them, that one too."""
        return self.tree.query_ball_point(self._round(places[[i]])[0], self.reach, return_sorted=True)

    def _axes(self, places, i: int) -> tuple[np.ndarray, np.ndarray]:
        """Places (n, 3) [m] of those within reach from particle i, and unit vectors as columns (3, 3), the normal of
        the sheet first."""
        off = self._image(places[self._near(places, i)] - places[i])
        return off, np.linalg.eigh(off.T @ off)[1]

    def _waves(self, s, liquid, dt: float) -> tuple[np.ndarray, np.ndarray]:
        """Mask (N,) of the particles where waves tear the sheet now, of which one for each square of the spacing (N,)
        [m] opens a hole; spacing is 0 where it is the wave's length and not the least that particles show. Waves grow
        where own `liquid` (N,) is."""
        own, rate, wave = self.suction, np.empty(len(s.x)), np.empty(len(s.x))
        films.swell(own, s, self.thickness, rate, wave)
        if (more := self.world.most(int(s.ident.max(initial=-1))) + 1 - len(self.growth)) > 0:
            self.growth = np.append(self.growth, np.zeros(max(more, len(self.growth) // 2)))
        before, gained = self.growth[s.ident], np.zeros(len(self.growth))
        gained[s.ident[liquid]] = dt * rate[liquid]
        self.growth = self.growth + self.world.sum(gained)
        passed = (before < sheets.TORN) & (self.growth[s.ident] >= sheets.TORN)
        spacing = self.spaced(wave)
        share = self.unit**3 / (self.thickness * spacing**2)
        return passed & (drawn(s.ident, self.case.parameters["suction"].seed) < share), spacing - wave

    def spaced(self, wave) -> np.ndarray:
        """Spacing (N,) [m] of holes that waves of a length (N,) [m] make: no less than two reaches of the tension,
        across which there is no liquid left between two that particles would show."""
        return np.maximum(wave, 2.0 * self.reach)

    def _open(self, s, rows, held, time: float) -> None:
        """Open holes at sites (n,) that are in no hole yet and have a sheet around them."""
        places, known = particles.positions(s), set(self.opened.site.tolist())
        _, inside, _ = self._within(s, time)
        inside, found = set(inside.tolist()), []
        for i in rows.tolist():
            near = self._near(places, i)
            if int(s.ident[i]) not in known and i not in inside and len(near) > FEWEST:
                axes = self._axes(places, i)[1]
                middle = places[i] + BESIDE * self.unit * axes[:, 2]
                found.append((i, particles.velocities(s)[near].mean(axis=0), middle, axes[:, 0]))
        if not self.world.any(bool(found)):
            return
        more = nothing()
        if found:
            i, velocity, middle, normal = (np.array(column) for column in zip(*found))
            h = self.thickness[i]
            speed = np.array([sheets.taylor_culick(self.sigma, self.case.liquid.density, each) for each in h])
            more = s.ident[i].astype(float), np.full(len(i), time), speed, 0.5 * h, middle, velocity, normal
            more = Opened(*more, (held[i] > 0.0).astype(float))
        self.opened = functools.reduce(joined, self.world.everywhere(more), self.opened)

    def _image(self, off) -> np.ndarray:
        """Separations (n, 3) [m] to the nearest images."""
        on = self.period > 0.0
        off[:, on] -= self.period[on] * np.round(off[:, on] / self.period[on])
        return off

    def _within(self, s, time: float, ahead: float = 0.0):
        """Holes (n,) that are there, among all, and particles (n,) within their circles, pair by pair; middles (M, 3)
        [m] of all. Middles are those of `time` [s], as the particles are, and circles those of `ahead` [s] later: whom
        a rim passes in a step is pushed from its begin on."""
        own, age = self.opened, time - self.opened.born
        middle = own.middle + age[:, None] * own.velocity
        live = np.flatnonzero(self.world.most(np.isin(own.site, s.ident).astype(np.int8)))
        radius = own.radius[live] + own.speed[live] * (age[live] + ahead)
        lists = self.tree.query_ball_point(self._round(middle[live].copy()), radius, return_sorted=True)
        number = [len(each) for each in lists]
        return np.repeat(live, number), np.array([i for each in lists for i in each], np.int64), middle

    def _pushed(self, s, liquid, time: float, ahead: float = 0.0) -> np.ndarray:
        """Change (N, 3) [m/s] of what is within one circle and slower than its rim; times as of `_within`."""
        change = np.zeros((len(s.x), 3))
        hole, i, middle = self._within(s, time, ahead)
        alone = (np.bincount(i, minlength=len(s.x))[i] == 1) & liquid[i]
        hole, i = hole[alone], i[alone]
        normal = self.opened.normal[hole]
        off = self._image(particles.positions(s)[i] - middle[hole])
        off -= (off * normal).sum(axis=1)[:, None] * normal
        length = np.linalg.norm(off, axis=1)
        outward = off / np.where(length > 0.0, length, 1.0)[:, None]
        speed = ((particles.velocities(s)[i] - self.opened.velocity[hole]) * outward).sum(axis=1)
        rim = self.opened.speed[hole]
        slow = (speed < rim) & (speed > -IN * rim)
        hole, i, kick = hole[slow], i[slow], ((rim - speed)[:, None] * outward)[slow]
        change[i] = kick - self._mean(hole, s.mass[i], kick)
        return change

    def _mean(self, hole, mass, kick):
        """(n, 3) the mean, by mass, of the kicks of each one's hole (n,), of all processes; kick (n, 3) of own
        particles."""
        weights, number = (mass, *(mass * column for column in kick.T)), len(self.opened.site)
        whole, *sums = self.world.sum(np.stack([np.bincount(hole, own, number) for own in weights]))
        return np.stack([column[hole] for column in sums], axis=1) / whole[hole][:, None]

    def told(self) -> dict[str, float]:
        """Summary: holes, and the share of them whose spacing is the least that particles show and not the wave's."""
        number = len(self.opened.site)
        return {"holes": number, "hole_spacing_held_share": float(self.opened.held.mean()) if number else 0.0}
