"""Numerics of liquids: a scene that departs from the set has a row with its reason, none is idle, the page is made."""

import math

import pytest
from scripts import script

from sdph import scenes
from sdph.case import read as cases


@pytest.fixture(scope="module")
def numerics():
    return script("liquid_numerics")


def test_every_departure_has_its_reason(numerics):
    found = {(name, key) for name in numerics.names() for key in numerics.departures(name)}
    assert found - numerics.REASONS.keys() == set(), "departs without a row: add it to validation/liquid_numerics.py"
    assert numerics.REASONS.keys() - found == set(), "departs no more: take the row away"


def test_every_scene_names_its_speed(numerics):
    assert set(numerics.names()) == set(numerics.SPEEDS)
    assert len(numerics.names()) > 15


def test_the_page_is_what_the_script_makes(numerics):
    assert numerics.PAGE.read_text(encoding="utf-8") == numerics.page()


@pytest.mark.parametrize(("change", "key"), [
    ("resolution.smoothing_ratio=1.4", "h/dx"), ("liquid.kernel='cubic_spline'", "kernel"),
    ("liquid.courant=0.3", "Courant"),
    ("liquid.sound_speed_m_s=15.0", "c/U"), ("density_diffusion.delta=0.2", "density diffusion"),
    ("liquid_damping.alpha=0.1", "damping"), ("tank.slip='no_slip'", "slip"),
    ("liquid.pressure_gradient='corrected'", "pressure gradient"),
])  # fmt: skip
def test_a_change_is_seen(numerics, monkeypatch, change, key):
    """channel_bore has the set; with any other number it departs."""
    load = cases.load
    assert numerics.departures("channel_bore") == {}
    monkeypatch.setattr(numerics.cases, "load", lambda file: load(file, (change,)))
    assert set(numerics.departures("channel_bore")) == {key}


def test_the_fastest_speed_of_a_dam(numerics):
    """Ritter 1892: 2 sqrt(g H), H = 0.1143 m."""
    case = cases.load(scenes.find("dam_break")[1])
    assert numerics.ritter(case) == pytest.approx(2.0 * math.sqrt(9.81 * 0.1143), rel=1e-12)
