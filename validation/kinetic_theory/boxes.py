"""Boxes of grains without a gas: places and velocities are given once, at the start, and then left alone.

All effects between grains are on, in all that is run here; numerics are the defaults of a case. Grains are of glass, by
and large (2500 kg/m3), with the restitution and the packing limit of a case that gives none, 0.9 and 0.63. The theory
has no length but the grain diameter: what counts is the spacing in diameters. Neighbours that shear past each other do
so at rate dx, which has to stay below the speed of sound c, and viscosity has to rule over their distance: rate dx/c
and rate dx^2/nu are to be below 1. At alpha_p = 0.30, where they are largest, they are 0.19 and 0.83 at a spacing of
1.25 diameters and 0.09 and 0.21 at half of it (0.37 and 3.3 at 2.5 diameters): our choice is a diameter of 2 mm at
2.5 and 1.25 mm.
"""

from __future__ import annotations

import math

import numpy as np

from sdph.case import read as cases
from sdph.laws import granular
from sdph.study.validate import part

DENSITY, RESTITUTION, PACKING = 2500.0, 0.9, 0.63  # kg/m3, -, -
DIAMETER = 2e-3  # m
SPACINGS = (2.5e-3, 1.25e-3)  # m
EFFECTS = ("granular_pressure", "granular_viscosity", "granular_temperature", "friction", "walls", "gravity")


def case(size, alpha_p: float, spacing: float, theta: float, effects=EFFECTS, **sections):
    """A box of `size` (2,) [m] full of grains, periodic along x; `sections` of the case replace its own or add."""
    table = {
        "title": "grains alone", "dimensions": 2, "effects": list(effects),
        "run": {"end_time_s": 1.0, "output_interval_s": 1.0},
        "domain": {"size_m": list(size), "gravity_m_s2": [0.0, 0.0], "periodic": ["x"]},
        "resolution": {"spacing_mm": 1e3 * spacing, "cell_mm": 1e3 * size[0]},  # of a gas that is not there
        "gas": {"density_kg_m3": 1.0, "viscosity_Pa_s": 1e-5, "conductivity_W_m_K": 0.02,
                "heat_capacity_J_kg_K": 1000.0, "temperature_K": 300.0},
        "grains": {"density_kg_m3": DENSITY, "diameter_mm": 1e3 * DIAMETER, "heat_capacity_J_kg_K": 1000.0,
                   "conductivity_W_m_K": 1.0, "restitution": RESTITUTION, "packing_limit": PACKING,
                   "granular_temperature_m2_s2": theta},
        "particles": {"bed": {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": list(size),
                              "volume_fraction": alpha_p, "temperature_K": 300.0}},
    }  # fmt: skip
    for name, section in sections.items():
        table[name] = table.get(name, {}) | section
    return cases.from_table(table)


class Alone(part("granular_piles", "alone").Alone):
    """The same, and what walls do to the grains."""

    def __init__(self, case):
        super().__init__(case)
        self.push = np.zeros((2, 2))  # of the walls below and above [N s/m], normal to them and along x, since `forget`
        self.rest, self.grains.stepper.guard.sub_step = self.grains.stepper.guard.sub_step, self._after_sub_step
        self.largest: dict[str, float] = {}  # of what limiters held

    def begin_with(self, **arrays) -> None:
        """Give the particles other values than the case can: x, y, u, v, theta, once."""
        for name, values in arrays.items():
            getattr(self.state, name)[:] = values
        self.grains.stepper.replace(self.state)
        self.grains.stepper.prepare()

    def window(self, dt: float) -> dict[str, float]:
        told = super().window(dt)
        for name, value in self.grains.stepper.held.items():
            self.largest[name] = max(value, self.largest.get(name, 0.0))
        return told

    def forget(self) -> None:
        """Begin anew with what walls push and limiters hold."""
        self.push, self.largest = np.zeros((2, 2)), {}

    def _after_sub_step(self, stepper) -> None:
        """Add up what the walls did to the grains below and above the middle."""
        self.rest(stepper)
        s, middle = stepper.state, 0.5 * self.case.domain.size[1]
        force = (s.mass * stepper.step)[:, None] * (stepper.work.of_walls[:, :2] + stepper.work.of_walls[:, 3:5])
        for row, here, inwards in ((0, s.y < middle, 1.0), (1, s.y >= middle, -1.0)):
            self.push[row] += inwards * force[here, 1].sum(), force[here, 0].sum()

    def totals(self) -> dict[str, float]:
        return self.grains.totals()


def alpha_p(state) -> np.ndarray:
    """Volume fraction (N,) of the particles."""
    return state.density / DENSITY


def g0(share):
    """g0 [-] at alpha_p, held where sdph holds it."""
    return granular.sinclair_jackson(granular.capped_fraction(share, PACKING), PACKING)


def steady_theta(share: float, rate: float, diameter: float = DIAMETER) -> float:
    """theta [m2/s2] at which shear at `rate` [1/s] makes what collisions take."""
    a = granular.capped_fraction(share, PACKING)
    return granular.equilibrium_theta(a, RESTITUTION, g0(a), DENSITY, diameter, 0.25 * rate**2, 0.0, 0.0)


def amplitude(values, phase, mass) -> float:
    """Amplitude of cos(phase) in `values` (N,), by the mass of the particles."""
    wave = np.cos(phase)
    return math.fsum(mass * wave * (values - np.average(values, weights=mass))) / math.fsum(mass * wave**2)
