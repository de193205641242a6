"""Two-phase liquids for tests: a drop in a gas."""

import numpy as np

from sdph.case import read as cases
from sdph.engine.state import LIQUID
from sdph.methods.liquids.method import LiquidStepper

BASE = {
    "dimensions": 2,
    "effects": ["gravity", "density_diffusion", "liquid_damping", "laminar_viscosity", "tank"],
    "run": {"end_time_s": 1.0, "output_interval_s": 1.0},
    "domain": {"size_m": [0.5, 0.8], "gravity_m_s2": [0.0, -9.81]},
    "resolution": {"spacing_mm": 50.0},
    "liquid": {
        "density_kg_m3": 1000.0,
        "viscosity_Pa_s": 1.0,
        "sound_speed_m_s": 20.0,
        "exponent": 1.0,
        "background_pressure_Pa": 100.0,
    },
    "gas_phase": {"density_kg_m3": 1.0, "viscosity_Pa_s": 0.02, "exponent": 1.0},
    "tank": {"suction": "full"},
    "pools": {
        "water": {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.5, 0.4]},
        "air": {"phase": "gas", "shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.5, 0.8]},
    },
}


def stepper(shaken=True, **sections):
    table = BASE | sections
    own = LiquidStepper(
        cases.from_table({key: value for key, value in table.items() if key != "tank" or "tank" in table["effects"]})
    )
    if shaken:
        random, s = np.random.default_rng(1), own.state
        wet = s.kind >= LIQUID
        for name, size in (("x", 0.005), ("y", 0.005), ("u", 0.3), ("v", 0.3)):
            getattr(s, name)[wet] += size * random.standard_normal(wet.sum())
        own.forces()
    return own
