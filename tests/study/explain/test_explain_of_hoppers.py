"""Grains that fall out of a vessel: walls, friction and outflow are called for, and not where nothing falls."""

import pytest

from sdph import scenes
from sdph.case import judge
from sdph.case import read as cases
from sdph.study.explain import tables

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


@pytest.mark.parametrize(
    ("span", "upper", "called"),
    [
        ([0.0, 0.2], [0.03, 0.3], True),  # it leans on the outlet
        ([0.35, 0.45], [0.03, 0.3], False),  # above it
        ([0.0, 0.2], [0.02, 0.3], False),  # not on it
    ],
)
def test_a_bed_that_leans_on_an_open_side_slumps_through(span, upper, called):
    bed = BED | {"volume_fraction": 0.55, "lower_m": [0.0, 0.0], "upper_m": upper}
    assert ("outflow" in judged(bed, WALLS | {"out": outlet(side="right", span_m=span)})) is called


def test_walls_of_a_vessel_are_at_the_grains():
    """Of the scene of a tapered vessel with its floor open: its sides hold the grains up."""
    table = cases.parsed(scenes.find("tapered_bed")[1])
    table["boundaries"]["inlet"] = outlet(side="bottom")
    assert called_for(cases.from_table(table)) == {"walls", "friction", "outflow"}


@pytest.mark.parametrize(("boundaries", "runs_out"), [(WALLS | SLOT, True), (WALLS, False)])
def test_a_bed_over_a_slot_runs_out_and_collides(boundaries, runs_out):
    """The numbers of a case that pours and the judgements of its effects tell the same of it."""
    table = cases.parsed(scenes.find("fluidised_column")[1])
    table["particles"]["bed"] = BED | {"volume_fraction": 0.6, "lower_m": [0.0, 0.0]}
    table["boundaries"], table["run"] = boundaries, {"end_time_s": 1.0, "output_interval_s": 1.0}
    parts = tables.explain(cases.from_table(table))
    numbers = {row["number"]: row["value"] for row in parts["numbers"]}
    told = next(row["why"] for row in parts["effects"] if row["effect"] == "granular_pressure")
    assert numbers["run / collision time"] > 1.0
    assert ("= 0 (" not in told) is runs_out and ("outflow" in called_for(cases.from_table(table))) is runs_out


@pytest.mark.parametrize(("slot", "safe"), [([0.01, 0.02], "NO"), ([0.0, 0.03], "yes")])
def test_an_outlet_of_few_spacings_is_told(slot, safe):
    """Slots of 5.3 and 16 particles."""
    table = cases.parsed(scenes.find("fluidised_column")[1])
    table["resolution"] = {"spacing_mm": 1.875, "cell_mm": 3.75}
    table["particles"]["bed"] = BED | {"volume_fraction": 0.55, "lower_m": [0.0, 0.0]}
    table["boundaries"] = WALLS | {"slot": outlet(side="bottom", span_m=slot)}
    rows = tables.explain(cases.from_table(table))["ratios"]
    assert next(row["safe"] for row in rows if row["ratio"] == "outlet / spacing") == safe


def inlet(low, high, speed):
    return {
        "kind": "velocity_inlet",
        "side": "bottom",
        "span_m": [low, high],
        "velocity_m_s": [0.0, speed],
        "temperature_K": 288.0,
    }


@pytest.mark.parametrize(("beside", "called"), [(0.1, {"walls", "friction"}), (9.0, {"walls"})])
def test_a_bed_comes_back_on_itself_beside_a_jet(beside, called):
    """U_mf is 0.2 m/s; without friction such a bed packs to 0.84. Gas of 9 m/s everywhere carries all of it away."""
    jet = {"left": inlet(0.0, 0.01, beside), "jet": inlet(0.01, 0.03, 10.0), "top": outlet(side="top")}
    bed = BED | {"lower_m": [0.0, 0.0], "upper_m": [0.03, 0.15], "volume_fraction": 0.5}
    assert judged(bed, WALLS | jet) - {"outflow"} == called
