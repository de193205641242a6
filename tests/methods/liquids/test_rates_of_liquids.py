"""The loops over liquids against the sums written out pair by pair, and what the sums must keep."""

import numpy as np
import pytest
from matrices import corrections
from shaken_liquids import LIQUID_OF_TANK, stepper

from sdph.engine import kernels as smoothing
from sdph.engine.state import LIQUID, WALL, positions, velocities
from sdph.laws import eos
from sdph.methods.liquids import equations as rates
from sdph.methods.liquids import walls
from sdph.methods.liquids.loads import loads, wall_loads


@pytest.mark.parametrize("dimensions", [2, 3])
@pytest.mark.parametrize(
    ("kernel", "gradient"), [("wendland_c2", "plain"), ("cubic_spline", "plain"), ("wendland_c2", "corrected")]
)
def test_acceleration_is_the_sum_over_all_pairs(dimensions, kernel, gradient):
    own = stepper(dimensions, pressed=True, liquid=LIQUID_OF_TANK | {"kernel": kernel, "pressure_gradient": gradient})
    corrected = gradient == "corrected"
    B = corrections(own) if corrected else np.zeros((len(own.state.x), 3, 3)) + np.eye(3)
    surface = [i for i in own.active if np.array_equal(B[i], np.eye(3))]
    assert not corrected or 0 < len(surface) < len(own.active)
    s, p = own.state, own.p
    r, v = positions(s), velocities(s)
    wet = s.kind == LIQUID
    volume = np.where(wet, s.mass / s.density, 0.05**dimensions)
    lowest = np.flatnonzero(wet)[np.argmin(r[wet, dimensions - 1])]
    for i in [lowest, *np.flatnonzero(wet)[::7]]:
        d = r[i] - r
        distance = np.linalg.norm(d, axis=1)
        near = (distance < 2.0 * own.kernel.h) & (np.arange(len(r)) != i)
        expected = np.zeros(3)
        for j in np.flatnonzero(near):
            slope = smoothing.slope.py_func(own.kernel, distance[j])
            closing = (v[i] - v[j]) @ d[j]
            ringing = -p["liquid_damping"].strength * closing / (distance[j] ** 2 + p["liquid_damping"].softening)
            held_off = (
                0.0 if wet[j] else s.density[i] * 20.0**2 * max(0.0, 1.0 - distance[j] / (0.025 * dimensions**0.5))
            )
            expected -= volume[j] * slope * (own.pressure[i] * B[i] + own.pressure[j] * B[j if wet[j] else i]) @ d[j]
            expected -= volume[j] * slope * (ringing + held_off) * d[j]
            expected += volume[j] * slope * 2.0 * 1.0 * (v[i] - v[j])
        expected = expected / s.density[i]
        expected[dimensions - 1] -= 9.81
        assert np.allclose(own.acceleration[i], expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())


@pytest.mark.parametrize("dimensions", [2, 3])
def test_density_rate_is_the_sum_over_all_pairs(dimensions):
    own = stepper(dimensions)
    s = own.state
    rates.compress(
        own.kernel, s, own.rows, own.neighbours.box, own.flow, own.wall, own.moving, own.p["density_diffusion"],
        own.phases, (), own.gradient, own.rate,
    )  # fmt: skip
    r, v = positions(s), velocities(s)
    wet = s.kind == LIQUID
    v[~wet] = 0.0
    strength = own.p["density_diffusion"].strength
    for i in np.flatnonzero(wet)[::7]:
        expected = 0.0
        for j in np.flatnonzero(np.linalg.norm(r - r[i], axis=1) < 2.0 * own.kernel.h):
            if j == i:
                continue
            d = r[i] - r[j]
            slope = smoothing.slope.py_func(own.kernel, np.linalg.norm(d))
            expected += s.density[i] * abs(own.volume[j]) * slope * ((v[i] - v[j]) @ d)
            if wet[j]:
                psi = 2.0 * (own.pressure[j] - own.pressure[i]) + sum(
                    (g[i] + g[j]) * d[a] for a, g in enumerate(own.gradient.T)
                )
                expected -= strength * own.volume[j] * slope * psi
        assert own.rate[i] == pytest.approx(expected, rel=1e-9, abs=1e-6)


def test_a_linear_pressure_does_not_diffuse():
    own = stepper(3)
    own.pressure[:] = 1e4 + 3e3 * positions(own.state) @ np.array([1.0, -2.0, 0.5])
    s = own.state
    rates.push(
        own.kernel, s, own.rows, own.neighbours.box, own.flow, own.wall, own.p["gravity"], own.frame,
        own.p["laminar_viscosity"], own.p["liquid_damping"], own.p["density_diffusion"], own.p["shifting"], own.phases,
        own.excess, own.acceleration, own.gradient,
    )  # fmt: skip
    for array in (s.u, s.v, s.w):
        array[:] = 0.0
    rates.compress(
        own.kernel, s, own.rows, own.neighbours.box, own.flow, own.wall, own.moving, own.p["density_diffusion"],
        own.phases, (), own.gradient, own.rate,
    )  # fmt: skip
    assert np.allclose(own.gradient[own.active], [3e3, -6e3, 1.5e3], rtol=1e-9)
    assert np.abs(own.rate[own.active]).max() < 1e-9


@pytest.mark.parametrize("dimensions", [2, 3])
@pytest.mark.parametrize("gradient", ["plain", "corrected"])
def test_walls_feel_what_the_liquid_loses(dimensions, gradient):
    own = stepper(dimensions, pressed=True, liquid=LIQUID_OF_TANK | {"pressure_gradient": gradient})
    momentum, felt = loads(own), wall_loads(own)
    assert np.allclose(momentum[:3], felt[:3], rtol=1e-9, atol=1e-9 * np.abs(felt).max())


@pytest.mark.parametrize(("gradient", "error"), [("plain", 0.01), ("corrected", 1e-12)])
def test_a_strained_lattice_does_not_resist(gradient, error):
    """A pressure that is linear accelerates by -grad p/rho, however a lattice is strained: else it had a stress of its
    own."""
    pools = {"water": {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [1.0, 1.0]}}
    domain = {"size_m": [1.0, 1.0], "gravity_m_s2": [0.0, 0.0]}
    own = stepper(
        2, ("density_diffusion",), liquid=LIQUID_OF_TANK | {"pressure_gradient": gradient}, pools=pools, domain=domain
    )
    s, slope = own.state, np.array([3e3, -2e3])
    s.x[:], s.y[:] = (0.05 * (np.round(a / 0.05 - 0.5) + 0.5) for a in (s.x, s.y))
    s.x[:], s.y[:] = 1.1 * s.x, s.y / 1.1
    s.u[:], s.v[:] = 0.0, 0.0
    pressure = 2e4 + slope @ np.stack([s.x, s.y])
    s.density[:] = eos.tait_density(pressure, 1000.0, 20.0, 7.0, 0.0)
    s.mass[:] = s.density * 0.05**2  # so that all volumes are alike
    own.forces()
    s = own.state
    inside = (np.abs(s.x - 0.55) < 0.2) & (np.abs(s.y - 0.45) < 0.2)
    found = own.acceleration[inside, :2] * s.density[inside, None] / -slope
    assert inside.sum() > 20 and error / 10.0 < np.abs(found - 1.0).max() + 1e-13 < 10.0 * error


@pytest.mark.parametrize("dimensions", [2, 3])
def test_a_particle_among_those_of_a_wall_is_pushed_out(dimensions):
    """At rest, without pressure, between the particles of the first layer: nothing else would move it."""
    lower = [0.25] * (dimensions - 1) + [0.0]
    pools = {"water": {"shape": "box", "lower_m": lower, "upper_m": [x + 0.05 for x in lower]}}
    own = stepper(dimensions, ("density_diffusion", "liquid_damping", "tank"), pools=pools)
    i, s = own.active[0], own.state
    for axis in (s.x, s.y, s.z)[:dimensions]:
        axis[i] = 0.3
    for velocity in (s.u, s.v, s.w)[:dimensions]:
        velocity[i] = 0.0
    s.density[i] = 1000.0
    for depth in (0.002, 0.01, 0.02):
        (s.y if dimensions == 2 else s.z)[i] = -depth
        own.forces()
        i, s = own.active[0], own.state
        assert own.acceleration[i, dimensions - 1] > 9.81


@pytest.mark.parametrize("gradient", ["plain", "corrected"])
def test_without_walls_momentum_stays(gradient):
    own = stepper(
        3,
        effects=("density_diffusion", "liquid_damping", "laminar_viscosity"),
        liquid=LIQUID_OF_TANK | {"pressure_gradient": gradient},
    )
    before = (own.state.mass[:, None] * velocities(own.state)).sum(axis=0)
    scale = (own.state.mass[:, None] * np.abs(velocities(own.state))).sum()
    for _ in range(20):
        own.step(1.0)
    after = (own.state.mass[:, None] * velocities(own.state)).sum(axis=0)
    assert np.abs(after - before).max() < 1e-12 * scale


def test_steps_move_the_particles():
    own = stepper(2)
    places, density = positions(own.state).copy(), own.state.density.copy()
    dt = own.step(1.0)
    wet = own.state.kind == LIQUID
    assert dt > 0.0
    assert (np.abs(positions(own.state) - places)[wet].max(axis=1) > 0.0).all()
    assert (own.state.density != density)[wet].all()
    assert np.array_equal(positions(own.state)[~wet], places[~wet])


def test_walls_extrapolate_a_hydrostatic_pressure():
    own = stepper(2)
    s = own.state
    s.u[:], s.v[:] = 0.0, 0.0
    s.density[own.active] = 1000.0
    own.pressure[own.active] = 1000.0 * 9.81 * (0.4 - s.y[own.active])
    walls.extrapolate(
        own.kernel,
        s,
        own.rows,
        own.neighbours.box,
        own.walls,
        own.wall,
        own.moving,
        own.p["gravity"],
        own.frame,
        own.volume,
        own.pressure,
        s.u,
        s.v,
        s.w,
    )
    below = own.walls[
        (s.y[own.walls] < 0.0) & (s.y[own.walls] > -0.1) & (s.x[own.walls] > 0.0) & (s.x[own.walls] < 0.5)
    ]
    assert np.allclose(own.pressure[below], 9810.0 * (0.4 - s.y[below]), rtol=1e-12)


def test_wall_particles_are_told_by_kind():
    own = stepper(2)
    assert (
        (own.state.kind[own.walls] == WALL).all()
        and (own.volume[own.walls] < 0.0).all()
        and (own.volume[own.active] > 0.0).all()
    )


def test_what_is_no_number_is_not_lost():
    """The flags of the loops let sums be reordered, but nan stays nan: else a run that bursts would go on."""
    own = stepper(2)
    own.state.density[own.active[0]] = np.nan
    own.forces()
    assert (
        np.isnan(own.acceleration[own.active[0]]).any() and np.isnan(own.acceleration[own.active]).any(axis=1).sum() > 3
    )
