"""A layer of grains on a rough slope: at 20 degrees it rests, at 30 and 45 it slides.

Contacts yield at tau = p_fr sin(phi), phi = 28.5 degrees: a slope of more than atan(sin(phi)) = 25.5 degrees is too
steep, and what is left of gravity, g (sin(zeta) - sin(phi) cos(zeta)), speeds the layer up. That is of friction alone:
the grains have no agitation. With it, rates have a resistance of their own, which is no closed form: reported.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from sdph.study.compare import check

from . import boxes

GRAVITY, PHI = 9.81, math.radians(28.5)  # m/s2; of friction as a case has it that gives none
LENGTH, DEPTH, ALPHA_P = 0.06, 0.06, 0.61  # m, m, -
SPACINGS = (5e-3, 2.5e-3)  # m: 12 and 24 particles deep
END, WINDOWS = 0.3, 30  # s; the second half is measured
LOW = 1e-10  # m2/s2, the least theta that a case has
REST = 1e-3  # m/s, and m/s2 of the mean acceleration: our choice, 1e-3 and 3e-4 of falling freely
BAR = 0.05  # issue 18
FRICTION = ("gravity", "friction", "granular_pressure", "walls")
SLOPES = (20.0, 30.0, 45.0)  # degrees


def checks(folder: Path, *_, spacings=SPACINGS, slopes=SLOPES, agitated=(False, True)) -> list[dict]:
    return [
        row
        for slope in slopes
        for theory in agitated
        for dx in spacings[: 1 if theory else None]
        for row in of_slope(math.radians(slope), theory, dx)
    ]


def of_slope(slope: float, theory: bool, spacing: float) -> list[dict]:
    """Checks of one slope [rad]."""
    speed, acceleration = slid(slope, boxes.EFFECTS if theory else FRICTION, spacing)
    acting = "kinetic theory" if theory else "friction alone"
    name = f"slope of {math.degrees(slope):g} degrees, {acting}, {1e3 * spacing:g} mm"
    left = GRAVITY * (math.sin(slope) - math.sin(PHI) * math.cos(slope))
    if left < 0.0:
        found = {"speed [m/s]": speed, "acceleration [m/s2]": acceleration}
        return [check(f"{name}: {what}", value, 0.0, REST) for what, value in found.items()]
    bar = math.inf if theory else BAR
    told = ", reported" if theory else ""
    return [check(f"{name}: acceleration over that of a block{told} [-]", acceleration / left, 1.0, bar)]


def slid(slope: float, effects, spacing: float) -> tuple[float, float]:
    """Mean speed [m/s] of a layer after END on a slope [rad], and its mean acceleration in the second half [m/s2]."""
    pull = [GRAVITY * math.sin(slope), -GRAVITY * math.cos(slope)]
    own = {
        "domain": {"gravity_m_s2": pull},
        "grains": {"diameter_mm": 1e3 * boxes.DIAMETER},
        "particles": {"bed": {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [LENGTH, DEPTH],
                              "volume_fraction": ALPHA_P, "temperature_K": 300.0}},
        "boundaries": {"lid": {"kind": "pressure_outlet", "side": "top", "pressure_Pa": 0.0}},
    }  # fmt: skip
    run = boxes.Alone(boxes.case((LENGTH, 2.0 * DEPTH), ALPHA_P, spacing, LOW, effects, **own))
    speeds = [0.0]
    for _ in range(WINDOWS):
        run.window(END / WINDOWS)
        speeds.append(float(np.average(run.state.u, weights=run.state.mass)))
    half = WINDOWS // 2
    return speeds[-1], (speeds[-1] - speeds[half]) / (0.5 * END)
