"""A free body of moving particles: kerosene, no gas, no gravity."""

from __future__ import annotations

import numpy as np

from sdph.case import read as cases
from sdph.methods.mps.method import MpsStepper

DENSITY, VISCOSITY, SIGMA = 780.0, 2.4e-3, 0.024  # kg/m3, Pa s, N/m: the sheet's
SPACING = 1e-4  # m
PRESSURE_REACH = {2: 3.1, 3: 2.1}  # l0, of drops: swirl-sheet.md, section 3


def body(pool: dict, size, reach: float, periodic=None, effects=(), sections=None) -> MpsStepper:
    """A stepper of one pool in a domain of `size` [m], its tension with a reach of `reach` spacings; further effects
    with their sections."""
    on, d = {"periodic": [float(a) for a in periodic]} if periodic else {}, len(size)
    return MpsStepper(
        cases.from_table({
            "title": "", "dimensions": d, "effects": ["free_energy_tension", "laminar_viscosity", *effects],
            "run": {"end_time_s": 1.0, "output_interval_s": 1.0},
            "domain": {"size_m": list(size), "gravity_m_s2": [0.0] * d},
            "resolution": {"spacing_mm": 1e3 * SPACING, "smoothing_ratio": 1.0},
            "method": {"name": "mps", "reach": PRESSURE_REACH[d]},
            "liquid": {"density_kg_m3": DENSITY, "viscosity_Pa_s": VISCOSITY} | on,
            "free_energy_tension": {"coefficient_N_m": SIGMA, "reach": reach},
            "pools": {"body": pool},
        } | (sections or {}))
    )  # fmt: skip


def go(stepper: MpsStepper, end: float, see) -> np.ndarray:
    """(n, k) rows see(stepper) of every step to `end` [s], the time first."""
    rows = [(stepper.time, *see(stepper))]
    while stepper.time < end:
        stepper.step(end - stepper.time)
        rows.append((stepper.time, *see(stepper)))
    return np.array(rows)
