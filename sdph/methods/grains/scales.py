"""Orders of magnitude of a case, from the case alone: what the judgements of effects and `sdph explain` start from.

One dense patch of grains (that with the largest volume fraction) meets the fastest gas of the case. Parameters of an
effect that brings grains in have a method `patches(case)`.
"""

from __future__ import annotations

import dataclasses
import math
from functools import cached_property

import numpy as np

from sdph import effects
from sdph.effects.around import sizes
from sdph.effects.around.streams import Patch
from sdph.effects.gas import drag as of_drag
from sdph.effects.gas import reaction
from sdph.effects.gas.turbulent_dispersion import begins_with
from sdph.laws import dispersion, drag, exact, granular, heat
from sdph.laws.constants import TINY
from sdph.methods.grains import breaking, start, ways

SHEAR = 0.5  # sqrt(I2D) over the rate of a simple shear: D_xy is half of it
DILUTE = 1e-3  # alpha_p below which grains do not meet often enough to matter, Elghobashi 1994
THIN = 0.1  # free path over h above which grains are no fluid; a continuum up to that Knudsen number (Bird 1994, ch. 1)


class Scales:
    """Scales of a case. SI; see the properties for meaning. Of several materials they are those of the first."""

    def __init__(self, case):
        self.gas, self.end = case.gas, case.run.end_time
        self.patches = [_patch(case, name, region) for name, region in case.particles.items()]
        given = [own.patches(case) for own in case.parameters.values() if hasattr(own, "patches")]
        self.patches += [patch for own in given for patch in own]
        self.case = sizes.of_densest(case, self.patches)
        self.grains = self.case.grains
        self.gravity = math.hypot(*case.domain.gravity)
        own = case.parameters.get("electric_field")
        self.field = own.acceleration(case.grains) if own else np.zeros(case.dimensions)  # of grains in it [m/s2]

    @cached_property
    def alpha_p(self) -> float:
        return max((patch.alpha_p for patch in self.patches), default=0.0)

    @cached_property
    def length(self) -> float:
        """Narrowest extent [m] of the grains."""
        widths = (b - a for patch in self.patches for a, b in zip(patch.lower, patch.upper))
        return min(widths, default=min(self.case.domain.size))

    @cached_property
    def fed(self) -> list[tuple[float, float]]:
        """Speed [m/s] of gas that enters, as fast as it still is where it meets grains, and its temperature [K]."""
        found = [b for b in self.case.boundaries.values() if b.lets_in]
        speeds = [b.fastest * ways.strength(self.case, b, self.patches) for b in found]
        return [(speed, b.temperature or self.gas.temperature) for speed, b in zip(speeds, found)]

    @cached_property
    def jet(self) -> float:
        """Fastest of it [m/s]."""
        return max((speed for speed, _ in self.fed), default=0.0)

    @cached_property
    def thrown(self) -> float:
        """Fastest grains at the start or at an inlet [m/s]."""
        return max((math.hypot(*patch.velocity) for patch in self.patches), default=0.0)

    @cached_property
    def weight(self) -> np.ndarray:
        """Acceleration (d,) [m/s2] of a lone grain by its weight less that of the gas, and by an electric field."""
        return np.array(self.case.domain.gravity) * max(0.0, 1.0 - self.gas.density / self.grains.density) + self.field

    @cached_property
    def falling(self) -> float:
        """Speed [m/s] at which a lone grain settles, by the gas's drag; within the run."""
        weight = math.hypot(*self.weight)
        slip = weight * self.end
        for _ in range(50):  # fixed point, damped: drag grows with slip
            slip = 0.5 * (slip + weight / max(self.damping(0.0, slip), weight / max(slip, TINY), TINY))
        return slip

    @cached_property
    def slip(self) -> float:
        """Largest velocity between grains and gas [m/s]; 0 where nothing drives either."""
        return max(self.jet, self.thrown, self.falling, self.rush, self.eddies) if self.patches else 0.0

    breaking = cached_property(breaking.likeliest)  # of drops: those with the largest Weber number

    @cached_property
    def eddies(self) -> float:
        """Mean fluctuation [m/s] of a turbulent gas at its start, where grains feel it."""
        if "turbulent_dispersion" not in self.case.effects:
            return 0.0
        return dispersion.fluctuation(begins_with(self.gas, self.jet)[0])

    @cached_property
    def rush(self) -> float:
        """Speed [m/s] of gas that changes its volume among grains (`ways.rush`)."""
        return ways.rush(self)

    @cached_property
    def still_heat_time(self) -> float:
        """Time [s] in which still gas among grains takes their temperature."""
        eps = 6.0 * self.nusselt_at(0.0) * self.gas.conductivity / self.grains.diameter**2
        return self.grains.density * self.grains.heat_capacity / eps / self.heat_loading

    def damping(self, alpha_p: float, slip: float) -> float:
        """beta/(alpha_p rho_p) [1/s] by the law of the case."""
        return of_drag.of_one_size(of_drag.kernel(self.case), self.grains, alpha_p, slip, self.gas.density)

    @cached_property
    def drag_time(self) -> float:
        """a_p rp/beta [s] (sdph-notes, section 3)."""
        return 1.0 / self.damping(self.alpha_p, self.slip)

    @cached_property
    def loading(self) -> float:
        """Mass of grains over mass of gas, in the patch."""
        return self.alpha_p * self.grains.density / ((1.0 - self.alpha_p) * self.gas.density)

    @cached_property
    def gas_drag_time(self) -> float:
        return self.drag_time / self.loading if self.loading else math.inf

    @cached_property
    def reynolds(self) -> float:
        return drag.particle_reynolds(self.slip, self.grains.diameter, self.gas.density, self.gas.viscosity)

    @cached_property
    def prandtl(self) -> float:
        return heat.prandtl_number(self.gas.viscosity, self.gas.heat_capacity, self.gas.conductivity)

    @cached_property
    def nusselt(self) -> float:
        return self.nusselt_at(self.reynolds)

    def nusselt_at(self, reynolds: float) -> float:
        own = self.case.parameters.get("heat")  # Gunn's where no heat is exchanged
        return getattr(heat, own.law if own else "gunn")(1.0 - self.alpha_p, reynolds, self.prandtl)

    @cached_property
    def heat_time(self) -> float:
        """a_p rp cp/eps [s]."""
        eps = 6.0 * self.nusselt * self.gas.conductivity / self.grains.diameter**2
        return self.grains.density * self.grains.heat_capacity / eps

    @cached_property
    def heat_loading(self) -> float:
        return self.loading * self.grains.heat_capacity / self.gas.heat_capacity

    @cached_property
    def gas_heat_time(self) -> float:
        return self.heat_time / self.heat_loading if self.heat_loading else math.inf

    @cached_property
    def span(self) -> float:
        """Difference of the hottest and the coldest of the case [K], or more, what a reaction warms it by."""
        return max(max(self.case.temperatures) - min(self.case.temperatures), reaction.rise(self.case))

    @cached_property
    def speed(self) -> float:
        """Speed that the grains reach within the run [m/s]: thrown, blown along, falling or on a wall that slides; 0 in
        a bed at rest."""
        reached = self.thrown, self.blown, ways.belt(self.case), self.falling if self.patches else 0.0
        return 0.0 if self.resting else max(reached)

    @cached_property
    def blown(self) -> float:
        """Dragged along by the gas that is let in, with no more energy per volume than it has [m/s]."""
        return (
            0.0 if self.resting else self.jet * -math.expm1(-self.end / self.drag_time) / math.sqrt(1.0 + self.loading)
        )

    @cached_property
    def coasting(self) -> float:
        """Way of thrown grains over their speed [s]: gas and grains take up one speed, that of their common
        momentum."""
        kept, stop = self.loading / (1.0 + self.loading), self.drag_time / (1.0 + self.loading)
        return kept * self.end - (1.0 - kept) * stop * math.expm1(-self.end / stop)

    @cached_property
    def minimum_fluidisation(self) -> float:
        """U_mf [m/s] of the patch by Ergun 1952, of its Sauter diameter; nan without grains or gravity."""
        if not self.alpha_p or not self.gravity:
            return math.nan
        grains, gas = self.grains, self.gas
        return exact.minimum_fluidisation(
            self.capped, grains.density, self.gravity, grains.sauter_diameter, gas.density, gas.viscosity
        )

    @cached_property
    def resting(self) -> bool:
        """True where grains lie packed on a floor without an opening, and the gas that is let in cannot lift them."""
        return ways.rests(self)

    @cached_property
    def rim(self) -> float:
        """Share of the grains that outside gas slips past: all where gas is blown through them; of those thrown, that
        of a rim as thick as the gas takes to follow them, or as the kernel resolves."""
        if self.jet or not self.thrown:
            return 1.0
        return min(1.0, 2.0 * max(self.thrown * self.gas_drag_time, self.case.smoothing_length) / self.length)

    @cached_property
    def shear_length(self) -> float:
        """Over which the motion of grains changes [m]: their narrowest extent, or the width of a jet that is let in."""
        widths = [high - low for b in self.case.boundaries.values() if b.lets_in for low, high in ways.spans_of(b)]
        return max(min([self.length, *widths]), self.case.smoothing_length)

    @cached_property
    def to_walls(self) -> ways.Reach:
        """Way of the grains to the nearest side that is no pressure outlet."""
        return ways.reach(self, False)

    @cached_property
    def to_outlets(self) -> ways.Reach:
        """Way of the grains to the nearest pressure outlet."""
        return ways.reach(self, True)

    def settles(self, onset: float) -> bool:
        """True where grains come to lie at the volume fraction `onset` (`ways.settles`)."""
        return ways.settles(self, onset)

    @cached_property
    def collides(self) -> bool:
        """True where grains meet each other often enough to matter, and SPH particles have neighbours."""
        return self.alpha_p >= DILUTE and not self.lone

    @cached_property
    def lone(self) -> bool:
        """True where grains are so few that a particle has no neighbour."""
        return self.length < 2.0 * self.case.resolution.spacing

    @cached_property
    def capped(self) -> float:
        return granular.capped_fraction(self.alpha_p, self.grains.packing_limit)

    @cached_property
    def g0(self) -> float:
        return granular.sinclair_jackson(self.capped, self.grains.packing_limit)

    @cached_property
    def theta(self) -> float:
        """Granular temperature [m2/s2]: the start's, or that which shear speed/length keeps up by collisions, the
        larger."""
        if not self.collides:
            return self.grains.granular_temperature
        beta = self.alpha_p * self.grains.density / self.drag_time
        grains, shear = self.grains, (SHEAR * self.speed / self.length) ** 2
        kept = granular.equilibrium_theta(
            self.capped, grains.restitution, self.g0, grains.density, grains.diameter, shear, 0.0, beta
        )
        return max(grains.granular_temperature, kept)

    @cached_property
    def collision_time(self) -> float:
        """d sqrt(pi)/(24 a_p g0 sqrt(theta)) [s], kinetic theory (Gidaspow 1994, ch. 9)."""
        rate = 24.0 * self.alpha_p * self.g0 * math.sqrt(self.theta / math.pi) / self.grains.diameter
        return 1.0 / rate if rate else math.inf

    @cached_property
    def free_path(self) -> float:
        """d/(6 sqrt(2) a_p g0) [m]: mean way of a grain between collisions (Bird 1994, ch. 1)."""
        found = 6.0 * math.sqrt(2.0) * self.alpha_p * self.g0
        return self.grains.diameter / found if found else math.inf

    @property
    def a_fluid(self) -> bool:
        """True where grains meet others within h, as those of a fluid do (Knudsen number below 1: Bird 1994, ch. 1)."""
        return self.collides and self.free_path <= self.case.smoothing_length

    @cached_property
    def thin(self) -> bool:
        """True where grains fly so far between collisions that streams pass through each other, without a shock."""
        return self.free_path > THIN * self.case.smoothing_length

    @cached_property
    def sound(self) -> float:
        """c [m/s] of the agitated grains."""
        if not self.alpha_p or not self.theta:
            return 0.0
        grains, slope = self.grains, granular.sinclair_jackson_slope(self.capped, self.grains.packing_limit)
        own = self.capped, self.theta, grains.restitution, self.g0, slope, grains.density, 0.0
        return math.sqrt(granular.sound_speed_squared(*own))


def scales_of(case) -> Scales:
    """Scales of a case as if every effect that can judge itself and needs no input had its section."""
    parameters = effects.without_input("grains") | case.parameters
    return Scales(dataclasses.replace(case, effects=tuple(parameters), parameters=parameters))


def _patch(case, name: str, region) -> Patch:
    """Patch of a region, with what stands in it of other materials."""
    lower, upper = map(tuple, start.extents(case, region))
    alpha_p = sum(case.particles[other].volume_fraction for other in start.among(case, name))
    return Patch(alpha_p, region.temperature, region.velocity or (0.0,) * case.dimensions, lower, upper)
