"""Grains that hide each other as they radiate are told of before a run."""

import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.case.judge import scales_of
from sdph.study.explain import haze, tables

SCENE = scenes.HERE / "radiating_grains" / "case.toml"


def case_of(alpha_p, *more):
    return cases.load(SCENE, (f"particles.cloud.volume_fraction={alpha_p}", *more))


def told(case):
    return [text for text in tables.warnings(case) if "optical depth" in text]


def test_the_depth_is_that_across_the_grains():
    """1.5 1e-4/0.285 mm over 20 mm; half as wide, half as deep."""
    assert haze.depth(scales_of(case_of(1e-4))) == pytest.approx(1.5e-4 / 0.285e-3 * 0.02)
    narrow = case_of(1e-4, "particles.cloud.upper_m=[0.02,0.03]")
    assert haze.depth(scales_of(narrow)) == pytest.approx(1.5e-4 / 0.285e-3 * 0.01)


def test_thick_clouds_are_told_of():
    assert told(case_of(9e-3)) == []
    (text,) = told(case_of(2e-2))
    assert text.startswith("the optical depth 1.5 alpha_p/d x width of the grains is 2.1:") and "too much" in text
    table = cases.to_table(case_of(2e-2)) | {"effects": []}
    del table["radiation"]
    assert told(cases.from_table(table)) == []


def test_a_stream_is_as_deep_as_the_domain_at_most():
    """Slot of 30 mm into 40 mm: its own width; of 400 mm: the domain's. Of two the finer counts, though thinner."""
    nozzle = {"shape": "slot", "centre_m": [0.02, 0.04], "direction": [0.0, -1.0], "speed_m_s": 1.0}
    nozzle |= {"temperature_K": 1500.0, "diameters_mm": [0.01, 0.05], "sizes": "given", "shares": [0.5, 0.5]}
    table = cases.parsed(SCENE)
    del table["particles"], table["track"]
    table["effects"] = ["radiation", "drag", "inflow"]
    table["drag"] = {"law": "schiller_naumann"}
    fine, coarse = nozzle | {"diameters_mm": [0.01]}, nozzle | {"diameters_mm": [0.05]}
    for own in (fine, coarse):
        own |= {"shares": [1.0], "width_m": 0.04}
    rate = 3060.0 * 0.04
    table["nozzles"] = {"a": fine | {"rate_kg_s": 8e-4 * rate}, "b": coarse | {"rate_kg_s": 1e-3 * rate}}
    assert haze.depth(scales_of(cases.from_table(table))) == pytest.approx(1.5 * 8e-4 / 1e-5 * 0.04, rel=0.02)
    for width, across in ((0.03, 0.03), (0.4, 0.04)):
        table["nozzles"] = {"slot": nozzle | {"width_m": width, "rate_kg_s": 3060.0 * 1e-3 * width}}
        sauter = 1.0 / (0.5 / 1e-5 + 0.5 / 5e-5)
        found = haze.depth(scales_of(cases.from_table(table)))
        assert found == pytest.approx(1.5e-3 / sauter * across, rel=0.02)
