"""Heat of grains from walls: closed forms of a bed beside a hot wall, both sides against each other, limits."""

import math

import numpy as np
import pytest
from grain_boxes import box, go, several, started, windows
from scipy.special import erfc, erfcx
from test_wall_parts import tubes

from sdph import effects
from sdph.case import forces
from sdph.effects.around import wall_heat
from sdph.engine import state as particles
from sdph.laws import wall_heat as law
from sdph.schema import CaseError
from sdph.study.explain import tables

STILL = ("conduction", "walls", "wall_heat")
BED = ("gravity", "granular_pressure", "friction", "granular_viscosity", "artificial_viscosity", *STILL)
HOT = {"hot": {"kind": "wall", "side": "bottom", "temperature_K": 400.0}, "rest": {"kind": "wall"}}
K, STORED = 0.5 * 1.0, 0.5 * 3060.0 * 1000.0  # of the bed: alpha_p k [W/(m K)], alpha_p rho c [J/(m3 K)]


def bed(on=STILL, end=1.0, count=10, spacing=5.0, size=(0.04, 0.1), **more):
    given = {"boundaries": HOT, "resolution": {"spacing_mm": spacing}} | windows(end, count) | more
    return box(on, size=size, periodic=(), **given)


def half_space(h, y, time):
    """Share of the way to a wall's temperature at y [m], and heat [J/(m2 K)] that came in: Carslaw & Jaeger, 2.7."""
    way, x = np.sqrt(K / STORED * time), h * math.sqrt(time / (K * STORED))
    z = y / (2.0 * way)
    share = erfc(z) - np.exp(-z * z) * erfcx(z + x)
    return share, K * STORED / h * (erfcx(x) - 1.0 + 2.0 * x / math.sqrt(math.pi))


def exchange(own, gave, dt):
    """What a sub-step of `dt` [s] of a stepper exchanges, added to gave (F, 2)."""
    terms = own.terms
    wall_heat.exchange(
        terms.wall_heat, terms.conduction, own.kernel, own.neighbours.box, own.heated, own.state, dt, gave
    )


def inside(run):
    """Mask of the particles whose kernel no side wall cuts: conduction there has no mirror."""
    return np.abs(run.state.x - 0.02) < 0.02 - 2.0 * run.case.smoothing_length


@pytest.mark.parametrize(
    ("diameter", "spacing", "heat", "apart"),
    [(0.285, 4.0, 0.015, 0.03), (0.285, 2.0, 0.015, 0.02), (6.0, 4.0, 0.02, 0.03), (6.0, 2.0, 0.01, 0.03)],
)
def test_a_bed_beside_a_hot_wall_is_a_half_space_behind_a_contact(tmp_path, diameter, spacing, heat, apart):
    """Heat that came in, and temperatures, of good contact (Biot of a spacing 5 to 10) and bad (0.3 to 0.6)."""
    case = bed(end=400.0, count=40, spacing=spacing, grains={"diameter_mm": diameter})
    run = go(started(case, tmp_path))
    h = wall_heat.contact(wall_heat.kernel(case), 0.5, case.grains.diameter)
    expected, came = half_space(h, run.state.y, 400.0)
    own = run.grains.warmed
    found = own.sums[1, 0, 0] / own.hot.areas[0] / 100.0
    off = ((run.state.temperature - 300.0) / 100.0 - expected)[inside(run)]
    print(f"h {h:.4g} W/(m2 K), heat over exact {found / came:.4f}, temperatures off by {np.abs(off).max():.4f}")
    assert found == pytest.approx(came, rel=heat)
    assert np.abs(off).max() < apart


def test_a_layer_that_is_thinner_than_a_spacing_takes_what_a_half_space_would(tmp_path):
    """After 1 s it is 0.6 mm: heat that came in is exact to what the bed's own warming holds back."""
    case = bed(count=100)
    run = go(started(case, tmp_path))
    h = wall_heat.contact(wall_heat.kernel(case), 0.5, case.grains.diameter)
    own = run.grains.warmed
    assert own.sums[1, 0, 0] / own.hot.areas[0] / 100.0 == pytest.approx(half_space(h, 0.0, 1.0)[1], rel=0.04)
    assert (run.state.wall_age == pytest.approx(1.0)) == (run.state.y < 2.0 * case.smoothing_length).all()


def test_a_slope_between_two_walls_stays(tmp_path):
    """Floor and lid, contacts in the way: it is steady, but for the 2 % that softened pairs conduct less."""
    walls = {
        "hot": HOT["hot"],
        "cold": {"kind": "wall", "side": "top", "temperature_K": 300.0},
        "rest": {"kind": "wall"},
    }
    case = bed(end=40.0, count=4, size=(0.04, 0.04), boundaries=walls, grains={"diameter_mm": 6.0})
    run = started(case, tmp_path)
    h = wall_heat.contact(wall_heat.kernel(case), 0.5, 6e-3)
    flux = 100.0 / (2.0 / h + 0.04 / K)
    run.state.temperature[:] = 400.0 - flux * (1.0 / h + run.state.y / K)
    run.state.wall_age[:] = 1e9
    before = run.state.temperature.copy(), run.state.ident.copy()
    go(run)
    order, was = np.argsort(run.state.ident), before[0][np.argsort(before[1])]
    assert np.abs((run.state.temperature[order] - was)[inside(run)[order]]).max() < 0.2
    row = run.row()
    assert row["hot_grain_heat_W"] == pytest.approx(0.04 * flux, rel=0.02)
    assert row["cold_grain_heat_W"] == pytest.approx(-0.04 * flux, rel=0.02)


@pytest.mark.parametrize("size", [(0.03, 0.03), (0.03, 0.03, 0.03)])
def test_what_walls_give_is_what_grains_get(tmp_path, size):
    """A bed that falls onto a hot floor beside a cold side; no gas, so that heat comes from walls and from rubbing."""
    d = len(size)
    walls = {
        "hot": HOT["hot"],
        "cold": {"kind": "wall", "side": "left", "temperature_K": 250.0},
        "rest": {"kind": "wall"},
    }
    case = bed(BED, end=2e-3, count=4, size=size, boundaries=walls, gravity=(*[0.0] * (d - 1), -9.81), alpha_p=0.6)
    run = started(case, tmp_path)
    before = math.fsum(run.state.mass * run.state.temperature) * 1000.0
    go(run)
    sums = run.ledger.sums
    gained = math.fsum(run.state.mass * run.state.temperature) * 1000.0 - before
    rubbed = sums["mechanical_heat_J"] + sums["collision_heat_J"]
    scale = np.abs(run.grains.warmed.sums[1, :, 0]).sum()
    assert run.grains.warmed.sums[1, :, 0].sum() == pytest.approx(sums["heat_of_walls_J"], abs=1e-13 * scale)
    assert gained == pytest.approx(sums["heat_of_walls_J"] + rubbed, abs=1e-11 * before)  # digits of the whole heat
    faces = np.array([run.ledger.last["heat_of_walls_J"]])
    assert faces == pytest.approx(run.grains.warmed.sums[0, :, 0].sum(), rel=1e-12)


def test_each_window_hands_over_the_same_to_1e_12(tmp_path):
    """Particles that begin at 0 K, so that all digits are those of the heat."""
    run = started(bed(count=1, end=1e-3), tmp_path)
    own = run.stepper
    own.state.temperature[:] = 0.0
    rng = np.random.default_rng(1)
    own.state.wall_age[:] = rng.uniform(0.0, 1.0, len(own.state.x))
    gave = np.zeros((len(own.hot.faces.x), 2))
    exchange(own, gave, 1e-3)
    got = math.fsum(own.state.mass * own.state.temperature * 1000.0)
    assert got == pytest.approx(wall_heat.received(gave), rel=1e-12) and got > 0.0


def test_pairs_are_those_of_the_formula(tmp_path):
    """2 V A W U (T_w - T) summed by hand, U of each particle's age; a particle behind a face takes nothing of it."""
    mesh = {"walls": {"source": "mesh", "mesh": tubes(tmp_path / "tubes.vtk")}}
    parts = {"first": {"lower_m": [0.018, 0.018], "upper_m": [0.042, 0.042], "temperature_K": 400.0}}
    run = started(bed(size=(0.12, 0.06), boundaries={"rest": {"kind": "wall"}}, parts=parts, **mesh), tmp_path)
    own, s = run.stepper, run.state
    s.wall_age[:] = np.linspace(0.0, 5.0, len(s.x))
    before, faces, h = s.temperature.copy(), own.hot.faces, own.kernel.h
    dx, dy = s.x[:, None] - faces.x, s.y[:, None] - faces.y
    way, q = dx * faces.normal_x + dy * faces.normal_y, np.hypot(dx, dy) / h
    near = own.kernel.sigma * np.where(q < 1.0, 1.0 - 1.5 * q**2 + 0.75 * q**3, 0.25 * np.clip(2.0 - q, 0.0, None) ** 3)
    p = wall_heat.kernel(run.case)
    touched = p.shade * s.density / 3060.0 * law.schluender(285e-6, 0.0242, p.gap)
    passed = np.vectorize(law.passed)
    u = passed(touched[:, None], s.density[:, None] / 3060.0, s.density[:, None] * 1e3, np.maximum(way, 0.0),
               s.wall_age[:, None])  # fmt: skip
    heat = (2.0 * (s.mass / s.density)[:, None] * faces.area * near * (way > 0.0) * u).sum(axis=1)
    gave = np.zeros((len(faces.x), 2))
    ages = s.wall_age.copy()
    exchange(own, gave, 1e-3)
    rise = 1e-3 * heat * (400.0 - before) / (s.mass * 1e3)
    np.testing.assert_allclose(s.temperature - before, rise, atol=1e-11)
    beside = ((near > 0.0) & (way > 0.0)).any(axis=1)
    np.testing.assert_array_equal(s.wall_age, np.where(beside, ages + 1e-3, 0.0))
    assert 0 < beside.sum() < len(s.x)


def test_grains_that_have_left_the_wall_are_fresh(tmp_path):
    run = started(bed(count=2), tmp_path)
    run.window()
    own = run.state
    assert own.wall_age.max() == pytest.approx(0.5)
    own.y[own.wall_age > 0.0] += 0.05
    run.stepper.neighbours.built = ()
    run.stepper.prepare()
    run.window()
    assert not run.state.wall_age.any()


def test_grains_upstream_of_a_nozzle_meet_no_wall(tmp_path):
    run = started(bed(count=1), tmp_path)
    run.state.kind[:] = particles.INFLOW
    before = run.state.temperature.copy()
    own, gave = run.stepper, np.zeros((len(run.stepper.hot.faces.x), 2))
    exchange(own, gave, 1.0)
    assert not gave.any() and (run.state.temperature == before).all() and not run.state.wall_age.any()


def test_steps_of_the_limit_do_not_overshoot(tmp_path):
    """Fine grains in a corner of two hot walls, the largest share of a wall that a particle can have."""
    walls = {
        "hot": HOT["hot"],
        "too": {"kind": "wall", "side": "left", "temperature_K": 400.0},
        "rest": {"kind": "wall"},
    }
    case = bed(boundaries=walls, grains={"diameter_mm": 0.02})
    run = started(case, tmp_path)
    own = run.stepper
    limit = effects.limits(own.parameters, case, own.state)["wall_heat"]
    for axis in (own.state.x, own.state.y):
        axis[:] = np.maximum(axis - 0.25 * 5e-3, 0.25 * 5e-3)  # as near as contact lets them
    own.neighbours.built = ()
    own.prepare()
    own.state.density[:] = 0.5 * 3060.0
    before, gave = own.state.temperature.copy(), np.zeros((len(own.hot.faces.x), 2))
    exchange(own, gave, limit)
    share = (own.state.temperature - before).max() / 100.0
    print(f"{share:.3f} of the way to the wall in a sub-step of the limit")
    assert 0.2 < share < 0.6


def test_it_is_off_without_a_trace(tmp_path):
    run = started(bed(("conduction", "walls")), tmp_path)
    run.window()
    assert not len(run.state.wall_age) and not len(run.stepper.account.gave) and run.stepper.hot is None
    assert run.ledger.last["heat_of_walls_J"] == 0.0  # columns are the same in all cases
    assert not [key for key in (*run.row(), *run.grains.summary()) if "hot" in key or "area" in key]


def test_what_it_needs_is_said():
    for on, what in ((("walls", "wall_heat"), "needs conduction"), (("conduction", "wall_heat"), "needs walls")):
        with pytest.raises(CaseError, match=what):
            wall_heat.kernel(bed(on))
    with pytest.raises(CaseError, match="no wall has a temperature; give boundaries.NAME.temperature_K"):
        wall_heat.kernel(bed(boundaries={"rest": {"kind": "wall"}}))
    part = {"far": {"lower_m": [0.02, 0.05], "upper_m": [0.02, 0.05], "temperature_K": 400.0}}
    with pytest.raises(CaseError, match="parts.far.temperature_K is of the effect wall_heat; add it"):
        bed(("conduction", "walls"), parts=part)
    with pytest.raises(CaseError, match="parts.far.temperature_K is given, and no wall of grains is there"):
        forces.refuse_cold(bed(parts=part), {"hot"})
    forces.refuse_cold(bed(parts=part), {"hot", "far"})
    assert bed(parts=part | {"far": part["far"] | {"temperature_K": 470.0}}).temperatures.count(470.0) == 1


def test_explain_judges_it_where_a_wall_is_hotter_than_grains():
    """Heat into a half-space over what the bed stores: by hand 1/(1/h + sqrt(pi t/(k C))/2) t/(C L), L = 0.04 m."""
    case = bed(("conduction", "walls"), end=40.0, count=1)
    row = {own["effect"]: own for own in tables.explain(case)["effects"]}["wall_heat"]
    h = wall_heat.contact(wall_heat._kernel(case, wall_heat.WallHeat()), 0.5, 285e-6)
    number = 40.0 / (STORED * 0.04) / (1.0 / h + 0.5 * math.sqrt(math.pi * 40.0 / (K * STORED)))
    assert row["called for"] == "yes" and f"= {number:.3g} (matters from 0.01)" in row["why"]
    even = bed(
        ("conduction", "walls"), boundaries={"hot": HOT["hot"] | {"temperature_K": 300.0}, "rest": {"kind": "wall"}}
    )
    assert {own["effect"]: own for own in tables.explain(even)["effects"]}["wall_heat"]["called for"] == "no"


def test_roughness_and_accommodation_hold_heat_back():
    coarse = [
        wall_heat.contact(wall_heat.kernel(bed(wall_heat=own)), 0.5, 285e-6)
        for own in ({}, {"roughness_um": 1.0}, {"accommodation": 0.3}, {"coverage": 0.4})
    ]
    assert coarse[0] > coarse[2] > coarse[1] > 0.0 and coarse[3] == pytest.approx(0.5 * coarse[0], rel=1e-12)


def test_each_of_several_materials_takes_by_its_own_size_and_heat(tmp_path):
    """Two beds beside a hot floor, told apart by what they are: heat per area as each alone."""

    def material(diameter, capacity):
        return {
            "density_kg_m3": 3060.0,
            "diameter_mm": diameter,
            "heat_capacity_J_kg_K": capacity,
            "conductivity_W_m_K": 1.0,
        }

    kinds = {"fine": material(0.2, 1000.0), "coarse": material(1.0, 500.0)}
    region = {"shape": "box", "volume_fraction": 0.5, "temperature_K": 300.0}
    halves = {
        kind: region | {"lower_m": [low, 0.0], "upper_m": [low + 0.02, 0.1], "material": kind}
        for kind, low in (("fine", 0.0), ("coarse", 0.02))
    }
    case = several(STILL, halves, kinds, size=(0.04, 0.1), periodic=(), boundaries=HOT, **windows(1.0, 1))
    run = started(case, tmp_path)
    own, s = run.stepper, run.state
    gave = np.zeros((len(own.hot.faces.x), 2))
    before = s.temperature.copy()
    exchange(own, gave, 1e-3)
    p, rise = wall_heat.kernel(run.case), s.temperature - before
    lowest = np.isclose(s.y, s.y.min())
    inner = lowest & (np.abs(s.x - 0.02) > 0.012) & (np.abs(s.x - 0.02) < 0.018)
    fine, coarse = (rise[inner & (s.material == n)].mean() for n in (0, 1))
    h = [law.schluender(d, 0.0242, p.gap) for d in (2e-4, 1e-3)]
    assert fine / coarse == pytest.approx(h[0] / h[1] * 500.0 / 1000.0, rel=1e-6)
    assert got_by(s, before) == pytest.approx(wall_heat.received(gave), rel=1e-9)


def got_by(s, before):
    return math.fsum(s.mass * s.grain_capacity * (s.temperature - before))


def test_areas_and_means_are_told(tmp_path):
    run = go(started(bed(count=2), tmp_path))
    row, summary = run.row(), run.grains.summary()
    assert summary["hot_area_m2"] == pytest.approx(0.04, rel=1e-12)
    assert summary["mean_hot_grain_heat_W"] == pytest.approx(run.ledger.sums["heat_of_walls_J"] / 1.0, rel=1e-12)
    assert row["hot_grain_heat_W"] == pytest.approx(run.ledger.last["heat_of_walls_J"] / 0.5, rel=1e-12)
    assert row["hot_covered"] == pytest.approx(1.0, abs=0.02)
    assert run.ledger.summary()["heat_of_walls_J"] == run.ledger.sums["heat_of_walls_J"]
