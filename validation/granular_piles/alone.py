"""Grains alone: cases of grains on which no gas acts, and their run."""

from __future__ import annotations

import numpy as np

from sdph.case import read as cases
from sdph.methods.grains.grains import Grains

GRAVITY = 9.80665  # m/s2, standard (CGPM 1901)
EFFECTS = (
    "gravity", "walls", "outflow", "friction", "granular_pressure", "granular_viscosity", "granular_temperature",
)  # fmt: skip


def case(size, beds, spacing: float, effects=EFFECTS, **sections):
    """A case of a domain of `size` (d,) [m]; beds: name -> (lower, upper) [m], filled at alpha_p = 0.6; `sections`
    replace its own or add to them."""
    dimensions = len(size)
    table = {
        "title": "grains alone", "dimensions": dimensions, "effects": list(effects),
        "run": {"end_time_s": 1.0, "output_interval_s": 1.0},
        "domain": {"size_m": list(size), "gravity_m_s2": [0.0] * (dimensions - 1) + [-GRAVITY]},
        "resolution": {"spacing_mm": 1e3 * spacing, "cell_mm": 1e3 * spacing},  # cells of a gas that is not there
        "gas": {"density_kg_m3": 1.2, "viscosity_Pa_s": 1.8e-5, "conductivity_W_m_K": 0.025,
                "heat_capacity_J_kg_K": 1006.0, "temperature_K": 293.0},
        "grains": {"density_kg_m3": 2500.0, "diameter_mm": 1.0, "heat_capacity_J_kg_K": 800.0,
                   "conductivity_W_m_K": 1.0, "granular_temperature_m2_s2": 1e-8},
        "particles": {
            name: {"shape": "box", "lower_m": list(lower), "upper_m": list(upper), "volume_fraction": 0.6,
                   "temperature_K": 293.0}
            for name, (lower, upper) in beds.items()
        },
    }  # fmt: skip
    for name, section in sections.items():
        table[name] = table.get(name, {}) | section
    return cases.from_table(table)


class Alone:
    """Grains of a case without a gas."""

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
