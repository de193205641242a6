"""Reduced model of a gel droplet in time: steps of `sdph.laws.gel_droplet`, and its account of mass and energy.

A step knows the heat that conduction brings to a bubble of any temperature (both are linear), finds the void at which
bubble and shell agree, and takes what boils from the gel, at the bubble's temperature.
"""

from __future__ import annotations

import math

import numpy as np

from sdph.effects.gas import gel
from sdph.laws import cavities, real_gas, shells, strength
from sdph.laws import gel_droplet as law
from sdph.laws.swelling import FAST, SPOT_GROWTH
from sdph.schema import CaseError
from sdph.study.gel_droplet.sections import Droplet


class Model:
    """A gel droplet as it is now; SI, by the metre of a cylinder."""

    def __init__(self, own: Droplet):
        drop, shell = own.droplet, own.shell
        self.own, self.dims, self.time = own, drop.dimensions, 0.0
        self.vapour, self.plastic, self.damage = gel.vapour(own.vapour), gel.plastic(shell), gel.damage(shell)
        self.around = law.Around(self.dims, drop.ambient_pressure, drop.surface_tension, *gel.moduli(shell))
        self.measure, outer = cavities.measure(self.dims), 0.5 * drop.diameter
        self.edges, self.rows = shells.layers(outer - drop.shell_thickness, outer, own.numerics.layers)
        self.hoop, self.spot = 0.0, np.zeros(len(self.rows))
        radius = 0.5 * drop.bubble_diameter
        void = cavities.void(radius, self.dims)
        temperature = real_gas.saturation_temperature(self.vapour, law.bubble_pressure(self.around, 0.0, void))
        self.bubble = law.Bubble(real_gas.saturated_density(self.vapour, temperature) * void, void, temperature)
        self._fill(radius, temperature)
        self.pressure, self.torn, self.opening = 0.0, "", 0.0
        self.heat_in = self.carried = self.taken = self.work = self.flowed = self.vented = 0.0
        self.start_mass = self.mass()

    def _fill(self, radius: float, temperature: float) -> None:
        """Rings of gel and shell for heat, all at one temperature, and the power of each."""
        count, inner, outer = self.own.numerics.rings, self.edges[0], self.edges[-1]
        more = max(1, round(count * (outer - inner) / (inner - radius)))
        rims = np.append(np.linspace(radius, inner, count + 1), np.linspace(inner, outer, more + 1)[1:])
        self.volumes, self.gel = np.diff(rims**self.dims), slice(0, count)  # over `measure`
        self.temperature, self.origin = np.full(count + more, temperature), temperature
        power = self.own.heating.flux * self.dims * self.measure * outer ** (self.dims - 1)
        at_rim = np.arange(count + more) == count + more - 1
        self.powers = power * (at_rim if self.own.heating.place == "rim" else self.volumes / self.volumes.sum())

    @property
    def capacities(self) -> np.ndarray:
        """Heat capacities (n,) [J/K] of the rings."""
        return self.own.gel.density * self.own.gel.heat_capacity * self.measure * self.volumes

    @property
    def gel_volume(self) -> float:
        """Gel [m^dims], over `measure`."""
        return float(self.volumes[self.gel].sum())

    def mass(self) -> float:
        """Gel, vapour and what was vented, without the shell [kg]."""
        return self.own.gel.density * self.measure * self.gel_volume + self.bubble.mass + self.vented

    def sensible(self) -> float:
        """Heat [J] of gel and shell above the start."""
        return float(self.capacities @ (self.temperature - self.origin))

    def growth(self) -> float:
        """g [m^dims] of the shell's inner face."""
        return law.growth_of(self.dims, self.bubble.void, self.gel_volume, self.edges[0])

    def faces(self) -> tuple[float, float]:
        """Radii [m] of the shell's faces."""
        growth = self.growth()
        beyond = shells.outer_growth(self.dims, self.edges, growth, self.rows)
        return shells.grown(self.edges[0], growth, self.dims), shells.grown(self.edges[-1], beyond, self.dims)

    def ratio(self) -> float:
        """D/D_0 [-]."""
        return self.faces()[1] / self.edges[-1]

    def conducted(self, dt: float) -> tuple[np.ndarray, np.ndarray, tuple[float, float]]:
        """Temperatures (n,) [K] after dt [s] with the bubble at 0 K, what each kelvin of it adds, and heat to it."""
        upper, free, unit = (np.empty(len(self.volumes)) for _ in range(3))
        radius = cavities.radius(self.bubble.void, self.dims)
        first = law.conducted(
            self.dims, radius, self.volumes, self.own.gel.conductivity, self.capacities, self.powers, dt,
            self.temperature, upper, free, unit,
        )  # fmt: skip
        return free, unit, (first * free[0], first * (1.0 - unit[0]))

    def step(self, dt: float) -> bool:
        """Grow through dt [s]; False, and nothing has changed, where droplet or spot outrun it."""
        free, unit, heat = self.conducted(dt)
        rows, spot, ratio, growth, old = self.rows, self.spot.copy(), self.ratio(), self.growth(), self.bubble
        self.rows = rows.copy()
        self.bubble = law.inflated(
            self.around, self.gel_volume, self.vapour, self.edges, self.plastic, self.damage, dt, heat, old, rows,
            self.rows,
        )  # fmt: skip
        hoop = self._necked(dt, spot) if self.bubble.void > 0.0 else math.nan
        step = self.own.numerics.growth_step
        if not (abs(hoop - self.hoop) < SPOT_GROWTH * step and abs(self.ratio() - ratio) < FAST * step):
            self.bubble, self.rows = old, rows
            return False
        pressure = self._gauge()
        self._warmed(dt, free, unit, old, 0.0)
        self._worked(0.5 * (self.pressure + pressure), growth, rows)
        self.spot, self.hoop, self.pressure = spot, hoop, pressure
        self._look()
        return True

    def _gauge(self) -> float:
        """Pressure [Pa] of the gel over that around."""
        inside = real_gas.saturation_pressure(self.vapour, self.bubble.temperature)
        return inside - law.bubble_pressure(self.around, 0.0, self.bubble.void)

    def _necked(self, dt: float, spot) -> float:
        """Hoop strain of the spot at the pull of the shell, 0 without one; its rows (4,) become those of the end."""
        if self.own.shell.flaw == 0.0:
            return 0.0
        around, pressure = self.around, self._gauge()
        thickness = (1.0 - self.own.shell.flaw) * (self.edges[-1] - self.edges[0])
        pull = shells.tension(pressure, *self.faces(), self.dims)
        return shells.necked(
            self.dims, thickness, pressure, pull, self.plastic, self.damage, around.bulk, around.shear, dt, self.hoop,
            spot,
        )  # fmt: skip

    def _look(self) -> None:
        """See whether the shell has torn."""
        if self.spot[shells.HARM] >= self.damage.critical:
            self.torn = "the spot failed"
        elif self.rows[shells.HARM].max() >= self.damage.critical:
            self.torn = "a layer failed"

    def _warmed(self, dt: float, free, unit, old, left: float) -> None:
        """Take a step's heat and the fuel that boiled, `left` [kg] of which went out of the tear."""
        new, own = self.bubble, self.own.gel
        boiled = new.mass + left - old.mass
        self.heat_in += float(self.powers.sum()) * dt
        self.taken += cavities.heat_taken(self.vapour, boiled, new.mass, new.temperature - old.temperature)
        self.vented += left
        self.temperature = free + unit * new.temperature
        volumes = self.volumes[self.gel]
        if not boiled < own.density * self.measure * self.gel_volume:
            raise CaseError(
                f"the gel boils dry at {self.time:g} s, where the model ends; give a smaller bubble or a shorter vent"
            )
        gone = boiled / (own.density * self.measure) * volumes / volumes.sum()
        heat = volumes * self.temperature[self.gel] - gone * new.temperature
        self.volumes[self.gel] = volumes - gone
        self.temperature[self.gel] = heat / self.volumes[self.gel]
        self.carried += own.heat_capacity * boiled * (new.temperature - self.origin)
        self.time += dt

    def stresses(self, growth: float, rows) -> np.ndarray:
        """Equivalent Kirchhoff stresses (n,) [Pa] of the layers."""
        found = np.empty(len(self.edges) - 1)
        shells.stresses(self.dims, self.edges, growth, self.around.shear, rows, found)
        return found

    def _worked(self, pressure: float, growth: float, rows) -> None:
        """Add the work of a mean pressure [Pa] on the inner face, whose growth was g [m^dims], and what flow took."""
        volumes = self.measure * np.diff(self.edges**self.dims)
        mean = 0.5 * (self.stresses(growth, rows) + self.stresses(self.growth(), self.rows))
        self.work += pressure * self.measure * (self.growth() - growth)
        self.flowed += float((volumes * mean) @ (self.rows[shells.FLOW] - rows[shells.FLOW]))

    def elastic(self) -> float:
        """Elastic energy of the shell [J]."""
        volumes = self.measure * np.diff(self.edges**self.dims)
        layers = zip(self.rows[shells.SWELL], self.stresses(self.growth(), self.rows), volumes)
        around = self.around
        return sum(strength.elastic_energy(around.bulk, around.shear, ln_j, q) * v for ln_j, q, v in layers)

    def open(self) -> None:
        """Begin to vent, out of a slit or a round hole."""
        width = self.own.vent.width
        self.opening = width if self.dims == 2 else 0.25 * math.pi * width**2

    def vent(self, dt: float) -> None:
        """Let vapour out of the tear for dt [s]."""
        free, unit, heat = self.conducted(dt)
        old, hottest = self.bubble, float(self.temperature.max())
        self.bubble, left = law.vented(self.around, self.vapour, self.opening, dt, heat, old, hottest)
        self._warmed(dt, free, unit, old, left)
        self.pressure = self._gauge()

    def emptying(self) -> float:
        """Time constant [s] of the vent now: m/(G w)."""
        inside = real_gas.saturation_pressure(self.vapour, self.bubble.temperature)
        flux = cavities.vent_flux(
            inside, self.bubble.temperature, self.around.ambient, self.vapour.molar_mass, self.vapour.heat_ratio
        )
        return self.bubble.mass / (flux * self.opening)

    def heat_drift(self) -> float:
        """Heat in less what rings, bubble and boiled gel hold of it, over heat in [-]."""
        missing = self.heat_in - self.sensible() - self.taken - self.carried
        return missing / self.heat_in if self.heat_in else 0.0

    def row(self) -> dict[str, float]:
        """Columns of the history now."""
        inner, outer = self.faces()
        return {
            "time_s": self.time, "diameter_ratio": self.ratio(), "pressure_Pa": self.pressure,
            "bubble_diameter_m": 2.0 * cavities.radius(self.bubble.void, self.dims), "bubble_kg": self.bubble.mass,
            "bubble_K": self.bubble.temperature, "rim_K": float(self.temperature[-1]),
            "hoop_stress_Pa": shells.tension(self.pressure, inner, outer, self.dims) / (outer - inner),
            "strain": float(np.abs(self.rows[shells.FLOW]).mean()), "spot_stretch": math.exp(self.hoop),
            "damage": float(self.spot[shells.HARM]) / self.damage.critical, "vented_kg": self.vented,
            "heat_in_J": self.heat_in, "sensible_J": self.sensible(), "bubble_J": self.taken, "carried_J": self.carried,
            "work_J": self.work, "elastic_J": self.elastic(), "plastic_J": self.flowed,
            "mass_drift_rel": self.mass() / self.start_mass - 1.0, "heat_drift_rel": self.heat_drift(),
        }  # fmt: skip
