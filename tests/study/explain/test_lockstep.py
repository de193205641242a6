"""Bodies that are faster than the liquid beside them was made for are told of."""

import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.study import explained
from sdph.study.explain import liquids, lockstep


def load(scene, *overrides):
    return cases.load(scenes.find(scene)[1], overrides)


@pytest.mark.parametrize(("speed", "told"), [(300.0, True), (2.81, True), (2.79, False)])
def test_a_body_faster_than_a_fifth_of_sound_is_told(speed, told):
    """Sound is 14 m/s there: 2.8 m/s are a fifth of it."""
    found = lockstep.warnings(load("tank_with_flap", f"bodies.flap.velocity_m_s=[0,{-speed}]"))
    assert len(found) == told
    assert all(line.startswith(f"bodies.flap begins at {speed:.3g} m/s, ") for line in found)


def test_what_faster_sound_costs_is_told():
    """By hand: 0.25 h/(c + v), h = 1.3 x 3.125 mm, c = 3000 m/s: 3.1e-7 s."""
    case = load("tank_with_flap", "bodies.flap.velocity_m_s=[300,0]")
    (line,) = lockstep.warnings(case)
    assert line.endswith("from 14 to 3e+03, which lets a step be 3.1e-07 s long")
    faster = load("tank_with_flap", "liquid.sound_speed_m_s=3000", "bodies.flap.velocity_m_s=[300,0]")
    assert lockstep.warnings(faster) == []
    assert liquids.step_of_sound(case, 300.0) == pytest.approx(0.25 * 1.3 * 3.125e-3 / 3300.0, rel=1e-12)


def test_bodies_alone_fly_as_fast_as_they_like():
    assert lockstep.warnings(load("taylor_bar")) == []


def test_explain_and_run_tell_of_it(tmp_path):
    found = explained.warned(load("tank_with_flap", "bodies.flap.velocity_m_s=[100,0]"), tmp_path)
    assert any(line.startswith("bodies.flap begins at 100 m/s") for line in found)
