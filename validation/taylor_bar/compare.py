"""A copper bar that hits a rigid side: its length and foot against finite elements."""

from __future__ import annotations

import numpy as np

from sdph.study.compare import check

# of the classical bar, copper of 400 MPa that hardens by 100 MPa at 227 m/s, the middle of what finite elements
# give, 21.3 to 21.5 mm and 6.9 to 7.25 mm, as is recalled; it has not been looked up
LENGTH, RADIUS = 21.4e-3, 7.075e-3
OF_LENGTH, OF_FOOT = 0.03, 0.08  # the bars


def length(run) -> float:
    """[m] from the rigid side to the upper end, half a spacing above its particles: nothing strains them."""
    return run.history["bar_highest_z_m"][-1] + 0.5 * run.case.resolution.spacing


def foot(run) -> float:
    """Radius [m] of the bar at its widest: its outermost particle, and half a spacing as it has been stretched
    outwards."""
    _, cloud, _ = run.fields(run.case.run.end_time)
    body, spacing = run.case.bodies["bar"], run.case.resolution.spacing
    r = np.hypot(*(np.asarray(cloud.points)[:, :2] - np.array(body.centre[:2])).T)
    return float(r.max() * body.radius / (body.radius - 0.5 * spacing))


def metrics(run) -> dict:
    """Values for `sdph cost`: (value, reference, scale)."""
    return {"length": (length(run), LENGTH, LENGTH), "foot": (foot(run), RADIUS, RADIUS)}


def exact(run) -> list[dict]:
    return [
        check("length [m]", length(run), LENGTH, OF_LENGTH, True),
        check("radius of the foot [m]", foot(run), RADIUS, OF_FOOT, True),
    ]
