"""Grains of several materials: those that are alike are one; streams brake each other by Syamlal's law; conduction."""

import math

import numpy as np
import pytest
from grain_boxes import DENSITY, SPACING, box, go, several, started, windows
from scipy.spatial import cKDTree

from sdph.effects.grains import grain_drag
from sdph.engine import state as particles
from sdph.laws import exchange, granular, kernels
from sdph.laws import grain_drag as law
from sdph.methods.grains import mixture
from sdph.methods.grains.method import bounds_of

# all that acts between grains and on them, but drag between materials, which tells materials apart that are alike
ALL = (
    "drag", "heat", "granular_pressure", "friction", "granular_viscosity", "granular_temperature",
    "artificial_viscosity", "grain_shifting", "conduction",
)  # fmt: skip
CHAR = {"density_kg_m3": 1000.0, "diameter_mm": 0.5, "heat_capacity_J_kg_K": 2500.0, "conductivity_W_m_K": 0.2}
WHOLE = {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.06, 0.06], "temperature_K": 300.0}


def halves(names=("", ""), **more):
    """Two regions side by side that run into each other, of these materials."""
    parts = {}
    for k, (name, speed, temperature) in enumerate(zip(names, (0.3, -0.2), (300.0, 340.0))):
        low = 0.03 * k
        own = {"shape": "box", "lower_m": [low, 0.0], "upper_m": [low + 0.03, 0.06], "volume_fraction": 0.55}
        parts["bed" if k == 0 else "other"] = own | {
            "temperature_K": temperature, "velocity_m_s": [speed, 0.05], "disorder": 0.2, "seed": k
        } | ({"material": name} if name else {})  # fmt: skip
    return more | {"particles": parts}


def streams(spacing=SPACING, velocity=0.2, effects=("grain_drag",), end=0.05, count=20, alpha_p=(0.2, 0.1), **sizes):
    """Sand and char all over each other in a periodic box, the one against the other."""
    parts = {
        "bed": WHOLE | {"material": "sand", "volume_fraction": alpha_p[0], "velocity_m_s": [velocity, 0.0]},
        "other": WHOLE
        | {"material": "char", "volume_fraction": alpha_p[1], "velocity_m_s": [-velocity, 0.3 * velocity]},
    }
    grains = {"sand": {}, "char": CHAR}
    grains |= {name: grains[name] | {"diameter_mm": size} for name, size in sizes.items()}
    return several(effects, parts, grains, resolution={"spacing_mm": spacing * 1e3}, **windows(end, count))


def ordered(state):
    return particles.take(state, np.argsort(state.ident))


def test_two_materials_that_are_alike_are_one(tmp_path):
    one = go(started(box(ALL, **windows(0.02, 4), **halves()), tmp_path))
    alike = box(ALL, **windows(0.02, 4), **halves(("sand", "char"), grains={"sand": {}, "char": {}}))
    (tmp_path / "two").mkdir()
    two = started(alike, tmp_path / "two")
    two.state.material[:] = two.state.ident % 2  # among each other, particle by particle
    go(two)
    assert two.stepper.steps == one.stepper.steps > 20 and set(two.state.material) == {0, 1}
    ours, theirs = ordered(two.state), ordered(one.state)
    for name in ("x", "y", "u", "v", "density", "theta", "temperature", "contact_xx", "contact_xy"):
        scale = np.abs(getattr(theirs, name)).max()
        np.testing.assert_allclose(
            getattr(ours, name), getattr(theirs, name), rtol=0.0, atol=1e-9 * scale, err_msg=name
        )
    for key, value in one.ledger.last.items():
        if isinstance(value, float) and abs(value) > 1e-12:
            assert two.ledger.last[key] == pytest.approx(value, rel=1e-7, abs=1e-9), key


def test_unlike_materials_keep_momentum_and_energy(tmp_path):
    """All that acts between grains at once, of grains three times as heavy as others, among each other."""
    effects = (*(name for name in ALL if name not in ("drag", "heat")), "grain_drag")  # this gas has no heat
    case = box(effects, **windows(0.02, 4), **halves(("sand", "char"), grains={"sand": {}, "char": CHAR}))
    run = started(case, tmp_path)
    run.state.material[:] = run.state.ident % 2
    for name, number in (("grain_density", 0), ("grain_capacity", 1), ("grain_conductivity", 2)):
        own = np.array([grains.of_particles[number] for grains in case.kinds])
        getattr(run.state, name)[:] = own[run.state.material]
    run.state.mass[:] *= run.state.grain_density / np.where(run.state.x < 0.03, DENSITY, 1000.0)
    run.state.diameter[:] = np.array([grains.diameter for grains in case.kinds])[run.state.material]
    run.stepper.prepare()
    run.ledger.first = run.ledger.last = run.ledger.first | run._totals()
    momentum = run.state.mass @ np.column_stack((run.state.u, run.state.v))
    scale = float(run.state.mass @ np.hypot(run.state.u, run.state.v))
    go(run)
    now = run.state.mass @ np.column_stack((run.state.u, run.state.v))
    assert run.stepper.steps > 20
    np.testing.assert_allclose(now, momentum, rtol=0.0, atol=1e-12 * scale)
    told = run.ledger.summary()
    assert told["motion_drift_rel"] < 1e-10 and told["energy_drift_rel"] < 1e-10
    assert told["grain_drag_J"] > 0.0


@pytest.mark.parametrize("share", [1.0, 0.5])
def test_streams_brake_each_other_by_syamlals_law(tmp_path, share):
    """du/dt = -beta (1/(alpha_m rho_m) + 1/(alpha_s rho_s)) u with beta ~ u: u0/(1 + k u0 t), on a way of spacings."""
    alpha_p, sizes = (0.04, 0.03), {"sand": 2.0, "char": 3.0}
    run = started(streams(share * SPACING, end=0.2, count=40, alpha_p=alpha_p, **sizes), tmp_path)
    s = run.state
    momentum = np.array([s.mass @ s.u, s.mass @ s.v])
    start = particles.energy_of_motion(s)
    go(run)
    s = run.state
    sand, char = s.material == 0, s.material == 1
    g0 = granular.sinclair_jackson(sum(alpha_p), 0.63)
    per = law.syamlal(0.9, 0.0, DENSITY, 1000.0, 2e-3, 3e-3, g0, 1.0)
    k, first = per * (alpha_p[1] / DENSITY + alpha_p[0] / 1000.0), math.hypot(0.4, 0.06)
    apart = math.hypot(s.u[sand].mean() - s.u[char].mean(), s.v[sand].mean() - s.v[char].mean())
    expected = first / (1.0 + k * first * 0.2)
    print(k, first, expected / first, math.log1p(k * first * 0.2) / k / SPACING, apart / expected - 1.0)
    assert expected < 0.2 * first  # most of it is gone
    assert apart == pytest.approx(expected, rel=0.01)
    np.testing.assert_allclose([s.mass @ s.u, s.mass @ s.v], momentum, rtol=0.0, atol=1e-12 * s.mass.sum() * 0.2)
    lost = start - particles.energy_of_motion(s)
    sums = run.ledger.sums
    assert sums["grain_drag_J"] == pytest.approx(lost, rel=1e-10)
    assert sums["mechanical_heat_J"] == pytest.approx(lost, rel=1e-10)  # no theta: into the grains' heat
    assert run.ledger.summary()["motion_drift_rel"] < 1e-12


def test_what_drag_between_materials_takes_feeds_theta(tmp_path):
    effects = ("grain_drag", "granular_pressure", "granular_temperature")
    run = started(streams(effects=effects, end=1e-3, count=2), tmp_path)
    before = float(1.5 * run.state.mass @ run.state.theta)
    go(run)
    sums = run.ledger.sums
    gained = float(1.5 * run.state.mass @ run.state.theta) - before
    assert sums["grain_drag_J"] > 0.0
    assert sums["agitation_J"] == pytest.approx(sums["grain_drag_J"], rel=0.02)  # the rest is by pressure
    assert gained == pytest.approx(sums["agitation_J"] - sums["collision_heat_J"] + sums["bounds_work_J"], rel=1e-9)


def test_a_stiff_drag_makes_one_speed_of_two_and_never_more(tmp_path):
    """However long the step: pairs exchange at most what makes their velocities equal, and momentum stays."""
    run = started(streams(), tmp_path)
    own, s = run.stepper, run.state
    crowd, stiff = np.full(len(s.x), 1.6), np.empty(len(s.x))
    moved, lost = np.empty((len(s.x), 3)), np.empty(len(s.x))
    for dt in (1e-6, 1e-2, 1e3):
        args = own.parameters["grain_drag"], own.kernel, s, own.rows, own.neighbours.box, crowd, dt, stiff
        grain_drag.stiffen(*args)
        grain_drag.exchange(*args, moved, lost)
        u, v = s.u + moved[:, 0], s.v + moved[:, 1]
        assert np.abs(u).max() <= 0.2 and np.abs(v).max() <= 0.06
        assert abs(s.mass @ moved[:, 0]) < 1e-12 * s.mass.sum() * 0.2
        before, after = (0.5 * float(s.mass @ (a * a + b * b)) for a, b in ((s.u, s.v), (u, v)))
        assert (lost >= 0.0).all() and s.mass @ lost == pytest.approx(before - after, rel=1e-11)
    slow = [s.u[s.material == number].mean() + moved[s.material == number, 0].mean() for number in (0, 1)]
    assert slow[0] == pytest.approx(slow[1], abs=1e-4)


def test_pairs_weigh_by_volume():
    """What stress weighs: q_ij symmetric, 1 of alike grains; the ratio of densities; nothing of a plain kernel."""
    s = particles.empty(2, particles.OF_MATERIAL)
    s.grain_density[:] = 3000.0, 1000.0
    mixed, plain = mixture.MixedKernel(1.0, 1.0, 2000.0), mixture.Kernel(1.0, 1.0)
    assert mixture.by_volume(mixed, s, 0, 1) == mixture.by_volume(mixed, s, 1, 0) == pytest.approx(4.0 / 3.0)
    assert mixture.over(mixed, s, 0, 1) == pytest.approx(3.0) and mixture.heft_squared(mixed, s, 1) == 0.25
    assert [mixture.by_volume(plain, s, 0, 1), mixture.over(plain, s, 0, 1), mixture.heft_squared(plain, s, 1)] == [
        1.0
    ] * 3


def test_alpha_p_is_of_all_grains(tmp_path):
    """Two materials among each other: the sum over both, whatever their densities."""
    run = started(streams(), tmp_path)
    s = run.state
    np.testing.assert_allclose(s.density / s.grain_density, 0.3, rtol=0.01)
    kernel, i = run.stepper.kernel, 0
    dx, dy = (a[i] - a - 0.06 * np.round((a[i] - a) / 0.06) for a in (s.x, s.y))
    by_hand = sum(
        m / rho * kernels.cubic_spline(r, kernel.h, kernel.sigma)
        for m, rho, r in zip(s.mass, s.grain_density, np.hypot(dx, dy))
    )
    assert s.density[i] / s.grain_density[i] == pytest.approx(by_hand, rel=1e-12)


def test_two_materials_come_to_one_temperature(tmp_path):
    """By conduction alone, of other heat capacities: sum m c T/sum m c, energy to round-off."""
    parts = {
        "bed": WHOLE | {"material": "sand", "volume_fraction": 0.2, "temperature_K": 300.0},
        "other": WHOLE | {"material": "char", "volume_fraction": 0.3, "temperature_K": 400.0},
    }
    grains = {"conductivity_W_m_K": 20.0, "sand": {}, "char": CHAR | {"conductivity_W_m_K": 50.0}}
    run = started(several(["conduction"], parts, grains, **windows(60.0, 10)), tmp_path)
    capacity = run.state.mass * run.state.grain_capacity
    mean, before = float(capacity @ run.state.temperature / capacity.sum()), float(capacity @ run.state.temperature)
    sand = 0.2 * DENSITY * 1000.0
    char = 0.3 * 1000.0 * 2500.0
    assert mean == pytest.approx((sand * 300.0 + char * 400.0) / (sand + char), rel=1e-12)
    go(run)
    capacity = run.state.mass * run.state.grain_capacity
    np.testing.assert_allclose(run.state.temperature, mean, rtol=1e-6)
    assert float(capacity @ run.state.temperature) == pytest.approx(before, rel=1e-12)


def test_regions_at_one_place_are_staggered(tmp_path):
    """No particle of the one stands on one of the other: they are a diagonal of half a spacing apart."""
    s = started(streams(), tmp_path).state
    first, second = (np.column_stack((s.x, s.y))[s.material == number] for number in (0, 1))
    nearest, _ = cKDTree(first, boxsize=0.06).query(second)
    np.testing.assert_allclose(nearest, math.sqrt(0.5) * SPACING, rtol=1e-9)


def test_pressure_acts_by_volume(tmp_path):
    """Against sums written out here: m_i a_i = -sum V_i V_j (p_i/alpha_i^2 + p_j/alpha_j^2) grad W, p by its own rho_p,
    on particles off their lattice."""
    grains = {"sand": {}, "char": CHAR}
    parts = {
        name: WHOLE | {"material": name, "volume_fraction": 0.25, "disorder": 0.2, "seed": seed}
        for seed, name in enumerate(grains)
    }
    run = started(several(["granular_pressure"], parts, grains, **windows(1e-3, 1)), tmp_path)
    own, s = run.stepper, run.state
    s.theta[:] = np.random.default_rng(1).uniform(0.5, 2.0, len(s.x)) * 1e-3
    own._constitute()
    loop, given = own.loops(1e-5)["rates"]
    loop(*given)
    alpha_p, volume = s.density / s.grain_density, s.mass / s.grain_density
    g0 = 1.0 / (1.0 - np.cbrt(alpha_p / 0.63))
    p = alpha_p * s.grain_density * s.theta * (1.0 + 2.0 * 1.9 * alpha_p * g0)
    apart = np.stack([a[:, None] - a[None] - 0.06 * np.round((a[:, None] - a[None]) / 0.06) for a in (s.x, s.y)])
    r = np.hypot(*apart)
    slope = np.vectorize(lambda r: kernels.cubic_spline_gradient(r, own.kernel.h, own.kernel.sigma))(r)
    both = p / alpha_p**2
    pull = volume[:, None] * volume[None] * (both[:, None] + both[None]) * slope
    expected = -(pull * apart).sum(axis=2) / s.mass
    scale = np.abs(expected).max()
    np.testing.assert_allclose(own.work.acceleration[:, :2].T, expected, rtol=0.0, atol=1e-11 * scale)


def test_conduction_of_a_pair_of_two_materials():
    """4 m_j/(rho_i rho_j) K_i K_j/(K_i + K_j), K = alpha_p k; of alike grains that of one material."""
    unlike = exchange.cleary_monaghan_unlike(-3.0, 1e-4, 1e-6, 0.3 * 2.0, 0.4 * 5.0, 900.0 * 400.0)
    assert unlike == pytest.approx(-4.0 * 3.0 / 3.6e5 * 0.6 * 2.0 / 2.6 * 1e-4 / 1.01e-4, rel=1e-12)
    alike = exchange.cleary_monaghan_unlike(-3.0, 1e-4, 1e-6, 0.3 * 2.0, 0.4 * 2.0, 900.0 * 1200.0)
    assert alike == pytest.approx(exchange.cleary_monaghan(-3.0, 1e-4, 1e-6, 2.0, 3000.0, 1050.0), rel=1e-12)


def test_a_limit_of_several_materials_knows_the_grains_of_nozzles():
    """The widest of all, whatever [grains] says: the viscosity of theirs is as much larger."""
    nozzle = {
        "centre_m": [0.03, 0.05], "direction": [0.0, -1.0], "width_m": 0.01, "rate_kg_s": 0.1, "speed_m_s": 1.0,
        "temperature_K": 300.0, "material": "char", "diameter_mm": 4.0,
    }  # fmt: skip
    parts = {"bed": WHOLE | {"material": "sand", "volume_fraction": 0.2}}
    case = several(("inflow",), parts, {"sand": {}, "char": CHAR}, nozzles={"feed": nozzle})
    assert bounds_of(case)[2:] == (DENSITY, 4e-3)
