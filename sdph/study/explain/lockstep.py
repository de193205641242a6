"""Steps of a liquid with others in it, for estimates: with bodies both go by the shorter step of the two, and where a
droplet's growth is hastened by the motion's time; windows of grains bear their contact with the liquid."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from sdph.case.judge import scales_of
from sdph.effects.liquids import time_scaling
from sdph.engine import state as particles
from sdph.engine.contact import between
from sdph.methods.grains import start
from sdph.methods.liquids.liquid import SLOW
from sdph.study.explain import liquids, solids
from sdph.study.gel_droplet import foretold

GROWN = 1.4  # D/D_0 at which a shell tears (Qiang et al. 2017; 1.35 to 1.47 in validation/gel_droplet)


class Shared(NamedTuple):
    """End of the run [s] by the time that steps go by, and the longest step [s], before run.step_factor; places (M, 3)
    [m] of the bodies' particles."""

    end: float
    longest: float
    places: np.ndarray


def of(case) -> Shared | None:
    """The steps that liquid and bodies share; None where a case has not both."""
    if not {"liquid", "solid"} <= set(case.matters):
        return None
    wet, bodies = (scales_of(case.only(matter)) for matter in ("liquid", "solid"))
    rows = (*liquids.limits(wet), *solids.limits(bodies))
    return Shared(motion(case), min(row["largest [s]"] for row in rows), particles.positions(bodies.state))


def contact_of(case) -> list[dict]:
    """Limit of the windows of grains where they meet the liquid beside them (`sdph.engine.contact`), a row as of
    `sdph.study.explain.estimate.limits`; none where there is not both."""
    if not {"grains", "liquid"} <= set(case.matters):
        return []
    of_grains = start.fill(case.only("grains"), ()).mass.min(initial=math.inf)
    longest = between(case).limit(min(of_grains, case.liquid.density * case.resolution.spacing**case.dimensions))
    how = "of the time in which contact with the liquid stops grains, where they meet"
    return [{"of": "window", "cause": "contact", "largest [s]": longest, "rules": "", "how": how}]


def warnings(case) -> list[str]:
    """A line for each body that begins faster than the sound of the liquid beside it was chosen for, and what faster
    sound costs."""
    if not {"liquid", "solid"} <= set(case.matters):
        return []
    speeds = {name: max(math.hypot(*(own.velocity or ())), abs(own.speed)) for name, own in case.bodies.items()}
    c = case.liquid.sound_speed
    return [
        f"bodies.{name} begins at {speed:.3g} m/s, {speed / c:.2g} of the liquid's speed of sound: what it meets is "
        f"compressed rather than pushed aside; lower its speed, or raise liquid.sound_speed_m_s from {c:g} to "
        f"{10.0 * speed:.3g}, which lets a step be {liquids.step_of_sound(case, speed):.2g} s long"
        for name, speed in speeds.items()
        if speed > SLOW * c
    ]


def motion(case) -> float:
    """Time [s] of the motion in a run: all of it, or of a hastened droplet, as the reduced model foretells it."""
    if "time_scaling" not in case.effects:
        return case.run.end_time
    course = foretold.of(case)
    return _roughly(case) if isinstance(course, str) else foretold.motion(case, course)


def _roughly(case) -> float:
    """The same of a droplet that the reduced model does not know, whose wall goes at the largest speed or whose time at
    the largest pace, whichever is slower: until its shell is `GROWN` and tears, and what is left then."""
    p, end = time_scaling.kernel(case), case.run.end_time
    (shell,) = [body for body in case.bodies.values() if body.shape == "ring"]
    inner = math.sqrt(shell.inner_radius**2 + (GROWN**2 - 1.0) * shell.radius**2)  # its section keeps its area
    return min(end, (inner - shell.inner_radius) / p.cap + end / p.largest + p.after_tear)
