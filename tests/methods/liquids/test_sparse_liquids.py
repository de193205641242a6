"""Particles whose neighbours are too few for a gradient, a curvature or a normal are counted, and so is what the
softened pair takes off: as many as are made so by hand."""

import numpy as np
import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.engine import kernels as smoothing
from sdph.engine.state import positions
from sdph.methods.liquids import interface
from sdph.methods.liquids.limiters import held
from sdph.methods.liquids.method import LiquidStepper


def stepper(name, *given):
    return LiquidStepper(cases.load(scenes.HERE / name / "case.toml", given))


def scatter(own, count):
    """Take `count` particles far away, each alone."""
    far = own.active[:count]
    own.state.x[far] += 1e3 * np.arange(1.0, count + 1.0)
    own.forces()


def test_particles_of_spray_have_no_gradient():
    own = stepper("dam_break", "resolution.spacing_mm=5.715")
    assert held(own)["no_gradient_share"] == 0.0
    scatter(own, 3)
    assert held(own)["no_gradient_share"] == 3 / len(own.active)
    assert (own.gradient[own.active[np.argsort(own.state.x[own.active])[-3:]]] == 0.0).all()


def test_thinning_liquid_that_is_alone_has_no_shear_rate():
    thin = ["gravity", "density_diffusion", "shear_thinning", "tank"]
    given = {"model": "power_law", "index": 0.5, "least_viscosity_Pa_s": 1e-3, "most_viscosity_Pa_s": 1.0}
    sets = [f"shear_thinning.{key}={value!r}" for key, value in given.items()]
    own = stepper("dam_break", "resolution.spacing_mm=5.715", f"effects={thin}", *sets)
    assert held(own)["no_shear_rate_share"] == 0.0
    own.state.u[own.active] = 20.0 * own.state.y[own.active]
    scatter(own, 2)
    found = held(own)["no_shear_rate_share"]
    assert found == 2 / len(own.active)


@pytest.fixture
def droplet():
    return stepper("oscillating_droplet", "resolution.spacing_mm=0.1")


def test_particles_off_the_interface_have_no_normal(droplet):
    """Of those that see the other phase, by hand."""
    own, s = droplet, droplet.state
    r, seen = positions(s), np.zeros(len(s.x), bool)
    gradient = np.zeros((len(s.x), 3))
    for i in own.active:
        d = r[i] - r
        far = np.linalg.norm(d, axis=1)
        other = (s.kind != s.kind[i]) & (own.volume > 0.0) & (far < 2.0 * own.kernel.h)
        seen[i] = other.any()
        for j in np.flatnonzero(other):
            gradient[i] += own.volume[j] * smoothing.slope.py_func(own.kernel, far[j]) * d[j]
    cut = seen & (np.linalg.norm(gradient, axis=1) <= own.p["surface_tension"].least)
    assert held(own)["no_normal_share"] == pytest.approx(cut.sum() / seen.sum())
    assert 0.0 < held(own)["no_normal_share"] < 0.5


def test_a_lone_normal_has_no_curvature(droplet):
    """Two particles with a normal, out of each other's sight: neither bends, and both are counted."""
    own = droplet
    assert held(own)["no_curvature_share"] == 0.0
    places = positions(own.state)
    middle = np.linalg.norm(places[own.active] - places[own.active].mean(axis=0), axis=1)
    one, other = own.active[np.argmin(middle)], own.active[np.argmax(middle)]
    own.normal[:] = 0.0
    own.normal[[one, other], 0] = 1.0
    around = own.kernel, own.state, own.rows, own.neighbours.box, own.active
    interface.bend(*around, own.volume, (), own.normal, own.curvature)
    assert (own.curvature[[one, other]] == 0.0).all()
    assert held(own)["no_curvature_share"] == 1.0


def test_what_softening_takes_off_a_lattice():
    """0.01 h^2/r^2 of the nearest, less of those further: between the two for h = 1.5 dx."""
    own = stepper("dam_break", "resolution.spacing_mm=5.715", "liquid_damping.model='linear'")
    found = held(own)["softened_rel"]
    nearest = 0.01 * 1.5**2
    assert nearest / (4.0 + nearest) < found < nearest / (1.0 + nearest)
    own.state.x[own.active] *= 0.5
    own.state.y[own.active] *= 0.5
    own.forces()
    assert held(own)["softened_rel"] > found
    assert "softened_rel" not in held(
        stepper("dam_break", "resolution.spacing_mm=5.715", "liquid_damping.model='riemann'")
    )
