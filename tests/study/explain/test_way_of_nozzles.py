"""Particles that a nozzle brings are counted along its axis, to the side that it meets."""

import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.study.explain import mps


def test_a_wide_domain_holds_no_more_of_a_sheet():
    """The axis meets the far side, however wide the domain is across it."""
    case = cases.load(scenes.HERE / "swirl_sheet" / "case.toml")
    (nozzle,) = case.nozzles.values()
    (axis,) = [n for n, part in enumerate(nozzle.direction) if part]
    deep = abs((case.domain.upper if nozzle.direction[axis] > 0 else case.domain.corner)[axis] - nozzle.centre[axis])
    long = [f"run.end_time_s={10.0 * deep / nozzle.speed}"]
    wide = [4.0 * length if n != axis else length for n, length in enumerate(case.domain.size)]
    for more in (long, [*long, f"domain.size_m={wide}"]):
        assert mps._way(cases.load(scenes.HERE / "swirl_sheet" / "case.toml", tuple(more)), nozzle) == pytest.approx(
            deep
        )
