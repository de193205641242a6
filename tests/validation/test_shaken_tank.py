"""Short form of the shaken tank of `sdph validate sloshing_box`: the ideal liquid's limit of small waves, the level at
rest, the first crest at a coarse spacing, checks that tell what is off."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.running import driver
from sdph.running.progress import Reporter
from sdph.study import compare

OWN = compare.scene_module("sloshing_box")
TANK = OWN.shaken
OMEGA = 2.0 * math.pi / TANK.PERIOD


def linear(times, amplitude):
    """Level [m] of small waves: each odd mode of the box swings, driven by its share of the acceleration, from rest."""
    found = np.zeros_like(times)
    for n in range(1, 20, 2):
        k = n * math.pi / TANK.LENGTH
        own, driven = TANK.G * k * math.tanh(k * TANK.DEPTH), -4.0 * amplitude * OMEGA**2 * math.tanh(k * TANK.DEPTH)
        swing = np.cos(OMEGA * times) - np.cos(math.sqrt(own) * times)
        found += driven / (k * TANK.LENGTH * (own - OMEGA**2)) * swing * math.cos(k * TANK.PLACE)
    return found


def test_small_waves_are_those_of_linear_theory(monkeypatch):
    """A thousandth of the amplitude: 0.5 % of the largest, by the modes that are left out."""
    monkeypatch.setattr(TANK, "AMPLITUDE", small := 1e-3 * TANK.AMPLITUDE)
    times, level = TANK.theory(3.0)
    expected = linear(times, small)
    assert np.abs(level - expected).max() < 5e-3 * np.abs(expected).max()


def test_waves_of_the_tank_are_higher_than_small_ones():
    """Crests grow and troughs flatten in second order, k a^2/2 times (3 coth^2(k d) - 1)/(2 tanh(k d)) and less."""
    times, level = TANK.theory(3.0)
    small = linear(times, TANK.AMPLITUDE)
    assert 1.15 < level.max() / small.max() < 1.4
    assert 0.7 < level.min() / small.min() < 0.95


def test_crests_are_those_of_another_program():
    """Written apart, with 16 modes on 48 points: within 1 %."""
    found = TANK.crests(*TANK.theory(8.0), [1.08, 2.58, 4.07, 7.75])
    assert found == pytest.approx([0.0886, 0.2034, 0.1395, 0.1600], rel=0.01)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """The first crest, with eleven spacings in the depth."""
    folder = tmp_path_factory.mktemp("shaken") / "run"
    case = cases.load(scenes.find("sloshing_box")[1], (*TANK.overrides(1e3 * TANK.LENGTH / 32), "run.end_time_s=1.6"))
    driver.run(case, "sloshing_box", folder, None, Reporter(quiet=True))
    return compare.open_run(folder)


def test_the_first_crest(run):
    """At 54 mm, more than half of its height: within 30 %, and within a twentieth of a second."""
    (times, level), (when, ideal) = TANK.levels(run), TANK.theory(1.6)
    print(f"first crest over that of an ideal liquid: {level.max() / ideal.max():.3f}")
    assert level[0] == 0.0
    assert level.max() == pytest.approx(ideal.max(), rel=0.3)
    assert times[level.argmax()] == pytest.approx(when[ideal.argmax()], abs=0.05)
    assert len(TANK.checks(run)) == 4 and (run.folder / "shaken.png").is_file()


@pytest.mark.parametrize(("factor", "late", "wrong"), [(1.0, 0.0, 1), (0.85, 0.0, 2), (1.0, 0.2, 2)])
def test_what_is_too_low_or_late_is_told(monkeypatch, factor, late, wrong):
    """An ideal liquid is 1.27 of what was measured, and 0.85 of it 1.08."""
    times, level = TANK.theory(10.0)
    monkeypatch.setattr(TANK, "levels", lambda _: (times + late, factor * level))
    monkeypatch.setattr(TANK, "_figure", lambda *_: None)
    told = [check["name"] for check in OWN.measured(SimpleNamespace()) if not check["ok"]]
    assert len(told) == wrong, told
