"""The surface between two plates against the one whose weight surface tension holds (sdph.laws.wetting.meniscus)."""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import brentq

from sdph.engine.state import LIQUID
from sdph.laws import wetting
from sdph.study.compare import check

RISE = 0.02  # of the height at the wall over the middle: issue 19
LEAST, MOST = math.radians(10.0), math.radians(170.0)  # angles among which that of the run is looked for
ANGLES = {f"{angle} degrees": ((f"surface_tension.contact_angle_deg={angle}.0",), ["exact"]) for angle in (90, 120)}
VARIANTS = {"60 degrees": ((), ["exact"])} | ANGLES


def wave(run) -> float:
    """2/W sum V cos(2 pi x/W) [m] of the liquid in the end, x from the middle of the gap W: the first Fourier component
    of its level, to which single particles add up evenly."""
    case = run.case
    _, points, _ = run.fields(run.summary["time_s"])
    own, width = points["kind"] == LIQUID, case.domain.size[0]
    turn = np.cos(2.0 * np.pi * (points.points[own, 0] / width - 0.5))
    return float(2.0 / width * (points["mass"][own] * turn).sum() / case.liquid.density)


def known(case, angle: float) -> tuple[float, float]:
    """(the same of the meniscus of an angle [rad], its height at the wall over the middle) [m]."""
    half, own = 0.5 * case.domain.size[0], case.parameters["surface_tension"]
    length = math.sqrt(own.coefficient / (case.liquid.density * math.hypot(*case.domain.gravity)))
    x, height = wetting.meniscus(angle, half, length)
    return float(2.0 / half * np.trapezoid(height * np.cos(np.pi * x / half), x)), float(height[-1])


def seen(run) -> float:
    """Height at the wall over the middle [m] of the meniscus that has the wave of the run."""
    found = wave(run)
    return known(run.case, brentq(lambda angle: known(run.case, angle)[0] - found, LEAST, MOST))[1]


def metrics(run) -> dict:
    """Values for `sdph cost`: (value, reference, scale)."""
    wanted = known(run.case, run.case.parameters["surface_tension"].contact_angle)[1]
    return {"height at the wall over the middle": (seen(run), wanted, wanted)}


def exact(run) -> list[dict]:
    case, own = run.case, run.case.parameters["surface_tension"]
    bar = RISE * known(case, math.radians(60.0))[1]  # of a level surface too
    pace = math.sqrt(own.coefficient / (case.liquid.density * 0.5 * case.domain.size[0]))
    return [
        check("height at the wall over the middle [m]", seen(run), known(case, own.contact_angle)[1], bar),
        check("fastest liquid over sqrt(sigma/(rho a))", run.history["liquid_fastest_m_s"][-1] / pace, 0.0, 0.1),
    ]
