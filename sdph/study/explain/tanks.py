"""Lines on what a tank's sensors and motion would tell otherwise than meant."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from sdph.effects.around import frame, tank
from sdph.engine import table
from sdph.laws.kernels import SUPPORT

OFF = 0.25  # of the kernel's reach: how far above a floor the middle of (1 - r/R)^2 over half of a disc lies


def warnings(case) -> list[str]:
    """Lines on probes outside the tank, or so near to a floor that their pressure is that of a place further up, and on
    a motion that ends before its table."""
    return [*_of_probes(case), *_of_motion(case)]


def _of_probes(case) -> list[str]:
    if "tank" not in case.effects:
        return []
    shape, reach, found = tank.shape_of(case), SUPPORT * case.smoothing_length, []
    pull = np.array(case.domain.gravity) * ("gravity" in case.effects)
    below = case.resolution.spacing * pull / (np.linalg.norm(pull) or 1.0)
    for name, own in case.probes.items():
        out, under = shape.distance(np.array([own.at, own.at + below])).tolist()
        place = f"probes.{name}.at_m = {list(own.at)}"
        if out > case.resolution.spacing:
            found.append(
                f"{place} lies {out:.3g} m outside of the tank: it tells of liquid that is behind the wall, or nan"
            )
        elif under > 0.0 and "pressure" in (own.fields or ("pressure",)):
            found.append(
                f"{place} lies at a floor: a probe is a mean within {reach:.3g} m, whose middle is {OFF * reach:.2g} m "
                "further up, and its pressure is rho g times that too low; name a part in run.forces for the pressure "
                "on the wall itself (its force over its area)"
            )
    return found


def _of_motion(case) -> list[str]:
    own = case.parameters.get("frame")
    if own is None or not own.table or own.end is None:
        return []
    times = table.numbers(Path(own.table), frame.COLUMNS)[1]["time_s"].tolist()
    before, last = times[-2:][0], times[-1]  # of one row the same
    if own.end > own.start + before:
        return []
    return [
        f"frame.end_s = {own.end:g} is a time of the run, and the last row of frame.table is at frame.start_s + "
        f"{last:g} = {own.start + last:g} s: rows after {own.end - own.start:g} s of the table are dropped, and the "
        "tank goes on as fast as it then is; give a later end, or leave frame.end_s out"
    ]
