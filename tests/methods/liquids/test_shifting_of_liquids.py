"""Shifting of liquids: its directions, its velocities, and what it leaves at a surface."""

import numpy as np
import pytest
from shaken_liquids import stepper

from sdph.effects.liquids import shifting
from sdph.engine import kernels as smoothing
from sdph.engine.state import positions
from sdph.laws import matrices
from sdph.methods.liquids import shift


def test_eigenvalues():
    random = np.random.default_rng(2)
    for _ in range(50):
        a = random.standard_normal((3, 3))
        m = a + a.T
        least = matrices.smallest(m[0, 0], m[1, 1], m[2, 2], m[0, 1], m[1, 2], m[2, 0])
        assert least == pytest.approx(np.linalg.eigvalsh(m)[0], abs=1e-9)


def test_a_rotating_liquid_stays_where_shifting_puts_its_velocity():
    """Shifting moves particles, not the field: of a linear velocity each particle still has that of its place."""
    own = stepper(2, effects=("density_diffusion", "shifting"))
    s = own.state
    s.u[:], s.v[:], s.density[:] = 3.0 * s.y, -2.0 * s.x, 1000.0
    own.forces()
    inside = own.active[own.state.enclosure[own.active] > 0.75]
    before = positions(s).copy()
    own._shift(1e-3)
    moved = np.abs(positions(s) - before).max(axis=1)[inside]
    assert len(inside) > 10 and moved.max() > 1e-5
    assert np.allclose(s.u[inside], 3.0 * s.y[inside], rtol=1e-9)
    assert np.allclose(s.v[inside], -2.0 * s.x[inside], rtol=1e-9)


def test_at_a_surface_particles_are_shifted_along_it():
    """Of the shift nothing leads along the gradient of the smallest eigenvalue; spray stays; inside nothing changes."""
    own = stepper(2, effects=("density_diffusion", "shifting"))
    s, least = own.state, own.state.enclosure
    along = own.shift.copy()
    own.shift[:] = 0.0
    shift.surround(
        own.kernel,
        s,
        own.rows,
        own.neighbours.box,
        own.active,
        own.p["shifting"],
        own.phases,
        own.volume,
        least,
        own.shift,
        own.twist,
    )
    full, r = own.shift, positions(s)
    inside = least > shifting.INTERIOR
    assert inside.any() and np.array_equal(along[inside], full[inside])
    assert (along[least <= shifting.SPRAY] == 0.0).all()
    edge = np.flatnonzero(~inside & (least > shifting.SPRAY))
    assert len(edge) > 5
    for i in edge:
        d = r[i] - r
        slope = np.array([smoothing.slope.py_func(own.kernel, q) for q in np.linalg.norm(d, axis=1)])
        normal = (own.volume * slope * (least - least[i])) @ d
        normal /= np.linalg.norm(normal)
        assert np.allclose(along[i], full[i] - (full[i] @ normal) * normal, atol=1e-9 * np.abs(full).max())
