"""Course of the droplet without particles that a case of particles is foretold by."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from sdph.effects.liquids import time_scaling
from sdph.laws import solids
from sdph.schema import CaseError
from sdph.study.gel_droplet import checks
from sdph.study.gel_droplet.course import Course

NECKS_NOT = "no pool gel in a body shell that yields and fails: nothing necks"
GROWING = 0.1  # of the growth of the diameter, from which on a droplet is said to grow; our choice


class Growth(NamedTuple):
    """Growth that is foretold: time of the tear [s], inf without one; time [s] of the last GROWING of the growth
    before it; largest gauge pressure [Pa] and D/D0 within the run."""

    tear: float
    lasts: float
    pressure: float
    ratio: float


def of(case) -> Course | str:
    """The course of the droplet of a case, its largest bubble alone; why there is none, where the reduced model has no
    such droplet."""
    own = case.solid
    if own is None or own.yield_stress is None or not own.failure:
        return NECKS_NOT
    if not ({"gel"} <= case.pools.keys() and {"shell"} <= case.bodies.keys()):
        return NECKS_NOT
    try:
        return checks.reduced(case)
    except CaseError as error:
        return str(error)
    except ArithmeticError as error:
        return f"the droplet without particles cannot be computed ({error}): look at the units of shell and bubble"


def heated(case) -> bool:
    """True of a case of a bubble of vapour that heat grows in a shell."""
    own = {"bubble", "liquid_heat"} <= set(case.effects) and case.solid is not None
    return own and case.parameters["bubble"].content == "vapour"


def growth(case, course: Course) -> Growth:
    """Growth of a case by its course."""
    h, last = course.history, course.tear
    lived = slice(0, None if last is None else last + 1)
    time, ratio, pressure = (h[name][lived] for name in ("time_s", "diameter_ratio", "pressure_Pa"))
    tear = math.inf if last is None else float(time[-1])
    begins = float(np.interp(1.0 + GROWING * (ratio[-1] - 1.0), ratio, time))
    end = case.run.end_time
    within = float(pressure[time <= end].max())
    return Growth(tear, float(time[-1]) - begins, within, float(np.interp(end, time, ratio)))


def motion(case, course: Course) -> float:
    """Time [s] of the motion of a case with time scaling by its course, as its step goes by, which is as much shorter
    as the shell has become thinner: up to the tear or the end of the run, and what is run through after the tear."""
    shell, end, h = case.bodies["shell"], case.run.end_time, course.history
    lived = slice(0, None if course.tear is None else course.tear + 1)
    time, ratio = h["time_s"][lived], h["diameter_ratio"][lived]
    inner = np.sqrt(shell.inner_radius**2 + (ratio**2 - 1.0) * shell.radius**2)  # its section keeps its area
    thinned = (ratio * shell.radius - inner) / (shell.radius - shell.inner_radius)
    passed = _passed(case, np.diff(time), np.abs(np.diff(inner) / np.diff(time))) / thinned[1:]
    left = end - float(time[-1])
    after = min(left, time_scaling.kernel(case).after_tear) if course.tear is not None and left > 0.0 else 0.0
    return float(np.interp(end, time, np.append(0.0, np.cumsum(passed)))) + after / float(thinned[-1])


def _passed(case, steps, walls):
    """Times [s] of the motion that pass in steps (n,) [s] of a wall that goes at (n,) speeds [m/s]. It starts at rest:
    behind a load that grows evenly it comes to its speed v as v (1 - cos w t), in a quarter of the period with which
    shell and gel breathe."""
    p, shell, bubble = time_scaling.kernel(case), case.bodies["shell"], case.parameters["bubble"]
    hole = max(bubble.radii, default=case.pools["gel"].inner_radius)
    gel = case.liquid.density * shell.inner_radius * math.log(shell.inner_radius / hole)
    thick, own = shell.radius - shell.inner_radius, case.solid
    omega = 2.0 * math.pi / solids.ring_period(
        shell.radius, thick, own.youngs_modulus, own.poisson_ratio, own.density, gel
    )  # fmt: skip
    found, now = [], 0.0
    for dt, speed in zip(steps, walls):
        begun = 1.0 - math.cos(min(omega * now, 0.5 * math.pi))
        found.append(dt / time_scaling.pace(p, speed * begun, 0.0, 1.0))
        now += found[-1]
    return np.array(found)
