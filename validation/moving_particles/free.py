"""A free body of moving particles: kerosene in two dimensions, no gas, no gravity."""

from __future__ import annotations

import numpy as np

from sdph.case import read as cases
from sdph.methods.mps.method import MpsStepper

DENSITY, VISCOSITY, SIGMA = 780.0, 2.4e-3, 0.024  # kg/m3, Pa s, N/m: the sheet's
SPACING = 1e-4  # m
PRESSURE_REACH = 3.1  # l0, of drops in two dimensions: swirl-sheet.md, section 3


def body(pool: dict, size, reach: float, spacing: float = SPACING) -> MpsStepper:
    """A stepper of one pool in a domain of `size` [m], its tension with a reach of `reach` spacings."""
    return MpsStepper(
        cases.from_table({
            "title": "", "dimensions": 2, "effects": ["free_energy_tension", "laminar_viscosity"],
            "run": {"end_time_s": 1.0, "output_interval_s": 1.0},
            "domain": {"size_m": list(size), "gravity_m_s2": [0.0, 0.0]},
            "resolution": {"spacing_mm": 1e3 * spacing, "smoothing_ratio": 1.0},
            "method": {"name": "mps", "reach": PRESSURE_REACH},
            "liquid": {"density_kg_m3": DENSITY, "viscosity_Pa_s": VISCOSITY},
            "free_energy_tension": {"coefficient_N_m": SIGMA, "reach": reach},
            "pools": {"body": pool},
        })
    )  # fmt: skip


def go(stepper: MpsStepper, end: float, see) -> np.ndarray:
    """(n, k) rows see(stepper) of every step to `end` [s], the time first."""
    rows = [(stepper.time, *see(stepper))]
    while stepper.time < end:
        stepper.step(end - stepper.time)
        rows.append((stepper.time, *see(stepper)))
    return np.array(rows)
