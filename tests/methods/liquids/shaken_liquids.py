"""Liquids for tests of the loops."""

import numpy as np

from sdph.case import read as cases
from sdph.engine.state import LIQUID, positions
from sdph.methods.liquids.method import LiquidStepper

LIQUID_OF_TANK = {"density_kg_m3": 1000.0, "viscosity_Pa_s": 1.0, "sound_speed_m_s": 20.0}
TANK = {
    2: {"lower_m": [0.0, 0.0], "upper_m": [0.5, 0.4]},
    3: {"lower_m": [0.0, 0.0, 0.0], "upper_m": [0.4, 0.3, 0.3]},
}


def stepper(
    dimensions=2,
    effects=("gravity", "density_diffusion", "liquid_damping", "laminar_viscosity", "tank"),
    pressed=False,
    **sections,
):
    """A pool at rest in a box, shaken: places and velocities random by a tenth; `pressed`: one particle right at the
    floor."""
    gravity = [0.0] * (dimensions - 1) + [-9.81]
    table = {
        "dimensions": dimensions,
        "effects": list(effects),
        "run": {"end_time_s": 1.0, "output_interval_s": 1.0},
        "domain": {"size_m": [0.6] * dimensions, "gravity_m_s2": gravity},
        "resolution": {"spacing_mm": 50.0},
        "liquid": LIQUID_OF_TANK,
        "pools": {"water": {"shape": "box", **TANK[dimensions]}},
    } | sections
    own = LiquidStepper(cases.from_table(table))
    random = np.random.default_rng(1)
    wet = own.state.kind == LIQUID
    for name, size in (("x", 0.005), ("y", 0.005), ("z", 0.005), ("u", 0.3), ("v", 0.3), ("w", 0.3), ("density", 5.0)):
        array = getattr(own.state, name)
        if len(array):
            array[wet] += size * random.standard_normal(wet.sum())
    if pressed:
        height = positions(own.state)[:, dimensions - 1]
        low = np.flatnonzero(wet)[np.argmin(height[wet])]
        (own.state.y if dimensions == 2 else own.state.z)[low] = 0.0
    own.forces()
    return own
