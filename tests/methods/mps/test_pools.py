"""Pools of moving particles: walls, pressure by differences, cases that were written for the other method."""

import numpy as np
import pytest
from moving import case, joined, started

from sdph import scenes
from sdph.case import read as cases
from sdph.engine import state as particles
from sdph.engine.state import LIQUID, WALL
from sdph.methods.mps import pools
from sdph.methods.mps.method import MpsStepper
from sdph.methods.mps.totals import MpsLedger
from sdph.running import driver
from sdph.running.progress import Reporter
from sdph.schema import CaseError
from sdph.study import compare

UNIT, G, RHO = 0.05, 10.0, 1000.0
TANK = {
    "effects": ["gravity", "tank"], "dimensions": 2, "resolution": {"spacing_mm": 1e3 * UNIT},
    "domain": {"size_m": [0.6, 1.2], "gravity_m_s2": [0.0, -G]}, "liquid": {"density_kg_m3": RHO},
    "tank": {"open_sides": ["top"]},
    "pools": {"drop": {"shape": "box", "centre_m": None, "radius_m": None, "lower_m": [0.0, 0.0],
                       "upper_m": [0.6, 0.8]}},
}  # fmt: skip


def tank(sections=None):
    """A stepper of water in a tank, 12 spacings wide and 16 deep, or what `sections` make of it."""
    return MpsStepper(case(tuple(TANK["effects"]), joined(TANK, sections or {}), 2))


def test_water_at_rest_has_the_pressure_of_its_depth_and_nothing_moves_inside():
    """From the second row below the ones that see the surface to the floor and into its corners."""
    stepper = tank({"method": {"tolerance": 1e-10}})
    dt = stepper.step(1e-3)
    s = stepper.state
    deep = (s.kind == LIQUID) & (s.y < 0.5)
    expected = RHO * G * s.y[deep]
    fitted = np.polyfit(s.y[deep], stepper.state.pressure[deep], 1)
    np.testing.assert_allclose(fitted[0], -RHO * G, rtol=0.02)
    assert np.ptp(stepper.state.pressure[deep] + expected) < 0.01 * RHO * G * 0.8
    assert np.abs(particles.velocities(s)[deep]).max() < 0.01 * G * dt
    weight = RHO * G * 0.6 * 0.8
    assert stepper.load[1] == pytest.approx(-weight, rel=0.05) and abs(stepper.load[0]) < 1e-6 * weight


def test_pools_that_overlap_share_no_place():
    """The first has it, as of the other method; what would stand in a wall is refused."""
    other = {"shape": "box", "lower_m": [0.3, 0.0], "upper_m": [0.6, 1.0]}
    water = tank({"pools": {"drop": {"upper_m": [0.4, 0.8]}, "other": other}})
    places = particles.positions(water.state)[water.state.kind == LIQUID]
    assert len(np.unique(np.round(places / UNIT, 3), axis=0)) == len(places) == 8 * 16 + 6 * 20 - 2 * 16
    with pytest.raises(CaseError, match=r"pools.other: 16 of its 80 particles would stand outside the tank"):
        outside = other | {"lower_m": [0.4, 0.0], "upper_m": [0.65, 0.8]}
        tank({"pools": {"drop": {"upper_m": [0.4, 0.8]}, "other": outside}})
    with pytest.raises(CaseError, match=r"pools.other holds no particle"):
        tank({"pools": {"other": other | {"upper_m": [0.6, 0.8]}}})


@pytest.mark.parametrize("shaken", [False, True])
def test_the_gradient_is_exact_for_linear_pressure_beside_walls(shaken):
    """With u* = dt g + dt a, what walls put against u* is the gradient itself: nothing is left of it."""
    stepper = tank()
    s, inside = stepper.state, stepper.state.kind == LIQUID
    if shaken:
        s.x[inside] += 0.1 * UNIT * np.sin(40.0 * s.y[inside])
        s.y[inside] += 0.1 * UNIT * np.cos(50.0 * s.x[inside])
    gradient = np.array([300.0, -700.0])
    s.u[inside], s.v[inside] = gradient / RHO
    pressure = s.x * gradient[0] + s.y * gradient[1]
    beside = ((s.y > 0.6) & inside).astype(np.int8)
    found, borne = np.empty((len(s.x), 3)), np.empty((len(s.x), 3))
    stepper.walls = stepper.walls._replace(least=-np.inf)
    pools.press(*stepper.around, pressure, beside, RHO, found, borne)
    np.testing.assert_allclose(
        found[inside & (beside == 0)], [[-0.3, 0.7, 0.0]] * (inside & (beside == 0)).sum(), rtol=1e-8
    )


def test_the_divergence_is_exact_for_linear_fields_beside_walls():
    stepper = tank()
    s, inside = stepper.state, stepper.state.kind == LIQUID
    s.u[inside], s.v[inside] = 3.0 * s.x[inside] + s.y[inside], 2.0 * s.x[inside] - 1.0 * s.y[inside]
    beside, found = ((s.y > 0.6) & inside).astype(np.int8), np.empty(len(s.x))
    pools.diverge(*stepper.around, beside, found)
    np.testing.assert_allclose(found[inside & (s.y < 0.6)], 2.0, rtol=1e-8)


def test_liquid_thrown_at_a_wall_does_not_pass_and_the_wall_does_not_hold_it_back():
    stepper = tank({"pools": {"drop": {"lower_m": [0.1, 0.3], "upper_m": [0.3, 0.5], "velocity_m_s": [-3.0, 0.0]}}})
    for _ in range(150):
        stepper.step(2e-3)
    s = stepper.state
    wet = s.kind == LIQUID
    assert wet.sum() == 16 and s.x[wet].min() > -0.3 * UNIT and s.y[wet].min() > -0.3 * UNIT
    assert stepper.works[3] + stepper.works[4] < 0.0  # pressure and collisions stop it


def test_walls_stay_and_shifting_moves_no_particle_of_the_surface():
    stepper = tank()
    before = {i: x for i, x, k in zip(stepper.state.ident, stepper.state.x, stepper.state.kind) if k == WALL}
    for _ in range(20):
        stepper.step(5e-3)
    s = stepper.state
    assert all(before[i] == x for i, x, k in zip(s.ident, s.x, s.kind) if k == WALL)
    way = np.empty((len(s.x), 3))
    pools.keep_apart(*stepper.around, np.ones(len(s.x), np.int8), 1.0, way)
    assert not way.any()


def test_a_patch_that_turns_has_the_pressure_of_colicchio_and_keeps_its_momentum():
    own = cases.load(scenes.HERE / "square_patch" / "case.toml", ("method.name=mps", "resolution.spacing_mm=40.0"))
    stepper = MpsStepper(own)
    pressures = []
    for _ in range(10):
        stepper.step(0.01)
        s = stepper.state
        pressures.append(stepper.state.pressure[np.hypot(s.x - 0.5, s.y - 0.5) < 0.08].mean())
    assert np.mean(pressures[1:]) == pytest.approx(-147.34, rel=0.1)
    scale = float(s.mass.sum()) * 0.5
    assert np.abs(s.mass @ particles.velocities(s)).max() < 1e-10 * scale


SOUND = "liquid.sound_speed_m_s"


@pytest.mark.parametrize(("scene", "left"), [
    ("hydrostatic_tank", ("density_diffusion", "liquid_damping", SOUND)),
    ("dam_break", ("density_diffusion", "liquid_damping", SOUND)),
    ("square_patch", ("density_diffusion", "shifting", SOUND)),
    ("oscillating_droplet", ("density_diffusion", "liquid_damping", "shifting", "surface_tension", "pools.air",
                             "gas_phase", SOUND, "liquid.exponent", "liquid.periodic")),
])  # fmt: skip
def test_a_scene_of_the_other_method_is_taken_over_and_tells_what_is_left_out(scene, left):
    own = cases.load(scenes.HERE / scene / "case.toml", ("method.name=mps",))
    assert own.method.left_out == left and not set(left) & set(own.effects)
    assert own == cases.from_table(cases.to_table(own))
    if scene == "oscillating_droplet":
        assert own.parameters["free_energy_tension"].coefficient == 0.072 and list(own.pools) == ["drop"]
        assert own.method.reach == 3.1 and not own.liquid.periodic


def test_a_dam_break_closes_its_ledger_and_goes_on_to_the_last_bit(tmp_path, capsys):
    small = ("method.name=mps", "resolution.spacing_mm=5.715", "run.end_time_s=0.1", "run.checkpoint_windows=4")
    folder = tmp_path / "run"
    driver.run(cases.load(scenes.HERE / "dam_break" / "case.toml", small), "dam_break", folder, None, Reporter())
    own = compare.open_run(folder)
    for name in ("mass_drift_rel", "momentum_drift_rel", "energy_drift_rel"):
        assert own.summary[name] < 1e-12
    assert "left out, as moving particles do without it or cannot have it: density_diffusion" in capsys.readouterr().err
    driver.resume(folder, ("run.end_time_s=0.12",), Reporter())
    straight = tmp_path / "straight"
    longer = (*small[:2], "run.end_time_s=0.12", small[3])
    driver.run(cases.load(scenes.HERE / "dam_break" / "case.toml", longer), "dam_break", straight, None, Reporter())
    a, b = (compare.open_run(f).fields(0.12)[1] for f in (folder, straight))
    np.testing.assert_array_equal(a.points, b.points)
    np.testing.assert_array_equal(a["velocity"], b["velocity"])


@pytest.mark.parametrize(("sections", "told"), [
    ({"pools": {"drop": {"upper_m": [0.6, 1.2]}}, "tank": {"open_sides": []}}, "a closed vessel"),
    ({"tank": {"outlet_radius_m": 0.1, "shape": "sphere", "centre_m": [0.3, 0.6], "radius_m": 0.3}}, "outlet"),
    ({"pools": {"drop": {"flow": "wave"}}}, "with a flow of uniform, rotation"),
    ({"effects": ["gravity", "tank", "outflow"]}, "not both"),
    ({"effects": ["gravity", "tank", "free_energy_tension"], "free_energy_tension": {"coefficient_N_m": 0.07}},
     "free_energy_tension lets the pressure act by forces of pairs"),
    ({"method": {"gradient": "pairs"}}, 'method.gradient = "pairs" lets the pressure act by forces of pairs'),
])  # fmt: skip
def test_what_a_pool_cannot_be_is_told_in_one_line(sections, told):
    with pytest.raises(CaseError, match=told):
        MpsStepper(case(tuple(sections.get("effects", TANK["effects"])), joined(TANK, sections), 2))


@pytest.mark.parametrize("gradient", ["pairs", "corrected"])
def test_momentum_that_a_pool_alone_makes_is_told(tmp_path, gradient):
    """Forces of pairs have no sum, corrected differences have one: the change of what nothing outside acts on."""
    block = {"shape": "box", "centre_m": None, "radius_m": None, "lower_m": [2e-3, 2e-3], "upper_m": [4e-3, 3e-3]}
    run = started(tmp_path, case((), {"method": {"gradient": gradient}, "pools": {"drop": block}}, 2))
    s = run.state
    s.u[:], s.v[:] = 40.0 * (s.y - 2e-3) + 3e5 * (s.x - 2e-3) ** 2, -60.0 * (s.x - 2e-3)
    before = s.mass @ particles.velocities(s)
    ledger = MpsLedger(None, True)
    ledger.open(run.stepper)
    for _ in range(20):
        run.stepper.step(1e-5)
    ledger.close_window(run.stepper, run.stepper.time)
    s = run.state
    change, scale = np.linalg.norm(s.mass @ particles.velocities(s) - before), np.linalg.norm(before)
    told = ledger.summary()["momentum_made_rel"]
    assert (told > 1e-6 and change > 1e-6 * scale) if gradient == "corrected" else told < 1e-13
    assert np.linalg.norm(ledger.impulses[1]) == pytest.approx(change, rel=1e-6, abs=1e-12 * scale)


@pytest.mark.parametrize(("effects", "alone"), [((), True), (("gravity",), True), (("gravity", "tank"), False)])
def test_only_of_liquid_that_nothing_holds_it_is_told(tmp_path, effects, alone):
    sections = joined(TANK, {"effects": list(effects)} | ({"tank": None} if alone else {}))
    run = started(tmp_path, case(effects, sections, 2))
    run.window()
    assert ("momentum_made_rel" in run.method.ledger.summary()) == alone


def test_periodic_liquid_sees_itself_across():
    """A slab along x falls as one, without an end."""
    own = {
        "liquid": {"periodic": [1.0, 0.0]},
        "effects": [],
        "domain": {"size_m": [2e-3, 8e-3]},
        "pools": {
            "drop": {
                "shape": "box",
                "centre_m": None,
                "radius_m": None,
                "lower_m": [0.0, 3e-3],
                "upper_m": [2e-3, 5e-3],
            }
        },
    }
    stepper = MpsStepper(case((), own, 2))
    middle = np.abs(stepper.state.y - 4e-3) < 7e-4
    np.testing.assert_allclose(stepper.number[middle], stepper.cloud.number, rtol=1e-12)
