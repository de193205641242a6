"""Contacts that rest and yield: stress of one particle under given strain, and the force that it makes."""

import math

import numpy as np
import pytest
from grain_boxes import box, started, strain

from sdph.effects.grains import friction
from sdph.engine.geometry import apart
from sdph.engine.rows import entry
from sdph.laws import kernels
from sdph.laws.friction import second_invariant
from sdph.methods.grains import contacts, stress

RATE, DT = 20.0, 1e-5  # 1/s, s


@pytest.fixture(scope="module")
def block(tmp_path_factory):
    """A periodic block of grains in contact, in simple shear where its gradient is asked for."""
    case = box(["friction", "granular_pressure"], size=(0.1, 0.1), alpha_p=0.61)
    stepper = started(case, tmp_path_factory.mktemp("block")).stepper
    stepper.state.u[:] = RATE * stepper.state.y
    return stepper


def loaded(stepper, times):
    """Fields of `Shearing` after so many steps of DT, of the particles away from the jump of u at the border."""
    s = stepper.state
    for name in friction.ARRAYS[:3]:
        getattr(s, name)[:] = 0.0
    for _ in range(times):
        stepper._sub_step(DT)
        strain(stepper, DT)
        out = stepper.scratch
    return s, np.abs(s.y - 0.05) < 0.03, out


def test_sheared_contacts_bear_just_what_friction_does(block):
    """|tau| = p_fr sin(phi), elastic and viscous together, along the shear: Schaeffer's stress."""
    s, inside, out = loaded(block, 200)
    p = block.parameters["friction"]
    pressure = np.array([friction.pressure(p, a)[0] for a in s.density[inside] / 3060.0])
    borne = out.traction[inside] * s.density[inside, None] ** 2
    size = np.sqrt([second_invariant(*row) for row in borne])
    np.testing.assert_allclose(size, pressure * p.sine, rtol=1e-9)
    np.testing.assert_allclose(borne[:, 3], pressure * p.sine, rtol=0.02)


def test_slight_strain_is_elastic(block):
    """tau = 2 G D t far below yield, with G of the bulk modulus alpha_p dp_fr/dalpha_p and Poisson's ratio."""
    p = block.parameters["friction"]
    assert p.stiffness == pytest.approx(1.5 * (1.0 - 0.8) / 1.4)
    s, saved = block.state, block.state.u.copy()
    s.u[:] *= 1e-6
    s, inside, out = loaded(block, 10)
    alpha_p = s.density[inside] / 3060.0
    modulus = p.stiffness * alpha_p * np.array([friction.pressure(p, a)[1] for a in alpha_p])
    np.testing.assert_allclose(s.contact_xy[inside], modulus * 1e-6 * RATE * 10 * DT, rtol=0.03)
    assert (out.rubbing[inside] > 0.0).all()
    s.u[:] = saved


def test_work_of_contacts_is_what_their_force_takes(block):
    """sum m v.a + sum m (tau:D/rho) = 0 to round-off: the force is the adjoint of the strain."""
    s, *_ = loaded(block, 20)
    rng = np.random.default_rng(2)
    s.u[:], s.v[:] = rng.uniform(-0.1, 0.1, (2, len(s.x)))
    before = s.contact_xy.copy()
    strain(block, DT)
    out, elastic = block.scratch, block.parameters["friction"]
    tau = np.stack([s.contact_xx, s.contact_yy, -s.contact_xx - s.contact_yy, s.contact_xy, *np.zeros((2, len(s.x)))])
    for i, column in enumerate(tau.T):  # without the viscosity of contacts
        stress.bear(out.bearing, i, block.neighbours.box, s.density[i] ** -2, 0.0, stress.NO_GRADIENT, tuple(column))
    power, work = 0.0, 0.0
    for i in range(len(s.x)):
        for k in range(block.rows.number[i]):
            j = entry(block.rows, i, k)
            dx, dy, dz = apart(s, block.neighbours.box, i, j)
            r2 = dx * dx + dy * dy + dz * dz
            pull = stress.pair((), elastic, out.bearing, block.neighbours.box, i, j, dx, dy, dz, 0.0, 0.0, 0.0)
            g = s.mass[i] * s.mass[j] * kernels.cubic_spline_gradient(math.sqrt(r2), block.kernel.h, block.kernel.sigma)
            power += g * (pull[0] * s.u[i] + pull[1] * s.v[i])
    for i in range(len(s.x)):
        N = contacts.moments(block.kernel, s, block.rows, block.neighbours.box, out.pull, i)[0]
        work += s.mass[i] / s.density[i] * friction.power(tuple(tau[:, i]), contacts.deviator(N)[1])
    assert np.abs(s.contact_xy - before).max() > 0.0
    assert power == pytest.approx(-work, rel=1e-10)
