"""Table of several materials: each alone in the gas, and what decides whether they brake each other."""

import math

import pytest

from sdph import scenes
from sdph.case import judge
from sdph.case import read as cases
from sdph.study.explain import materials


def mixed(end):
    given = f"run.end_time_s={end}", f"run.output_interval_s={end}", "run.average_from_s=0"
    return cases.load(scenes.find("segregation")[1], given)


def test_a_lone_grain_falls_at_its_terminal_velocity_however_short_the_run():
    """Its weight in gas is its drag, by Schiller & Naumann."""
    case = mixed(1e-3)
    for grains, row in zip(case.kinds, materials.rows(case), strict=True):
        speed, d, gas = row["terminal velocity [m/s]"], grains.diameter, case.gas
        reynolds = gas.density * speed * d / gas.viscosity
        coefficient = 24.0 / reynolds * (1.0 + 0.15 * reynolds**0.687) if reynolds < 1000.0 else 0.44
        drag = math.pi / 8.0 * gas.density * coefficient * d**2 * speed**2
        weight = math.pi / 6.0 * d**3 * (grains.density - gas.density) * 9.81
        assert drag == pytest.approx(weight, rel=1e-6)


def test_grain_drag_is_judged_by_terminal_velocities():
    case = mixed(1e-3)
    small, large = sorted(row["terminal velocity [m/s]"] for row in materials.rows(case))
    own = judge.judgements(case)["grain_drag"]
    assert own.number == pytest.approx(1.0 - small / large, rel=1e-9) and own.number > 0.1
