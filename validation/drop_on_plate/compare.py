"""The drop on its plate against the segment of a disc that has its area and meets the plate at the contact angle."""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import brentq

from sdph.laws import wetting
from sdph.study.compare import check

SHAPE = 0.02  # of height and base: issue 19
LEAST, MOST = math.radians(10.0), math.radians(170.0)  # angles among which that of the run is looked for
ANGLES = {f"{angle} degrees": ((f"surface_tension.contact_angle_deg={angle}.0",), ["exact"]) for angle in (90, 120)}
VARIANTS = {"60 degrees": ((), ["exact"])} | ANGLES


def area(case) -> float:
    """Area of the drop [m2]."""
    pool = case.pools["drop"]
    return float(np.prod(np.subtract(pool.upper, pool.lower)))


def seen(run) -> wetting.Segment:
    """In the end: height of the highest particle and half a spacing; base of the segment that is spread as widely."""
    size, spread = area(run.case), run.history["liquid_spread_x_m2"][-1]
    angle = brentq(lambda a: wetting.segment(a, size).spread - spread, LEAST, MOST)
    height = run.history["liquid_largest_y_m"][-1] + 0.5 * run.case.resolution.spacing
    return wetting.Segment(height, wetting.segment(angle, size).base, spread)


def metrics(run) -> dict:
    """Values for `sdph cost`: (value, reference, scale)."""
    found = seen(run)
    wanted = wetting.segment(run.case.parameters["surface_tension"].contact_angle, area(run.case))
    return {
        "height": (found.height, wanted.height, wanted.height),
        "width of the base": (found.base, wanted.base, wanted.base),
    }


def exact(run) -> list[dict]:
    own, found = run.case.parameters["surface_tension"], seen(run)
    known = wetting.segment(own.contact_angle, area(run.case))
    half_disc = math.sqrt(2.0 * area(run.case) / math.pi)
    pace = math.sqrt(own.coefficient / (run.case.liquid.density * half_disc))
    return [
        check("height [m]", found.height, known.height, SHAPE, True),
        check("width of the base [m]", found.base, known.base, SHAPE, True),
        check("fastest liquid over sqrt(sigma/(rho a))", run.history["liquid_fastest_m_s"][-1] / pace, 0.0, 0.1),
    ]
