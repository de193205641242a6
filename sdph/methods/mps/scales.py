"""Orders of magnitude of a case of moving particles, from the case alone: what its effects judge themselves by."""

from __future__ import annotations

import dataclasses
import math
from functools import cached_property

import numpy as np

from sdph import effects
from sdph.effects.around import tank
from sdph.engine import state as particles
from sdph.engine.state import LIQUID
from sdph.methods.mps.start import fill

LOOKS = 20_000  # places by which a level is found, to a thousandth of the domain or so; our choice

# effects that moving particles know
KNOWN = ("gravity", "laminar_viscosity", "free_energy_tension", "perforation", "suction", "tank", "inflow", "outflow")


class MpsScales:
    """Scales of a case, SI. U is the fastest that a nozzle or a pool gives, or a fall through the domain."""

    jet = 0.0  # no gas drives it

    def __init__(self, case):
        self.case, self.liquid, self.end = case, case.liquid, case.run.end_time
        self.gravity = math.hypot(*case.domain.gravity) if "gravity" in case.effects else 0.0
        self.viscosity = self.liquid.viscosity / self.liquid.density  # kinematic [m2/s]
        self.layer = math.sqrt(self.viscosity * self.end)  # depth that the friction of walls reaches [m]
        self.pull = (self.gravity, 0.0)  # across walls and along periodic axes [m/s2]
        self.shaken = 0.0

    @cached_property
    def state(self):
        """Particles of the pools, and of walls."""
        return fill(self.case)

    @cached_property
    def length(self) -> float:
        """Narrowest extent [m] of nozzles and pools."""
        found = [
            n.radius - n.inner_radius if n.inner_radius else 2.0 * n.radius
            for n in self.case.nozzles.values()
            if n.radius
        ]
        found += [n.width for n in self.case.nozzles.values() if n.width]
        for pool in self.case.pools.values():
            sides = [b - a for a, b in zip(pool.lower, pool.upper)] if pool.shape == "box" else [2.0 * pool.radius]
            found.append(min(sides))
        return min(found)

    @cached_property
    def thrown(self) -> float:
        """Fastest liquid that comes in or is there at the start [m/s]."""
        found = [nozzle.speed * math.hypot(1.0, nozzle.swirl) for nozzle in self.case.nozzles.values()]
        return max([*found, *(math.hypot(p.speed, *(p.velocity or ())) for p in self.case.pools.values())], default=0)

    @cached_property
    def fastest(self) -> float:
        """Fastest liquid at the start, or out of a nozzle [m/s]."""
        speeds = particles.lengths(particles.velocities(self.state))
        return max(self.thrown, float(speeds.max(initial=0.0)))

    @cached_property
    def down(self) -> np.ndarray:
        """(d,) gravity [m/s2], 0 along periodic axes and where nothing falls."""
        held = "gravity" not in self.case.effects
        periodic = np.array(self.liquid.periodic or [0.0] * self.case.dimensions) > 0.0
        return np.where(held | periodic, 0.0, self.case.domain.gravity)

    @cached_property
    def drop(self) -> float:
        """Way [m] from the highest liquid at the start to the level at which its tank holds it at rest, to the floor of
        the domain where there is outflow, and infinite where nothing stops it; 0 without gravity or liquid."""
        wet = self.state.kind == LIQUID
        if not wet.any() or not self.down.any():
            return 0.0
        down, domain = self.down / np.linalg.norm(self.down), self.case.domain
        places = np.stack([axis[wet] for axis in particles.axes(self.state)], axis=1)
        top = float((places @ down).min()) - 0.5 * self.case.resolution.spacing
        if "tank" in self.case.effects:
            return max(0.0, self._level(down, int(wet.sum())) - top)
        if "outflow" in self.case.effects:
            return max(0.0, float(np.maximum(down * domain.corner, down * domain.upper).sum()) - top)
        return math.inf

    def _level(self, down, count: int) -> float:
        """Place [m] along `down` of the surface of `count` particles at rest in the tank, by LOOKS places strewn evenly
        (Halton's) over the box about it; its mouth where they do not all fit."""
        from scipy.stats import qmc  # slow to import, and of `explain` alone

        shape, axes = tank.shape_of(self.case), np.eye(self.case.dimensions)
        low, high = (np.array([sign * shape.furthest(sign * e) for e in axes]) for sign in (-1.0, 1.0))
        places = low + (high - low) * qmc.Halton(len(axes), scramble=False).random(LOOKS)
        inside = np.sort((places @ down)[shape.distance(places) < 0.0])[::-1]
        if not len(inside):  # a tank so narrow in its box that no place hit it
            return float((places @ down).max())
        share = count * self.case.resolution.spacing ** len(axes) / float(np.prod(high - low))
        return float(inside[min(round(share * LOOKS), len(inside) - 1)])

    @cached_property
    def reached(self) -> float:
        """Speed [m/s] that liquid comes to: as it starts, and fallen as far as it can, or as long as the run is,
        v^2 = v_0^2 + 2 g z (Torricelli). At the foot of a column it is pushed aside sooner than it falls."""
        pull = float(np.linalg.norm(self.down))
        fallen = math.hypot(self.fastest, math.sqrt(2.0 * pull * self.drop)) if pull else self.fastest
        return min(fallen, self.fastest + pull * self.end)

    @cached_property
    def speed(self) -> float:
        """U [m/s]."""
        return max(self.thrown, math.sqrt(2.0 * self.gravity * max(self.case.domain.size)))

    @property
    def layers(self) -> float:
        """Spacings across the narrowest extent."""
        return self.length / self.case.resolution.spacing

    def capillary(self, sigma: float) -> tuple[float, float]:
        """Weber and Bond numbers of a surface tension [N/m]."""
        rho = self.liquid.density
        return rho * self.speed**2 * self.length / sigma, rho * self.gravity * self.length**2 / sigma


def scales_of(case) -> MpsScales:
    """Scales of a case as if every effect that moving particles know, and needs no input, had its section."""
    given = {name: own for name, own in effects.without_input("liquid").items() if name in KNOWN}
    if not case.nozzles:
        given.pop("inflow", None)
    return MpsScales(dataclasses.replace(case, parameters=given | case.parameters))
