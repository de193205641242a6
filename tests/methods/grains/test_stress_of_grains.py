"""Force of viscosity: exact where velocity is linear, on any lattice; what it keeps; that no velocity escapes it."""

import math
from typing import NamedTuple

import numpy as np
import pytest
from builders import OPEN, cloud

from sdph.effects import OFF
from sdph.effects.effect import DIFFUSIVE
from sdph.effects.grains.granular_viscosity import ViscosityP
from sdph.engine.geometry import box_of
from sdph.engine.neighbours import Neighbours
from sdph.laws import kernels
from sdph.methods.grains import contacts, stress
from sdph.methods.grains import equations as rates

H, MASS, MU, BULK = 1.5, 1.0, 1.08, 1.43  # spacings of 1; dense grains have BULK/MU = 1.32


class Felt(NamedTuple):
    """Places, velocities and forces (N, d), power of viscosity that feeds theta and that heats (N,), density (N,), 1
    where enclosed (N,)."""

    place: np.ndarray
    velocity: np.ndarray
    force: np.ndarray
    power: np.ndarray
    heat: np.ndarray
    density: np.ndarray
    enclosed: np.ndarray


def felt(place, velocity, period=OPEN, mu=MU, bulk=BULK, feeds=1.0) -> Felt:
    """Of particles at `place` that move with `velocity` (N, d), by viscosity alone, which `feeds` a theta or not."""
    dims = place.shape[1]
    given = cloud(place, mass=MASS)
    for name, values in zip("uvw", velocity.T):
        getattr(given, name)[:] = values
    state, rows = Neighbours(2.0 * H, period).update(given)
    kernel = rates.Kernel(H, kernels.normalisation("cubic_spline", dims, H))
    box, count = box_of(period, dims), len(place)
    own = rates.scratch(count, len(rows.entries), False, dims == 3)
    rates.sum_density(kernel, state, rows, box, OFF, OFF, state.density, own.pull)
    own.shear[:], own.bulk[:] = mu, bulk
    viscous = ViscosityP(0.9, 0.63, 1.0, H, feeds)
    contacts.shear(
        kernel, state, rows, box, own, OFF, OFF, OFF, viscous, 1.0, np.empty((5, 0)), *own.shearing
    )  # fmt: skip
    acceleration, agitation, heating = np.empty((count, 3)), np.empty(count), np.empty(count)
    rates.rates(
        kernel, state, rows, box, own, viscous, OFF, OFF, OFF, OFF, OFF, OFF, acceleration, np.zeros((count, 7)),
        agitation, heating,
    )  # fmt: skip
    places, speeds = (np.stack([getattr(state, a) for a in names[:dims]], axis=1) for names in ("xyz", "uvw"))
    mass = state.mass[:, None]
    return Felt(
        places, speeds, mass * acceleration[:, :dims], state.mass * agitation, state.mass * heating,
        state.density.copy(), own.strain[2],
    )  # fmt: skip


def lattice(sides, strain=0.0):
    """Points (N, d) of a lattice of spacing 1, sheared along x by `strain` per height."""
    points = np.stack(np.meshgrid(*[np.arange(n) + 0.5 for n in sides], indexing="ij"), axis=-1).reshape(-1, len(sides))
    points[:, 0] += strain * points[:, 1]
    return points


def flows(dims):
    """Gradients of velocity (d, d) [1/s]: shear each way, expansion, any."""
    along, across = np.zeros((dims, dims)), np.zeros((dims, dims))
    along[0, 1] = across[1, 0] = 1.0
    return along, across, np.eye(dims), np.random.default_rng(3).uniform(-1.0, 1.0, (dims, dims))


@pytest.mark.parametrize("dims", [2, 3])
@pytest.mark.parametrize("strain", [0.0, 0.2, 0.5, 0.8])
def test_a_sheared_lattice_has_the_viscosity_that_it_is_given(dims, strain):
    """Power = V (2 mu dev(D):dev(D) + lambda (tr D)^2) of every linear flow: tau = mu gamma in shear."""
    points = lattice((13, 13) if dims == 2 else (13, 13, 13), strain)
    middle = points.mean(axis=0)
    for G in flows(dims):
        own = felt(points, points @ G.T)
        D = 0.5 * (G + G.T)
        deviator = 2.0 * ((D**2).sum() - np.trace(D) ** 2 / 3.0)
        inside = np.abs(own.place - middle).max(axis=1) < 0.6
        expected = MASS / own.density * (MU * deviator + BULK * np.trace(D) ** 2)
        np.testing.assert_allclose(own.power[inside], expected[inside], rtol=1e-11)
        assert own.force[inside] == pytest.approx(0.0, abs=1e-11)


@pytest.mark.parametrize("dims", [2, 3])
def test_forces_keep_momentum_and_what_turns_and_give_no_energy(dims):
    """Of a disordered block: sum f = 0, sum r x f = 0, sum v.f = -sum power to round-off; power >= 0; a rigid rotation
    feels nothing."""
    rng = np.random.default_rng(7)
    points = lattice((7, 7) if dims == 2 else (5, 5, 5)) + rng.uniform(-0.3, 0.3, (49 if dims == 2 else 125, dims))
    own = felt(points, rng.normal(size=points.shape))
    assert own.enclosed.all()
    size = np.abs(own.force).sum()
    assert np.abs(own.force.sum(axis=0)).max() < 1e-13 * size
    turned = np.einsum("ia,ib->ab", own.place, own.force)
    assert np.abs(turned - turned.T).max() < 1e-12 * size * np.abs(own.place).max()
    assert (own.velocity * own.force).sum() == pytest.approx(-math.fsum(own.power), rel=1e-12)
    assert own.power.min() > 0.0
    spin = np.zeros((dims, dims))
    spin[0, 1], spin[1, 0] = -1.0, 1.0
    turning = felt(points, points @ spin.T)
    assert np.abs(turning.power).max() < 1e-12 * np.abs(own.power).max() * np.abs(points).max() ** 2


@pytest.mark.parametrize("off", [0.0, 0.3])
def test_every_velocity_is_damped_and_none_beyond_the_step(off):
    """Decay rates of all velocities of a periodic block: 0 for even ones alone, and less than a step bears."""
    points = lattice((6, 6)) + off * np.random.default_rng(1).uniform(-1.0, 1.0, (36, 2))
    columns = []
    for k in range(72):
        velocity = np.zeros((36, 2))
        velocity[k % 36, k // 36] = 1.0
        own = felt(points, velocity, (6.0, 6.0, 0.0))
        columns.append(own)
    order = [np.lexsort(np.round(own.place, 9).T) for own in columns]  # rows are sorted anew at every call
    back = np.argsort(np.lexsort(np.round(points, 9).T))
    matrix = np.stack([-own.force[o][back].T.ravel() for own, o in zip(columns, order)])
    np.testing.assert_allclose(matrix, matrix.T, atol=1e-13)
    rates_of = np.linalg.eigvalsh(matrix)
    nu = (4.0 / 3.0 * MU + BULK) / columns[0].density.min()
    print(f"slowest three {rates_of[:3]}, fastest {rates_of[-1] * H**2 / nu:.2f} nu/h2")
    assert np.abs(rates_of[:2]).max() < 1e-12
    assert rates_of[2] > 0.5 * MU * (2.0 * np.pi / 6.0) ** 2
    assert rates_of[-1] < 2.0 / DIFFUSIVE * nu / H**2


def test_lone_particles_are_braked_as_morris_has_it():
    """No gradient is told by one neighbour: the force is 2 mu V_i V_j (dW/dr)/r v_ij."""
    own = felt(np.array([[0.0, 0.0], [1.0, 0.0]]), np.array([[0.0, 1.0], [0.0, 0.0]]))
    pull = kernels.cubic_spline_gradient(1.0, H, kernels.normalisation("cubic_spline", 2, H))
    moving = own.velocity[:, 1] == 1.0
    assert not own.enclosed.any() and stress.ENCLOSED > 0.0
    assert own.force[moving, 1] == pytest.approx(2.0 * MU * pull / own.density[moving] ** 2)


def test_what_viscosity_takes_heats_where_nothing_is_agitated():
    """Of all grains, at the edges too, where its form is another: no power is lost."""
    place = lattice((7, 7), 0.2)
    velocity = place @ flows(2)[3].T
    feeds, heats = felt(place, velocity), felt(place, velocity, feeds=0.0)
    assert (feeds.power > 0.0).all() and not feeds.heat.any() and not heats.power.any()
    np.testing.assert_allclose(heats.heat, feeds.power, rtol=1e-14)
