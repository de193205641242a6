"""Total Lagrangian particles: deformation, stress and forces of blocks whose answer is known."""

import numpy as np
import pytest
from blocks import moved, shaken, stepper

from sdph.engine import state as particles
from sdph.methods.solids import equations, start
from sdph.methods.solids.method import WORKS, limits

LINEAR = {"hourglass": 0.0, "viscosity": 0.0}


def stretched(dimensions) -> np.ndarray:
    """Some F (3, 3), plane strain in two dimensions."""
    F = np.array([[1.3, 0.4, 0.2], [-0.1, 0.8, 0.3], [0.05, -0.2, 1.1]])
    if dimensions == 2:
        F[2, :2] = F[:2, 2] = 0.0
        F[2, 2] = 1.0
    return F


def turned(angle) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


@pytest.mark.parametrize("dimensions", [2, 3])
def test_any_linear_map_is_told_exactly(dimensions):
    own, F = stepper(dimensions), stretched(dimensions)
    moved(own, own.reference @ F.T)
    np.testing.assert_allclose(own.gradient, np.tile(F.ravel(), (len(own.reference), 1)), atol=1e-12)
    assert np.abs(own.steadying).max() < 1e-9 * 1e6 / (1000.0 * 0.01)  # hourglass control leaves it alone


@pytest.mark.parametrize("dimensions", [2, 3])
def test_stress_of_a_linear_map_is_hookes_of_the_log_strain(dimensions):
    own, F = stepper(dimensions), stretched(dimensions)
    moved(own, own.reference @ F.T)
    K, G = start.moduli(own.case)
    values, axes = np.linalg.eigh(F @ F.T)
    strain = 0.5 * np.log(values)
    tau = axes @ np.diag(K * strain.sum() + 2.0 * G * (strain - strain.mean())) @ axes.T
    expected = [tau[0, 0], tau[1, 1], tau[2, 2], tau[0, 1], tau[1, 2], tau[2, 0]]
    np.testing.assert_allclose(own.kirchhoff[7], expected, rtol=1e-10, atol=1e-6)
    energy = 0.5 * K * strain.sum() ** 2 + G * ((strain - strain.mean()) ** 2).sum()
    assert own.elastic_energy == pytest.approx(energy * own.weights.volume.sum())


def test_a_rigid_turn_by_a_full_circle_makes_no_stress():
    own = stepper()
    middle = own.reference.mean(axis=0)
    for angle in np.linspace(0.0, 2.0 * np.pi, 9):
        moved(own, middle + (own.reference - middle) @ turned(angle).T)
        assert np.abs(own.kirchhoff).max() < 1e-9 * 1e6
        assert np.abs(own.acceleration).max() < 1e-9 * 1e6 / (1000.0 * 0.01)


@pytest.mark.parametrize("dimensions", [2, 3])
def test_forces_are_the_slope_of_the_energy(dimensions):
    own = stepper(dimensions, LINEAR)
    shaken(own, 1e-3)
    force = own.state.mass[:, None] * own.acceleration
    here, step = particles.positions(own.state), 1e-8
    for i, a in ((0, 0), (17, 1), (40, dimensions - 1)):
        energies = []
        for sign in (1.0, -1.0):
            places = here.copy()
            places[i, a] += sign * step
            moved(own, places)
            energies.append(own.elastic_energy)
        moved(own, here)
        assert force[i, a] == pytest.approx(-(energies[0] - energies[1]) / (2.0 * step), rel=1e-6)


@pytest.mark.parametrize("dimensions", [2, 3])
def test_pairs_keep_momentum(dimensions):
    own = stepper(dimensions)
    own.state.u[:] = np.random.default_rng(2).standard_normal(len(own.state.x))
    shaken(own, 1e-3)
    force = own.state.mass[:, None] * own.acceleration
    assert np.abs(own.friction).max() > 0.0
    assert np.linalg.norm(force.sum(axis=0)) < 1e-12 * np.abs(force).sum()


def test_hourglass_control_holds_what_a_mean_deformation_does_not_tell():
    """One particle out of its place is pulled back by it alone."""
    own = stepper(solid={"hourglass": 0.05})
    places = own.reference.copy()
    i = len(places) // 2
    places[i, 0] += 1e-4
    moved(own, places)
    assert own.steadying[i, 0] < 0.0
    assert abs(own.steadying[i, 1]) < 1e-6 * abs(own.steadying[i, 0])


def test_viscosity_takes_energy_of_what_nears_and_of_what_parts():
    own = stepper(solid={"hourglass": 0.0})
    for sign in (1.0, -1.0):
        own.state.u[:] = sign * (own.state.x - own.state.x.mean())
        own.forces(1e-6)
        power = (own.state.mass * own.state.u) @ own.friction[:, 0]
        assert power < 0.0


def test_viscosity_leaves_a_turn_alone():
    own = stepper(solid={"hourglass": 0.0})
    own.state.u[:], own.state.v[:] = -(own.state.y - 0.44), own.state.x - 0.46
    own.forces(1e-6)
    assert np.abs(own.friction).max() < 1e-9


def test_plastic_flow_ends_on_the_yield_surface_and_takes_what_the_stress_does():
    own = stepper(solid={"yield_stress_Pa": 1e4, "hardening_Pa": 5e4})
    F = np.diag([1.1, 1.0 / 1.1, 1.0])
    moved(own, own.reference @ F.T)
    tau = own.kirchhoff[5]
    spread = tau[:3] - tau[:3].mean()
    p = own.strained[5]
    assert np.sqrt(1.5 * (spread @ spread)) == pytest.approx(1e4 + 5e4 * p, rel=1e-9)
    taken = own.works[WORKS.index("plastic")] / own.weights.volume.sum()
    assert taken == pytest.approx(0.5 * p * (0.0 + 1e4 + 5e4 * p), rel=1e-9)  # mean of the stresses before and after
    moved(own, own.reference @ F.T)
    assert own.strained[5] == pytest.approx(p, rel=1e-12)  # it stays where it is


def test_a_squeezed_block_shortens_the_step():
    own = stepper()
    free = limits(own)["waves"]
    assert free == pytest.approx(0.3 * 0.013 / start.sound(own.case))
    moved(own, own.reference @ np.diag([1.0, 0.5, 1.0]))
    assert limits(own)["waves"] == pytest.approx(0.5 * free)
    moved(own, own.reference @ (turned(0.5) @ np.diag([1.0, 0.5, 1.0])).T)
    assert 0.35 * free < limits(own)["waves"] <= 0.5 * free * (1.0 + 1e-12)  # a bound from below where it has turned


def test_inverse_of_nine():
    F = stretched(3)
    det, back = equations.inverse(F.ravel())
    assert det == pytest.approx(np.linalg.det(F))
    np.testing.assert_allclose(np.reshape(back, (3, 3)), np.linalg.inv(F), atol=1e-14)


def test_damage_grows_with_plastic_strain_and_slows_hardening():
    """D = D_c p/p_f and r = p - D_c p^2/(2 p_f) where p_f does not change; sheared in small steps."""
    p_f, critical, steps = 0.5, 0.4, 200
    own = stepper(
        solid={"yield_stress_Pa": 1e4, "failure": [p_f, 0.0, 0.0, 0.0, 0.0], "critical_damage": critical}
    )  # fmt: skip
    for n in range(steps):
        F = np.eye(3)
        F[0, 1] = 0.3 * (n + 1) / steps
        moved(own, own.reference @ F.T)
    p = own.strained[5]
    assert 0.1 < p < 0.2
    assert own.harm[5] == pytest.approx(critical * p / p_f, rel=1e-12)
    assert own.hardened[5] == pytest.approx(p - critical * p**2 / (2.0 * p_f), rel=1e-3)
    tau = own.kirchhoff[5]
    spread = tau[:3] - tau[:3].mean()
    q = np.sqrt(1.5 * (spread @ spread + 2.0 * tau[3] ** 2))
    assert q == pytest.approx((1.0 - own.harm[5]) * 1e4, rel=2e-3)  # of D before the last step
