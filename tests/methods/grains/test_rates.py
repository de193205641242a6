"""The loops over neighbours against plain numpy over all pairs, and the decay of a cosine by conduction."""

import math
from types import SimpleNamespace

import exact_solutions as solutions
import numpy as np
import pytest
from builders import OPEN, cloud, conduction_heating, disc, summed_density
from hypothesis import given
from hypothesis import strategies as st
from numba import prange

from sdph.effects import OFF
from sdph.effects.grains import conduction
from sdph.engine import state as particles
from sdph.engine.geometry import box_of
from sdph.engine.neighbours import Neighbours
from sdph.engine.rows import entry
from sdph.laws import kernels
from sdph.laws.compiled import fast_parallel
from sdph.laws.constants import SOFTENING
from sdph.methods.grains import equations as rates
from sdph.methods.grains import sound

H = 0.1
SIGMA = {dims: kernels.normalisation("cubic_spline", dims, H) for dims in (2, 3)}
GRAINS = conduction.ConductionP(500.0, 3060.0)
PERIOD = {2: (0.9, 0.7, 0.0), 3: (0.5, 0.0, 0.6)}

rngs = st.integers(0, 2**32 - 1).map(np.random.default_rng)
dimensions = st.sampled_from([2, 3])
periodic = st.booleans()


def random_cloud(rng, count, dims):
    state = cloud(rng.uniform(0.0, 0.7, (count, dims)))
    for name, low, high in (("mass", 0.5, 2.0), ("density", 500.0, 3000.0), ("temperature", 200.0, 400.0)):
        getattr(state, name)[:] = rng.uniform(low, high, count)
    return state


def separations(state, period):
    """(N, N, d) r_i - r_j of all pairs, the nearest images."""
    here = np.stack(particles.axes(state), axis=1)
    apart = here[:, None] - here[None]
    for a, length in enumerate(period[: here.shape[1]]):
        if length:
            apart[..., a] -= length * np.rint(apart[..., a] / length)
    return apart


def spline(r, dims):
    """W and dW/dr of the cubic spline, as Monaghan & Lattanzio write it."""
    q = r / H
    near, far = q < 1.0, (q >= 1.0) & (q < 2.0)
    value = np.where(near, 1.0 - 1.5 * q**2 + 0.75 * q**3, np.where(far, 0.25 * (2.0 - q) ** 3, 0.0))
    slope = np.where(near, -3.0 * q + 2.25 * q**2, np.where(far, -0.75 * (2.0 - q) ** 2, 0.0))
    return SIGMA[dims] * value, SIGMA[dims] * slope / H


@given(rng=rngs, count=st.integers(0, 80), dims=dimensions, wrapped=periodic)
def test_density_is_the_sum_over_all(rng, count, dims, wrapped):
    period = PERIOD[dims] if wrapped else OPEN
    state, density = summed_density(rates.Kernel(H, SIGMA[dims]), random_cloud(rng, count, dims), period)
    r = np.linalg.norm(separations(state, period), axis=2)
    np.testing.assert_allclose(density, spline(r, dims)[0] @ state.mass, rtol=1e-12)


@given(rng=rngs, count=st.integers(0, 80), dims=dimensions, wrapped=periodic)
def test_conduction_is_the_sum_of_cleary_and_monaghan(rng, count, dims, wrapped):
    period = PERIOD[dims] if wrapped else OPEN
    state, heating = conduction_heating(rates.Kernel(H, SIGMA[dims]), random_cloud(rng, count, dims), GRAINS, period)
    r = np.linalg.norm(separations(state, period), axis=2)
    k = state.density / 3060.0 * 500.0
    mean = 4.0 * k[:, None] * k[None] / (k[:, None] + k[None])
    factor = state.mass[None] / (state.density[:, None] * state.density[None]) * mean
    slope = r * spline(r, dims)[1] / (r**2 + 0.01 * H**2)
    pairs = factor * slope * (state.temperature[:, None] - state.temperature[None])
    np.testing.assert_allclose(
        heating, pairs.sum(axis=1), rtol=1e-10, atol=1e-12 * np.abs(pairs).sum(axis=1).max(initial=0.0)
    )


@given(rng=rngs, count=st.integers(2, 80), dims=dimensions, wrapped=periodic)
def test_conduction_keeps_the_heat_and_makes_entropy(rng, count, dims, wrapped):
    """sum m q = 0 to round-off; sum m q/T >= 0: heat runs from hot to cold."""
    period = PERIOD[dims] if wrapped else OPEN
    state, heating = conduction_heating(rates.Kernel(H, SIGMA[dims]), random_cloud(rng, count, dims), GRAINS, period)
    power = state.mass * heating
    assert abs(math.fsum(power)) <= 1e-13 * np.abs(power).sum()
    assert (power / state.temperature).sum() >= 0.0


def test_coincident_pair_stays_finite():
    _state, heating = conduction_heating(
        rates.Kernel(H, SIGMA[2]), cloud([[0.1, 0.1], [0.1, 0.1]], temperature=[300.0, 400.0]), GRAINS
    )
    np.testing.assert_array_equal(heating, 0.0)


@pytest.mark.parametrize(("dims", "sides"), [(2, (24, 24)), (3, (12, 12, 12))])
def test_lattice_has_its_own_density(dims, sides):
    """A periodic lattice at alpha_p = 0.6 sums to 0.6 rho_p to round-off: the kernel is divided by its lattice sum."""
    dx = 2.5e-3
    points = np.stack(np.meshgrid(*[(np.arange(n) + 0.5) * dx for n in sides]), axis=-1).reshape(-1, dims)
    kernel = rates.kernel_of(disc()) if dims == 2 else rates.Kernel(1.5 * dx, kernel_in_space(1.5 * dx))
    _state, density = summed_density(
        kernel, cloud(points, mass=0.6 * 3060.0 * dx**dims), (*(n * dx for n in sides), 0.0)[:3]
    )
    np.testing.assert_allclose(density, 0.6 * 3060.0, rtol=1e-12)


def kernel_in_space(h):
    return kernels.normalisation("cubic_spline", 3, h) / kernels.lattice_factor("cubic_spline", 3, 1.5)


@pytest.mark.parametrize(("mode", "bias"), [(1, 0.01), (2, 0.012)])
def test_cosine_decays_by_conduction(mode, bias):
    """Against exp(-D k^2 t) on a periodic lattice, 96 and 48 particles to the wave.

    Exact to 1e-9 for what the sum over the lattice says of this very mode, and within `bias` of the continuum:
    +0.67 % of the lattice (`lattice_divergence_factor`), -0.34 % of the kernel divided by its lattice sum, -1.15 % of
    eta^2 = 0.01 h^2, and -0.1 %, -0.3 % for the curvature of the wave.
    """
    case = disc()
    dx, count = case.resolution.spacing, 96
    length = count * dx
    axis = (np.arange(count) + 0.5) * dx
    points = np.stack(np.meshgrid(axis, axis[:8], indexing="ij"), axis=-1).reshape(-1, 2)
    k = 2.0 * math.pi * mode / length
    temperature = 300.0 + np.cos(k * points[:, 0])
    state = cloud(points, mass=0.6 * 3060.0 * dx**2, temperature=temperature, density=0.6 * 3060.0)
    parameters, kernel = conduction.kernel(case), rates.kernel_of(case)
    diffusivity = solutions.thermal_diffusivity(500.0, 3060.0, 2470.0)
    dt = 1e-3 / (diffusivity * k**2)
    for _ in range(1000):
        state, heating = conduction_heating(kernel, state, parameters, (length, 8 * dx, 0.0))
        state.temperature[:] += heating * dt / 2470.0
    amplitude = 2.0 * np.mean((state.temperature - 300.0) * np.cos(k * state.x))
    rate = -math.log(amplitude) / (1000 * dt)
    explicit = -math.log1p(-1e-3 * lattice_rate(kernel, dx, k)) / 1e-3
    assert rate == pytest.approx(explicit * diffusivity * k**2, rel=1e-9)
    assert amplitude == pytest.approx(solutions.cosine_decay(1000 * dt, k, diffusivity), rel=bias)


def lattice_rate(kernel, dx, k):
    """Decay rate of cos(kx) over D k^2 by the pair sum on the lattice, without the code's loops."""
    reach = math.ceil(2.0 * kernel.h / dx)
    x, y = (a.ravel() * dx for a in np.meshgrid(*2 * [np.arange(-reach, reach + 1.0)]))
    r = np.hypot(x, y)
    slope = np.array([kernels.cubic_spline_gradient(d, kernel.h, kernel.sigma) for d in r])
    return -2.0 * dx**2 * (slope * r**2 / (r**2 + SOFTENING * kernel.h**2) * (1.0 - np.cos(k * x))).sum() / k**2


@fast_parallel
def by_hand(h, sigma, s, rows, box, conductivity, grain_density, on, heating):
    """The loop with conduction written in, and nothing else."""
    for i in prange(len(s.x)):
        heat = 0.0
        if on:
            for k in range(rows.number[i]):
                j = entry(rows, i, k)
                dx, dy = s.x[i] - s.x[j], s.y[i] - s.y[j]
                dx -= box.length_x * np.rint(dx * box.inverse_x)
                dy -= box.length_y * np.rint(dy * box.inverse_y)
                r2 = dx * dx + dy * dy + 0.0
                gradient = kernels.cubic_spline_gradient(np.sqrt(r2), h, sigma)
                k_i, k_j = s.density[i] / grain_density * conductivity, s.density[j] / grain_density * conductivity
                c = 4.0 * s.mass[j] / (s.density[i] * s.density[j]) * k_i * k_j / (k_i + k_j)
                c *= gradient * r2 / (r2 + SOFTENING * h**2)
                heat += c * (s.temperature[i] - s.temperature[j])
        heating[i] = heat


@pytest.mark.parametrize("on", [True, False])
def test_effect_set_is_the_loop_written_by_hand(on):
    """To the rounding of a sum in another order (`rates.loop` lets the compiler choose it); off is nothing at all."""
    state, rows = Neighbours(2.0 * H, PERIOD[2]).update(random_cloud(np.random.default_rng(4), 400, 2))
    box, kernel = box_of(PERIOD[2], 2), rates.Kernel(H, SIGMA[2])
    ours, theirs = np.full(400, np.nan), np.full(400, np.nan)
    pull = np.empty(len(rows.entries))
    rates.sum_density(kernel, state, rows, box, OFF, OFF, np.empty(400), pull)
    rates.conduct(kernel, state, rows, box, pull, GRAINS if on else OFF, np.empty(0), ours)
    by_hand(H, SIGMA[2], state, rows, box, *GRAINS, on, theirs)
    np.testing.assert_allclose(ours, theirs, rtol=1e-13, atol=1e-14 * np.abs(theirs).max())
    assert ours.any() == on


def test_every_output_is_written():
    """Nan that stays would show one that is not."""
    state = random_cloud(np.random.default_rng(8), 50, 2)
    for found in (
        summed_density(rates.Kernel(H, SIGMA[2]), state),
        conduction_heating(rates.Kernel(H, SIGMA[2]), state, GRAINS),
    ):
        assert np.isfinite(found[1]).all()
        assert np.abs(found[1]).max() > 0.0


def waves_along(dims, way, pressure):
    """(omega h/c)^2 of waves along an axis of a lattice with h = 1.5 dx and a kernel divided by its sum, under a
    pressure [rho c^2]; second derivatives by differences."""
    dx = H / 1.5
    place = dx * np.stack(np.meshgrid(*[np.arange(-4, 5)] * dims), axis=-1).reshape(-1, dims)
    lattice = dx**dims * spline(np.linalg.norm(place, axis=1), dims)[0].sum()
    place = place[place.any(axis=1)]
    x, r = place @ way, np.linalg.norm(place, axis=1)
    pull = dx**dims / lattice * spline(r, dims)[1] / r  # V (dW/dr)/r
    shifted = 1e-6 * H * way
    ahead, behind = (np.linalg.norm(place + side * shifted, axis=1) for side in (1.0, -1.0))
    bent = spline(ahead, dims)[1] / ahead * (x + 1e-6 * H) - spline(behind, dims)[1] / behind * (x - 1e-6 * H)
    bent *= dx**dims / lattice / (2e-6 * H)
    waves = np.linspace(0.01, 1.0, 200)[:, None] * np.pi / dx * x
    compression, push = (pull * x * np.sin(waves)).sum(axis=1) ** 2, (bent * (1.0 - np.cos(waves))).sum(axis=1)
    return H**2 * (compression + 2.0 * pressure * push).max()


@pytest.mark.parametrize("dims", [2, 3])
@pytest.mark.parametrize("pressure", [0.0, 0.1, 0.5, 1.0])
def test_sound_is_stable_up_to_what_its_limit_is_a_share_of(dims, pressure):
    """von Neumann: summed density, pressures up to rho c^2; velocities first, then places, bear omega dt = 2."""
    resolution = SimpleNamespace(smoothing_ratio=1.5)
    waves = sound.waves_of(SimpleNamespace(resolution=resolution, dimensions=dims))
    swings = math.sqrt(waves_along(dims, np.eye(dims)[0], pressure))
    borne, taken = 2.0 / swings, sound.limit(1.0, sound.swing(waves, 1.0, pressure))  # of h/c
    print(f"{dims}-D, p = {pressure} rho c^2: a lattice bears {borne:.3f} h/c, a sub-step is {taken:.3f} h/c")
    assert 0.92 * borne < 2.0 / sound.SWING * taken <= borne * (1.0 + 1e-12)
