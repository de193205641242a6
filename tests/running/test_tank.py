"""The tank that a spacecraft's loop calls: free fall, loads from both sides, commanded outflow, a closed loop."""

import importlib.util
import sys
from pathlib import Path

import numpy as np
import pytest

from sdph import scenes
from sdph.case import read as cases
from sdph.effects.around import tank as tank_effect
from sdph.engine import state as particles
from sdph.engine.state import LIQUID
from sdph.methods.liquids import start
from sdph.running.tank import DrivenTank
from sdph.schema import CaseError

GRAVITY = np.array([0.0, 0.0, -9.8])
TABLE = {
    "dimensions": 3,
    "effects": ["density_diffusion", "liquid_damping", "frame", "tank"],
    "run": {"end_time_s": 1.0, "output_interval_s": 1.0},
    "domain": {"size_m": [1.0, 1.0, 1.0], "gravity_m_s2": [0.0, 0.0, 0.0]},
    "resolution": {"spacing_mm": 100.0, "smoothing_ratio": 1.3},
    "liquid": {"density_kg_m3": 1000.0, "sound_speed_m_s": 15.0},
    "tank": {
        "shape": "sphere",
        "centre_m": [0.0, 0.0, 0.0],
        "radius_m": 0.5,
        "outlet_radius_m": 0.15,
        "outlet_length_m": 0.2,
    },
    "pools": {"water": {"shape": "tank", "fill": 0.5}},
}


def tank(form="debt"):
    effects = [*TABLE["effects"], "drain"]
    return DrivenTank(
        cases.from_table(TABLE | {"effects": effects, "drain": {"fill": 0.0, "end_s": 1.0, "form": form}})
    )


def test_a_tank_in_free_fall_feels_nothing():
    own = tank()
    for _ in range(3):
        force, moment = own.advance(0.01, np.zeros(3))
    assert np.abs(force).max() < 1e-10 and np.abs(moment).max() < 1e-10


def test_momentum_theorem_and_walls_agree():
    own = tank()
    for _ in range(20):
        force, moment = own.advance(0.01, np.array([1.0, 0.5, 9.8]), np.array([0.1, 0.0, 0.2]), np.zeros(3))
    scale = own.mass * 9.8
    assert np.allclose(force, own.wall_load[:3], atol=3e-3 * scale)
    assert np.allclose(moment, own.wall_load[3:], atol=3e-3 * scale)


@pytest.mark.parametrize("form", ["debt", "paper"])
def test_what_leaves_is_what_is_commanded(form):
    own = tank(form)
    start, particle = own.mass, own.outlet.particle
    for n in range(1, 31):
        fill = 0.5 - 0.001 * n
        own.advance(0.01, -GRAVITY, fill=fill)
        lost, commanded = start - own.mass, (0.5 - fill) * own.stepper.capacity
        assert abs(lost - commanded) <= (0.5 * particle if form == "paper" else 1e-9 * particle) * (1.0 + 1e-9)
    assert np.isfinite(own.stepper.state.density).all()


@pytest.mark.parametrize("form", ["debt", "paper"])
def test_a_command_of_many_takes_the_lowest_with_forces_made_anew_once(form):
    own, made = tank(form), []
    stepper, particle = own.stepper, own.outlet.particle
    own.advance(0.01, -GRAVITY, fill=0.5)
    forces, s = stepper.forces, stepper.state
    stepper.forces = lambda: made.append(1) or forces()
    order = np.argsort(s.z[stepper.active], kind="stable")
    lowest = s.ident[stepper.active][order]
    own.outlet.command(0.5 - 7.4 * particle / stepper.capacity)
    liquid = stepper.state.ident[stepper.state.kind == LIQUID]
    assert not np.isin(lowest[:7], liquid).any() and np.isin(lowest[7:], liquid).all() and len(made) == 1
    assert own.outlet.gone[0] == pytest.approx((7.0 if form == "paper" else 7.4) * particle, rel=1e-12)


def test_a_tank_drains_to_the_last_particle():
    """It held 26 particles for a fill of 26.2: the command ends where the liquid does."""
    shape = {"shape": "sphere", "centre_m": [0.0, 0.0, 0.0], "radius_m": 0.5}
    drained = {"effects": [*TABLE["effects"], "drain"], "drain": {"fill": 0.0, "end_s": 1.0}}
    own = DrivenTank(
        cases.from_table(TABLE | drained | {"tank": shape, "pools": {"water": {"shape": "tank", "fill": 0.05}}})
    )
    start = own.mass
    own.advance(0.005, -GRAVITY, fill=0.0)
    assert own.mass == 0.0 and own.outlet.gone[0] == pytest.approx(start)
    assert 0.0 < 0.05 * own.stepper.capacity - start < 0.5 * own.outlet.particle


def test_a_particle_that_leaves_fades():
    """As a piece of wall, over the interval, by xi (paper T, Eq. 14); what has been chosen counts as drained."""
    own = tank("paper")
    start, count, stepper = own.mass, len(own.stepper.state.x), own.stepper
    own.outlet.interval = 10.0
    for _ in range(2):
        own.advance(0.01, -GRAVITY, fill=0.5 - 0.6 * own.outlet.particle / stepper.capacity)
    assert start - own.mass == pytest.approx(own.outlet.particle)
    (number, way, begun, mass), walls = own.outlet.leaving[0], stepper.own_walls
    assert len(own.outlet.leaving) == 1 and 0 <= number < walls.start and 0.0 < way < 0.2
    own.outlet.interval = 2.0 * (stepper.time - begun)
    own.outlet._fade()  # halfway
    i = np.flatnonzero(stepper.state.ident == number)[0]
    assert -stepper.volume[i] * stepper.state.density[i] == pytest.approx(mass * (np.exp(0.5) - 1.0) / (np.e - 1.0))
    assert stepper.state.z[i] - own.outlet.end == pytest.approx(0.5 * way)
    own.outlet.interval = stepper.time - begun
    own.outlet._fade()
    assert len(own.outlet.leaving) == 0 and len(stepper.state.x) == count - 1


def test_a_closed_loop_keeps_momentum(monkeypatch):
    file = Path(__file__).parents[2] / "examples" / "rigid_craft.py"
    spec = importlib.util.spec_from_file_location("rigid_craft", file)
    module = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, "rigid_craft", module)
    spec.loader.exec_module(module)
    table = module.CASE | {"resolution": {"spacing_mm": 120.0}}
    craft = module.Craft(mass=400.0, inertia=np.diag([90.0, 120.0, 100.0]), omega=np.array([0.1, 0.3, 1.0]))
    totals = np.array([total for _, _, total in module.coupled(craft, DrivenTank(cases.from_table(table)), 0.01, 30)])
    assert np.ptp(totals, axis=0).max() < 1e-9 * np.abs(totals[0]).max()
    assert np.linalg.norm(craft.omega - [0.1, 0.3, 1.0]) > 1e-4  # the liquid has turned the craft


@pytest.mark.parametrize(
    "shape",
    [
        {"shape": "sphere", "centre_m": [0.0, 0.0, 0.0], "radius_m": 0.5},
        {"shape": "capsule", "centre_m": [0.0, 0.0, 0.0], "radius_m": 0.4, "length_m": 0.3},
        {"shape": "cylinder", "centre_m": [0.0, 0.0, 0.0], "radius_m": 0.4, "length_m": 0.6},
        {"shape": "box", "lower_m": [-0.4, -0.3, -0.5], "upper_m": [0.4, 0.3, 0.5]},
    ],
)
def test_walls_fill_what_lies_behind_the_surface(shape):
    """Wall and liquid particles around the surface fill the kernel: the sum of V W is 1 within a few per cent."""
    spacing, h = 0.05, 0.065
    case = cases.from_table(
        TABLE
        | {
            "resolution": {"spacing_mm": 50.0, "smoothing_ratio": 1.3},
            "tank": shape,
            "pools": {"all": {"shape": "tank", "fill": 1.0}},
        }
    )
    state = start.fill(case)
    everything = particles.positions(state)
    inside, walls = everything[state.kind == LIQUID], everything[state.kind == particles.WALL]
    assert (tank_effect.shape_of(case).distance(walls) > 0.49 * spacing).all()
    assert len(inside) * spacing**3 == pytest.approx(tank_effect.shape_of(case).volume, abs=0.5 * spacing**3)
    sums = []
    for point in inside[:: max(1, len(inside) // 60)]:
        r = np.linalg.norm(everything - point, axis=1) / h
        kernel = np.where(r < 1, 1 - 1.5 * r**2 + 0.75 * r**3, np.where(r < 2, 0.25 * (2 - r) ** 3, 0.0)) / (
            np.pi * h**3
        )
        sums.append(kernel.sum() * spacing**3)
    assert np.mean(sums) == pytest.approx(1.0, abs=0.08) and min(sums) > 0.6


def test_gravity_of_a_case_weighs_what_is_in_the_tank():
    """Mass times g, and its moment about the tank's origin."""
    domain = TABLE["domain"] | {"gravity_m_s2": [1.0, 0.5, -9.8]}
    own = DrivenTank(cases.from_table(TABLE | {"domain": domain, "effects": [*TABLE["effects"], "gravity"]}))
    wet = own.stepper.state.kind == LIQUID
    mass, place = own.stepper.state.mass[wet], particles.positions(own.stepper.state)[wet]
    gravity = np.array([1.0, 0.5, -9.8])
    np.testing.assert_allclose(own._weight()[:3], mass.sum() * gravity, rtol=1e-12)
    np.testing.assert_allclose(own._weight()[3:], np.cross(place, mass[:, None] * gravity).sum(axis=0), rtol=1e-12)


@pytest.mark.parametrize(("scene", "more", "told"), [
    ("dam_break", ("method.name=mps",), "moved by weakly compressible SPH"),
    ("free_overfall", (), "closed but for its drain"),
])  # fmt: skip
def test_a_tank_that_it_could_not_balance_is_refused(scene, more, told):
    with pytest.raises(CaseError, match=told):
        DrivenTank(cases.load(scenes.HERE / scene / "case.toml", more))
