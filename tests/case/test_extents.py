"""Spans of boundaries lie on their side, wherever the domain begins."""

import dataclasses

import pytest

from sdph import scenes
from sdph.case import extents
from sdph.case import read as cases
from sdph.schema import CaseError


@pytest.mark.parametrize(("span", "fine"), [((-0.2, 0.2), True), ((0.3, 0.4), False), ((-0.3, 0.0), False)])
def test_a_span_is_counted_from_where_places_are(span, fine):
    case = cases.load(scenes.find("disc_cluster")[1])
    domain = dataclasses.replace(case.domain, lower=(-0.25, 0.0))
    wall = dataclasses.replace(next(iter(case.boundaries.values())), side="top", span=span)
    own = dataclasses.replace(case, domain=domain)
    if fine:
        return extents.side(own, "boundaries.plate", wall)
    with pytest.raises(CaseError, match=r"the box goes from -0.25 to 0.25 m there"):
        extents.side(own, "boundaries.plate", wall)
