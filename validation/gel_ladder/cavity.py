"""A cavity of gas in a disc of liquid with a free rim swings: a little, at the frequency of linear theory, and from
1.2 of its radius at rest, against the differential equation of a cavity in two dimensions.

Numerics are the gel droplet's: sound, spacing, smoothing, density diffusion; there is no viscosity and no tension, as
the differential equation has none. With R the radius of the cavity and S that of the rim

    (R R'' + R'^2) ln(S/R) - R'^2 (1 - R^2/S^2)/2 = (p - p_around)/rho,   p = p_0 (R_0/R)^(2 kappa).
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np

from sdph.case import read as cases
from sdph.running import driver
from sdph.study import compare
from sdph.study.compare import check

AROUND, DENSITY, SOUND = 101325.0, 1500.0, 100.0  # Pa, kg/m3, m/s: gel-droplet.md, sections 2 and 3
HOLE, RIM = 1.5e-4, 5e-4  # m, of the liquid at rest: check 9
BAR = 0.02  # check 9
SPACINGS, JUDGED = (0.025, 0.0125), 0.0125  # mm: 6 and 12 in the radius; judged is the gel droplet's
TOP = 0.1  # of the swing: what is nearer to its end than this has the parabola that tells when it turns; our choice


class Swing(NamedTuple):
    """kappa; radius at the start over that at rest; time [s] to begin looking, and to the end; period [s]; radius over
    that at rest at the other end of the swing, None of a small one: 2 % of a radius that changes by 1 % tell
    nothing."""

    exponent: float
    start: float
    after: float
    end: float
    period: float
    other: float | None


def linear(exponent: float) -> float:
    """Period [s] of a small swing about HOLE: w^2 = 2 kappa p/(rho R^2 ln(S/R)); gel-droplet.md, check 9."""
    return 2.0 * math.pi * HOLE * math.sqrt(DENSITY * math.log(RIM / HOLE) / (2.0 * exponent * AROUND))


# large: gel_reference.json, cavity_period_2d_large, cavity_least_2d_large; small: 1 % of the radius, our choice
SWINGS = {
    "small": Swing(1.02, 0.99, 6e-5, 1e-4, linear(1.02), None),
    "large": Swing(1.1, 1.2, 6e-5, 1.1e-4, 8.478229364948064e-5, 0.8149127634092809),
}


def checks(folder: Path, _=(), reporter=None, swings=tuple(SWINGS), spacings=SPACINGS, judged=JUDGED) -> list[dict]:
    rows = []
    for name in swings:
        for spacing in spacings:
            own, bar = SWINGS[name], BAR if spacing == judged else math.inf
            values = told(run(folder / f"cavity-{name}-{spacing}", own, spacing, reporter), own)
            what, behind = f"{name} swing of a cavity of {HOLE / spacing * 1e3:g} spacings", ", reported"
            rows += [
                check(f"{what}: {of}{'' if spacing == judged else behind}", value, known, bar, bar < math.inf)
                for of, value, known in zip(("period [s]", "R/R0 at its other end"), values, (own.period, own.other))
                if known is not None
            ]
    return rows


def case(swing: Swing, spacing: float):
    """The cavity in a spacing [mm], at rest and out of its radius; the liquid is as much as about a cavity at rest."""
    hole, middle = swing.start * HOLE, [1e-3, 1e-3]
    rim = math.sqrt(RIM**2 - HOLE**2 + hole**2)
    excess = AROUND * (swing.start ** (-2.0 * swing.exponent) - 1.0)
    return cases.from_table({
        "title": "Cavity that swings", "dimensions": 2, "effects": ["density_diffusion", "bubble"],
        "run": {"end_time_s": swing.end, "output_interval_s": swing.end},
        "domain": {"size_m": [2e-3, 2e-3], "gravity_m_s2": [0.0, 0.0]},
        "resolution": {"spacing_mm": spacing, "smoothing_ratio": 1.3},
        "liquid": {"density_kg_m3": DENSITY, "sound_speed_m_s": SOUND, "history_interval_s": swing.end / 400.0},
        "pools": {"gel": {"shape": "ring", "centre_m": middle, "radius_m": rim, "inner_radius_m": hole}},
        "bubble": {
            "centre_m": middle, "around_Pa": AROUND, "content": "gas", "exponent": swing.exponent, "excess_Pa": excess,
        },
    })  # fmt: skip


def run(folder: Path, swing: Swing, spacing: float, reporter):
    driver.run(case(swing, spacing), "", folder, None, reporter)
    return compare.open_run(folder)


def told(run, swing: Swing) -> tuple[float, float]:
    """Period [s], nan of a cavity that does not turn a second time, and the radius at the other end of the swing over
    that at rest."""
    time, radius = run.history["time_s"], np.sqrt(run.history["bubble_area_m2"] / math.pi) / HOLE
    away = (radius - 1.0) * (1.0 if swing.start > 1.0 else -1.0)  # back where it began, this is largest
    far, late = away[time < swing.after].min(), time > swing.after
    if away[late].max() <= away[-1]:
        return math.nan, 1.0 + far * (1.0 if swing.start > 1.0 else -1.0)
    near = late & (away > away[late].max() - TOP * (away[0] - far))
    a, b, _ = np.polyfit(time[near], away[near], 2)
    return -0.5 * b / a, 1.0 + far * (1.0 if swing.start > 1.0 else -1.0)
