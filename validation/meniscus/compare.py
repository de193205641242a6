"""The surface between two plates against the one whose weight surface tension holds (sdph.laws.wetting.meniscus)."""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import minimize_scalar

from sdph.engine.state import LIQUID
from sdph.laws import wetting
from sdph.study.compare import check

RISE = 0.02  # of the height at the wall over the middle: issue 19
ANGLES = {f"{angle} degrees": ((f"surface_tension.contact_angle_deg={angle}.0",), ["exact"]) for angle in (90, 120)}
VARIANTS = {"60 degrees": ((), ["exact"])} | ANGLES
STRIP = 2.0  # spacings across which the liquid is summed up


def levels(run) -> np.ndarray:
    """(S,) height [m] of the liquid in strips across the gap at the end, its mass over width and density."""
    case = run.case
    _, points, _ = run.fields(run.summary["time_s"])
    own, width = points["kind"] == LIQUID, case.domain.size[0]
    count = round(width / (STRIP * case.resolution.spacing))
    mass, _ = np.histogram(points.points[own, 0], count, (0.0, width), weights=points["mass"][own])
    return mass * count / (width * case.liquid.density)


def known(case, angle: float, count: int) -> tuple[np.ndarray, float]:
    """(mean heights of `count` strips over that of all, height at the wall over the middle) [m] of a contact angle."""
    half, own = 0.5 * case.domain.size[0], case.parameters["surface_tension"]
    length = math.sqrt(own.coefficient / (case.liquid.density * math.hypot(*case.domain.gravity)))
    x, height = wetting.meniscus(angle, half, length)
    held = np.concatenate([[0.0], np.cumsum(0.5 * (height[1:] + height[:-1]) * np.diff(x))])
    edges = np.linspace(-half, half, count + 1)
    means = np.diff(np.sign(edges) * np.interp(np.abs(edges), x, held)) * count / (2.0 * half)
    return means - means.mean(), float(height[-1])


def seen(run) -> float:
    """Height at the wall over the middle [m] of the meniscus whose strips are nearest to those of the run."""
    found = levels(run)
    found = found - found.mean()

    def missed(angle):
        return ((known(run.case, angle, len(found))[0] - found) ** 2).sum()

    best = minimize_scalar(missed, bounds=(math.radians(20.0), math.radians(160.0)), method="bounded")
    return known(run.case, best.x, len(found))[1]


def exact(run) -> list[dict]:
    case = run.case
    half, own = 0.5 * case.domain.size[0], case.parameters["surface_tension"]
    expected = known(case, own.contact_angle, 1)[1]
    bar = RISE * known(case, math.radians(60.0), 1)[1]  # of a level surface too
    pace = math.sqrt(own.coefficient / (case.liquid.density * half))
    return [
        check("height at the wall over the middle [m]", seen(run), expected, bar),
        check("fastest liquid over sqrt(sigma/(rho a))", run.history["liquid_fastest_m_s"][-1] / pace, 0.0, 0.1),
    ]
