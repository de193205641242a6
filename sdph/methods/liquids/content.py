"""Content of a bubble of a liquid: gas or saturated vapour, its mass, temperature and heat."""

from __future__ import annotations

import math

import numpy as np

from sdph.effects.gas import gel
from sdph.engine.kept import Maybe
from sdph.laws import cavities, real_gas
from sdph.methods.liquids import pores

COLDEST, HOTTEST = (
    0.5,
    0.999,
)  # of the critical temperature: beyond, a vapour's bubble is no longer followed; our choice
ROAMING = 2.0  # spacings that the roomiest place of a void moves by at most in a window; our choice


def remedy(case) -> str:
    """The keys to change where a bubble of a case is out of bounds: lower what feeds it, or warm what is too cold."""
    own, heat = case.parameters["bubble"], case.parameters.get("liquid_heat")
    fed = {"bubble.flux_W_m2": own.flux, "bubble.excess_Pa": own.excess > 0.0}
    if heat and own.content == "vapour":
        boiling = float(real_gas.saturation_temperature(gel.vapour(own), own.around))
        if heat.temperature and heat.temperature < boiling:
            cold = f"in a liquid of liquid_heat.temperature_K = {heat.temperature:g} vapour condenses"
            return (
                f"{cold}: raise that to {boiling:.4g} K, where it boils at bubble.around_Pa, or lower run.step_factor"
            )
        fed |= {"liquid_heat.flux_W_m2": heat.flux, "liquid_heat.temperature_K": heat.temperature}
    return f"lower {' or '.join([*(key for key, on in fed.items() if on), 'run.step_factor'])}"


class Content:
    """Content of one bubble: void [m2], pressure over that around [Pa], mass [kg/m] and temperature [K] of vapour, heat
    that it got and with which it warmed [J/m], mass that it still owes the liquid, and that went out through a tear;
    `rim`: a place (2,) [m] in it; radius [m] that the grid misses; whether it is still there (`held`).

    Of a torn shell: width [m] of the way out, and `short`: radius [m] that flooding falls short by, None before it."""

    # see sdph.engine.kept
    KEPT = (
        "area", "pressure", "mass", "temperature", "heat", "warmed", "owed", "vented", "rim", "missed", "held",
        "first", "short", "width",
    )  # fmt: skip
    FORMS = {"short": Maybe(0.0)}

    def __init__(self, p, hole):
        self.p, self.rim, self.missed, self.held = p, np.array(hole.centre), 0.0, True
        self.first = self.area = cavities.void(hole.radius, 2)
        self.short, self.width = None, 0.0
        self.pressure, self.mass, self.temperature = p.excess, 0.0, 0.0
        self.heat = self.warmed = self.owed = self.vented = 0.0
        if p.vapour:
            self._saturate(p.vapour)

    def _saturate(self, v) -> None:
        """Begin with vapour at the pressure around, and know its bounds."""
        self.coldest, self.hottest = (share * v.critical_temperature for share in (COLDEST, HOTTEST))
        ends = self.coldest, self.hottest
        self.thinnest, self.densest = (float(real_gas.saturated_density(v, end)) for end in ends)
        self.temperature = float(real_gas.saturation_temperature(v, self.p.around + self._capillary()))
        self.mass = float(real_gas.saturated_density(v, self.temperature) * self.area)

    @property
    def radius(self) -> float:
        """R [m] of a round void of that area."""
        return math.sqrt(self.area / math.pi)

    def swell(self, area: float, guard) -> None:
        """Take another void [m2], and the pressure that goes with it."""
        self.area = area
        if not area > 0.0:
            guard.stop("void", "the bubble", np.zeros(3), area, (0.0, math.inf, "m2"), remedy(guard.case))
        self.pressure = self._content(guard) - self.p.around - self._capillary()

    def soak(self, conductance, temperature, dt: float) -> tuple[np.ndarray, np.ndarray]:
        """Heat (N,) [J] from particles of a temperature [K] by a conductance (N,) [W/K] in dt [s], at the temperature
        that the bubble has in the end, of which no sub-step is too long; mass (N,) [kg] that boils off each."""
        v, first, near = self.p.vapour, self.temperature, conductance > 0.0
        if not near.any():
            return np.zeros_like(conductance), np.zeros_like(conductance)
        span = np.append(temperature[near], first)
        low, high = float(span.min()), float(span.max())
        while high - low > cavities.NEAR * high:
            middle = 0.5 * (low + high)
            mass = float(real_gas.saturated_density(v, middle)) * self.area
            wanted = float(cavities.heat_taken(v, mass - self.mass, mass, middle - first))
            given = dt * float(conductance @ (temperature - middle))
            low, high = (middle, high) if given > wanted else (low, middle)
        heat = np.where(near, dt * conductance * (temperature - 0.5 * (low + high)), 0.0)
        whole = float(heat.sum())
        gained = (whole - self.mass * v.heat_capacity * (high - first)) / (
            v.latent_heat + v.heat_capacity * (high - first)
        )
        warmed = whole - v.latent_heat * gained
        self.mass, self.temperature = self.mass + gained, high
        self.heat, self.warmed = self.heat + whole, self.warmed + warmed
        return heat, heat / v.latent_heat - conductance * (warmed / v.latent_heat / conductance.sum())

    def evaporate(self, dt: float, share) -> np.ndarray | None:
        """Boil for `dt` [s] by a flux on the wall; mass (P,) [kg] that particles lose by their shares, None where
        nothing faces it: then it goes on owing."""
        heat = dt * self.p.flux * 2.0 * math.pi * self.radius
        boiled = heat / self.p.vapour.latent_heat
        self.heat, self.mass, self.owed = self.heat + heat, self.mass + boiled, self.owed + boiled
        if not share.any():
            return None
        mass, self.owed = self.owed, 0.0
        return share * (mass / share.sum())

    def look(self, grid: pores.Grid) -> None:
        """Look for the void in a torn shell, about where it was: `pore`, None where all there is filled."""
        self.grid, radius = grid, self.radius if self.short is None else ROAMING * grid.cell / pores.FINE
        deep = pores.start(grid, self.rim, radius)
        self.pore = None if deep is None else pores.pore(grid, deep)

    def flood(self) -> None:
        """Take the void that was found, or what it was where none was. One that is open and has no more pressure than
        the air is one with it, as air comes in at once, and so is one that has shrunk to nothing (our choice)."""
        if self.pore is None:
            self.width = 0.0
            return
        wide = math.sqrt(self.pore.area / math.pi)
        self.short = self.radius - wide if self.short is None else self.short
        self.rim, self.width, radius = self.pore.rim, self.pore.width, wide + self.short
        self.area = cavities.void(radius, 2)
        if self.pore.lost or radius <= 0.0 or (self.width and self.pressure <= 0.0):
            self.let_go()

    def holds(self, other: Content) -> bool:
        """Tell whether the place of another is in this void, when both were looked for in one grid."""
        return self.pore is not None and bool(self.pore.depth[self.grid.at(*other.rim)] <= 0.0)

    def depth(self, state) -> np.ndarray:
        """(N,) how far [m] particles lie behind the face of a flooded void, infinite of those nearer to the air."""
        if self.pore is None:
            return np.full(len(state.x), np.inf)
        cells = self.grid.at(state.x, state.y)
        depth, beyond = self.pore.depth[cells], self.pore.beyond[cells]
        return np.where(depth < beyond, depth, np.inf)

    def let_go(self) -> None:
        """Be one with the air: what is left of the vapour is out."""
        self.vented, self.mass = self.vented + self.mass, 0.0
        self.held, self.area, self.pressure, self.width = False, 0.0, 0.0, 0.0

    def end(self) -> None:
        """Be gone."""
        self.held, self.area, self.mass, self.owed, self.pressure = False, 0.0, 0.0, 0.0, 0.0

    def vent(self, dt: float) -> None:
        """Let vapour out for dt [s] through the way out."""
        v = self.p.vapour
        if not (v and self.held and self.width):
            return
        flux = cavities.vent_flux(
            self.pressure + self.p.around, self.temperature, self.p.around, v.molar_mass, v.heat_ratio
        )
        lost = float(flux) * self.width * dt
        self.mass, self.vented = self.mass - lost, self.vented + lost

    def _capillary(self) -> float:
        return float(cavities.capillary_pressure(self.p.tension, self.radius, 2))

    def _content(self, guard) -> float:
        """Pressure [Pa] of what is in it, absolute."""
        p, v = self.p, self.p.vapour
        if not v:
            held = p.around + p.tension / math.sqrt(self.first / math.pi)
            return (held + p.excess) * (self.first / self.area) ** p.exponent
        before = self.temperature
        density = self.mass / self.area
        if not self.thinnest < density < self.densest:
            allowed = (self.thinnest, self.densest, "kg/m3")
            guard.stop(
                "density of the vapour", "the bubble", np.append(self.rim, 0.0), density, allowed, remedy(guard.case)
            )
        self.temperature = float(cavities.temperature_of(v, density, self.coldest, self.hottest))
        warmed = self.mass * v.heat_capacity * (self.temperature - before)
        self.mass, self.owed = self.mass - warmed / v.latent_heat, self.owed - warmed / v.latent_heat
        self.warmed += warmed
        return float(real_gas.saturation_pressure(v, self.temperature))
