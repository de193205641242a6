"""Elastic and plastic blocks, and what tests do with them."""

import numpy as np

from sdph.case import read as cases
from sdph.engine import state as particles
from sdph.methods.solids.method import SolidStepper

SOLID = {"density_kg_m3": 1000.0, "youngs_modulus_Pa": 1e6, "poisson_ratio": 0.3}


def table(dimensions=2, solid=None, bodies=None, effects=(), **sections) -> dict:
    """A block of 12 x 8 (x 6) particles of 10 mm in a domain of 1 m."""
    upper = [0.52, 0.48, 0.46][:dimensions]
    block = {"shape": "box", "lower_m": [0.4] * dimensions, "upper_m": upper}
    return {
        "title": "block", "scene": "", "dimensions": dimensions, "effects": list(effects),
        "run": {"end_time_s": 1.0, "output_interval_s": 0.5},
        "domain": {"size_m": [1.0] * dimensions, "gravity_m_s2": [0.0] * dimensions},
        "resolution": {"spacing_mm": 10.0, "smoothing_ratio": 1.3},
        "solid": SOLID | (solid or {}), "bodies": bodies or {"block": block},
    } | sections  # fmt: skip


def stepper(*arguments, **keywords) -> SolidStepper:
    return SolidStepper(cases.from_table(table(*arguments, **keywords)))


def moved(own, places) -> None:
    """Put the particles of a stepper to `places` (N, 3) [m]; forces are of there."""
    for axis, column in zip(particles.axes(own.state), places.T):
        axis[:] = column
    own.forces(1e-6)


def shaken(own, size, seed=1) -> None:
    """Displace the particles at random by up to `size` [m]."""
    shift = size * np.random.default_rng(seed).uniform(-1.0, 1.0, own.reference.shape)
    shift[:, own.case.dimensions :] = 0.0
    moved(own, own.reference + shift)
