"""Stress around a ring, as pictures have it."""

import numpy as np

from sdph import scenes
from sdph.case import read as cases
from sdph.engine import state as particles
from sdph.methods.solids import history
from sdph.methods.solids.method import SolidStepper
from sdph.show.style import QUANTITIES


def stepper_of(scene, *more):
    return SolidStepper(cases.load(scenes.HERE / scene / "case.toml", more))


def test_stress_around_a_ring_is_that_of_its_tension_and_none_across():
    """Stress s along the circles and p along the radius, put in by hand: what is told is s everywhere."""
    own = stepper_of("thick_ring", "resolution.spacing_mm=0.025")
    places = particles.positions(own.state)[:, :2]
    x, y = ((places - places.mean(axis=0)) / np.hypot(*(places - places.mean(axis=0)).T)[:, None]).T
    s, p = 90e3, -10e3
    stress = np.zeros((len(x), 6))
    stress[:, 0], stress[:, 1] = s * y**2 + p * x**2, s * x**2 + p * y**2
    stress[:, 2], stress[:, 3] = 7.0, (p - s) * x * y
    own.free[0] = 1
    told = history.hoop_stress(own, stress)
    assert told[0] == 0.0
    np.testing.assert_allclose(told[1:], s, rtol=1e-4)  # the middle is that of the particles that hold


def test_only_rings_have_it_and_pictures_know_it():
    assert "hoop_stress" in history.fields(stepper_of("thick_ring", "resolution.spacing_mm=0.025"))
    assert "hoop_stress" not in history.fields(stepper_of("oscillating_plate"))
    assert "hoop_stress" in QUANTITIES
