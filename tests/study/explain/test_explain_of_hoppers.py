"""Grains that fall out of a vessel: walls, friction and outflow are called for, and not where nothing falls."""

import pytest

from sdph import scenes
from sdph.case import judge
from sdph.case import read as cases

BED = {"shape": "box", "lower_m": [0.0, 0.1], "upper_m": [0.03, 0.3], "temperature_K": 288.0}


def judged(bed, boundaries, gravity=-9.81):
    """What grains call for in a box of 0.03 x 0.45 m, that no gas is let into, for 1 s."""
    table = cases.parsed(scenes.find("fluidised_column")[1])
    table["domain"]["gravity_m_s2"] = [0.0, gravity]
    table["run"] = {"end_time_s": 1.0, "output_interval_s": 1.0}
    table["particles"]["bed"] = bed
    table["boundaries"] = boundaries
    return called_for(cases.from_table(table))


def called_for(case):
    return {"walls", "friction", "outflow"} & set(judge.called_for(case))


def outlet(**more):
    return {"kind": "pressure_outlet", "pressure_Pa": 0.0, "temperature_K": 288.0, **more}


WALLS = {"walls": {"kind": "slip_wall"}}
SLOT = {"slot": outlet(side="bottom", span_m=[0.01, 0.02])}
BOTTOM = {"bottom": outlet(side="bottom")}


@pytest.mark.parametrize(
    ("alpha_p", "boundaries", "gravity", "called"),
    [
        (0.55, WALLS | SLOT, -9.81, {"walls", "friction", "outflow"}),  # a bin with a slot
        (0.3, WALLS, -9.81, {"walls", "friction"}),  # a cloud that becomes a heap
        (0.55, WALLS | BOTTOM, -9.81, {"outflow"}),  # nothing below
        (0.55, WALLS | SLOT, 0.0, set()),  # nothing falls
        (1e-4, WALLS, -9.81, {"walls"}),  # too dilute to touch each other
    ],
)
def test_what_falls_is_told(alpha_p, boundaries, gravity, called):
    assert judged(BED | {"volume_fraction": alpha_p}, boundaries, gravity) == called


def test_walls_of_a_vessel_are_at_the_grains():
    """Of the scene of a tapered vessel with its floor open: its sides hold the grains up."""
    table = cases.parsed(scenes.find("tapered_bed")[1])
    table["boundaries"]["inlet"] = outlet(side="bottom")
    assert called_for(cases.from_table(table)) == {"walls", "friction", "outflow"}
