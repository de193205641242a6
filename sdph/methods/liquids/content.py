"""Content of a bubble of a liquid: gas or saturated vapour, its mass, temperature and heat."""

from __future__ import annotations

import math

import numpy as np

from sdph.laws import cavities, real_gas

COLDEST, HOTTEST = (
    0.5,
    0.999,
)  # of the critical temperature: beyond, a vapour's bubble is no longer followed; our choice
LOWER = "bubble.flux_W_m2 or run.step_factor"


class Content:
    """Void [m2], pressure over that around [Pa], mass [kg/m] and temperature [K] of vapour, heat that it got and with
    which it warmed [J/m], mass that it still owes the liquid, and that went out through a tear; `rim`: a place (2,)
    [m] by which it is told."""

    def fill(self, p, first: float) -> None:
        """Begin with a void [m2]."""
        self.p, self.first, self.area = p, first, first
        self.pressure, self.mass, self.temperature = p.excess, 0.0, 0.0
        self.heat = self.warmed = self.owed = self.vented = 0.0
        if p.vapour:
            self.coldest, self.hottest = (share * p.vapour.critical_temperature for share in (COLDEST, HOTTEST))
            self.thinnest, self.densest = (
                float(real_gas.saturated_density(p.vapour, end)) for end in (self.coldest, self.hottest)
            )
            self.temperature = float(real_gas.saturation_temperature(p.vapour, p.around + self._capillary()))
            self.mass = float(real_gas.saturated_density(p.vapour, self.temperature) * self.area)

    @property
    def radius(self) -> float:
        """R [m] of a round void of that area."""
        return math.sqrt(self.area / math.pi)

    def swell(self, area: float, guard) -> None:
        """Take another void [m2], and the pressure that goes with it."""
        self.area = area
        if not area > 0.0:
            guard.stop("void", "the bubble", np.zeros(3), area, (0.0, math.inf, "m2"), LOWER)
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

    def vent(self, dt: float, width: float) -> None:
        """Let vapour out for dt [s] through a way that is `width` [m] wide."""
        v = self.p.vapour
        inside = self.pressure + self.p.around
        flux = cavities.vent_flux(inside, self.temperature, self.p.around, v.molar_mass, v.heat_ratio)
        lost = float(flux) * width * dt
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
            guard.stop("density of the vapour", "the bubble", np.append(self.rim, 0.0), density, allowed, LOWER)
        self.temperature = float(cavities.temperature_of(v, density, self.coldest, self.hottest))
        warmed = self.mass * v.heat_capacity * (self.temperature - before)
        self.mass, self.owed = self.mass - warmed / v.latent_heat, self.owed - warmed / v.latent_heat
        self.warmed += warmed
        return float(real_gas.saturation_pressure(v, self.temperature))
