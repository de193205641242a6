"""Metrics of grains of two materials that part: mean heights, how far they have parted, and what is on top."""

from __future__ import annotations

import math

import numpy as np

from sdph.case.gas_cells import upwards
from sdph.engine import state as particles
from sdph.methods.grains.materials import fluidising
from sdph.schema import CaseError

TOP = 0.5  # of the grains, from above: where the mixing index is looked at; our choice


def metrics(simulation) -> dict[str, float]:
    """height_NAME_m, mean of each material over the domain's corner; segregation, 1 where all of the flotsam
    lies on all of the jetsam and 0 where they are mixed (Goldschmidt, Link, Mellema & Kuipers 2003, Powder Technol.
    138, 135, Eq. 8: (S - 1)/(S_max - 1), S the ratio of mean heights); mixing_index, share of jetsam in the upper half
    over its share of the bed, 1 where they are mixed (Rowe, Nienow & Agbim 1972, Trans. Inst. Chem. Eng. 50, 310; Wu &
    Baeyens 1998, Powder Technol. 98, 139).

    Jetsam is the material that gas lifts last: of the larger U_mf.
    """
    case, state = simulation.case, simulation.grains.inside
    refuse(case)
    up = upwards(case, "segregation")
    height = (particles.positions(state) - np.array((*case.domain.corner, 0.0)[:3])) @ up
    jet, flot = ranked(case)
    names = list(case.materials)
    return of(height, state.mass / state.grain_density, state.material == jet, names[jet], names[flot])


def refuse(case) -> None:
    """CaseError where a case has not two materials."""
    if len(case.materials) != 2:
        raise CaseError(
            f"run.metrics holds segregation, which is of two materials; the case has {len(case.kinds)}: leave it out"
        )


def ranked(case) -> tuple[int, int]:
    """Numbers of jetsam and flotsam."""
    speeds = fluidising(case)
    return int(np.argmax(speeds)), int(np.argmin(speeds))


def of(height, volume, is_jetsam, jetsam: str, flotsam: str) -> dict[str, float]:
    """The same of particles at heights (N,) [m], of the volume (N,) [m3] of their grains, some jetsam (N,): by volume,
    as layers are as thick as that."""
    own, other = volume * is_jetsam, volume * ~is_jetsam
    share, means = own.sum() / volume.sum(), [float(part @ height / part.sum()) for part in (own, other)]
    found = {f"height_{jetsam}_m": means[0], f"height_{flotsam}_m": means[1]}
    most = (1.0 + share) / share  # flotsam lies on jetsam of the share x: mean heights (1 + x)/2 and x/2
    found["segregation"] = (means[1] / means[0] - 1.0) / (most - 1.0) if means[0] > 0.0 else math.nan
    order = np.argsort(height)
    above = order[np.cumsum(volume[order]) > (1.0 - TOP) * volume.sum()]
    lies = volume[above].sum()  # nothing, of a process without grains
    found["mixing_index"] = float(own[above].sum() / lies / share) if lies else math.nan
    return found
