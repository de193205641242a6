"""Grains alone: cases of grains on which no gas acts, and their run.

The grains of what was measured are sand, rice, couscous, glass: two numbers of theirs are not the
defaults of a case.

They rub. Kinetic theory knows of smooth grains that lose energy by restitution alone; grains that rub lose it in
rotation and sliding too, and are smooth ones with e - (3/2) mu exp(-3 mu) (Jenkins & Zhang 2002, Phys. Fluids 14, 1228;
Chialvo & Sundaresan 2013, Phys. Fluids 25, 070603). With e = 0.9 layers that are sheared bear 0.31 of their pressure,
with 0.73 they bear 0.51.

Their angle is that of a slope on which they come to rest, 30 degrees. Schaeffer's phi is that of Mohr's circle: along a
plane on which they slide they bear p sin(phi), so tan(30 deg) = sin(phi) (Rowe 1969, Geotechnique 19, 75).
"""

from __future__ import annotations

import math

import numpy as np

from sdph.case import read as cases
from sdph.methods.grains.grains import Grains

RESTITUTION, RUBBING = 0.9, 0.5  # - of smooth grains, a case's default; friction of two grains, as of sand in DEM
REPOSE = math.radians(30.0)  # of sand, couscous, rice (experiments/data/column_collapse.csv)
DENSITY, DIAMETER = 2500.0, 1e-3  # kg/m3, m: sand or glass, our choice
ALPHA_P = 0.6  # as poured: the onset of contacts
GRAVITY = 9.80665  # m/s2, standard (CGPM 1901)
EFFECTS = (
    "gravity", "walls", "outflow", "friction", "granular_pressure", "granular_viscosity", "granular_temperature",
)  # fmt: skip
STEP = 0.05  # of sqrt(spacing/g), longest window: contacts have no stiffness before they touch; our choice


def effective_restitution(restitution: float, rubbing: float) -> float:
    """Restitution of smooth grains that lose as much as grains whose friction is `rubbing` [-]: Chialvo & Sundaresan
    2013, after Jenkins & Zhang 2002."""
    return restitution - 1.5 * rubbing * math.exp(-3.0 * rubbing)


def case(size, bed, spacing: float, effects=EFFECTS, **sections):
    """A case of a domain of `size` (d,) [m]; `bed`, lower and upper corner [m], is filled; `sections` replace its
    own or add to them."""
    dimensions = len(size)
    table = {
        "title": "grains alone", "dimensions": dimensions, "effects": list(effects),
        "run": {"end_time_s": 1.0, "output_interval_s": 1.0},
        "domain": {"size_m": list(size), "gravity_m_s2": [0.0] * (dimensions - 1) + [-GRAVITY]},
        "resolution": {"spacing_mm": 1e3 * spacing, "cell_mm": 1e3 * spacing},  # cells of a gas that is not there
        "gas": {"density_kg_m3": 1.2, "viscosity_Pa_s": 1.8e-5, "conductivity_W_m_K": 0.025,
                "heat_capacity_J_kg_K": 1006.0, "temperature_K": 293.0},
        "grains": {"density_kg_m3": DENSITY, "diameter_mm": 1e3 * DIAMETER, "heat_capacity_J_kg_K": 800.0,
                   "conductivity_W_m_K": 1.0, "restitution": effective_restitution(RESTITUTION, RUBBING),
                   "granular_temperature_m2_s2": 1e-8},
        "friction": {"angle_deg": math.degrees(math.asin(math.tan(REPOSE)))},
        "particles": {"bed": {"shape": "box", "lower_m": list(bed[0]), "upper_m": list(bed[1]),
                              "volume_fraction": ALPHA_P, "temperature_K": 293.0}},
    }  # fmt: skip
    for name, section in sections.items():
        table[name] = table.get(name, {}) | section
    return cases.from_table(table)


class Alone:
    """Grains of a case without a gas; `gravity` (3,) [m/s2] pulls."""

    def __init__(self, case):
        self.case, self.grains = case, Grains(case)
        self.gravity = np.array((*case.domain.gravity, 0.0)[:3])
        self.grains.start()

    @property
    def state(self):
        return self.grains.state

    @property
    def time(self) -> float:
        return self.grains.time

    def window(self, dt: float) -> dict[str, float]:
        """Go on by `dt` [s]; the account of it (sdph.methods.grains.account)."""
        none = np.zeros(len(self.state.x))
        self.grains.begin()
        self.grains.force(none, np.tile(self.gravity, (len(none), 1)), none)
        self.grains.advance(self.time + dt)
        self.grains.close()
        self.grains.renew(dt)
        return self.grains.columns()

    def go(self, end: float) -> float:
        """Go on for `end` [s]; the mass that left meanwhile [kg, per metre of depth in two dimensions]."""
        count = math.ceil(end / (STEP * math.sqrt(self.case.resolution.spacing / GRAVITY)))
        return sum(self.window(end / count)["left_kg"] for _ in range(count))
