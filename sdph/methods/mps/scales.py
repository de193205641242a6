"""Orders of magnitude of a case of moving particles, from the case alone: what its effects judge themselves by."""

from __future__ import annotations

import dataclasses
import math
from functools import cached_property

from sdph import effects
from sdph.methods.mps.start import fill

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
