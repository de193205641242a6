"""What the embedded gas solver may not lose, and what it says when it cannot go on."""

import dataclasses
import re

import numpy as np
import pytest
from gas_cases import OIL, SIDES, gas_case, gas_of, set_flow

from coupling.embedded import EmbeddedGas
from coupling.embedded.works import through_motion
from coupling.gas import SOURCES, Gas, GasError, Unfinished
from sdph.case.read import CaseError

ALL = tuple(SOURCES)


def open_box(d):
    """Inlets on part of the bottom, an opening on top, a hot wall."""
    span = [[0.1, 0.3]] * (d - 1)
    jet = {"span_m": span if d == 3 else span[0], "velocity_m_s": [0.0, 2.0, 0.0][:d], "temperature_K": 350.0}
    return {
        "jet": {"kind": "velocity_inlet", "side": "bottom"} | jet,
        "hot": {"kind": "wall", "side": "left", "temperature_K": 400.0},
        "out": {"kind": "pressure_outlet", "side": "top", "pressure_Pa": 0.0, "temperature_K": 310.0},
        "walls": {"kind": "wall"},
    }


def particles(gas, t, rng):
    """Sources of a cloud of particles that moves, gives off vapour, and half as much of the rest of the gas."""
    x = gas.mesh.centres
    r = np.linalg.norm(x[:, :2] - [0.2, 0.15 + 0.5 * t], axis=1)
    alpha_p = 0.55 * np.clip((0.12 - r) / 0.04, 0.0, 1.0)
    beta, eps, gamma = 2e4 * alpha_p, 3e5 * alpha_p, 2.0 * alpha_p
    v = np.stack((0.3 + 0 * r, 1.0 + rng.random(len(r)), 0 * r), axis=1)
    return {
        "alpha_g": 1.0 - alpha_p, "vapour": gamma, "carrier": 0.5 * gamma,
        "momentum_coefficient": beta, "momentum": (beta + 1.5 * gamma)[:, None] * v,
        "heat_coefficient": eps, "heat": eps * 320.0 + 1e3 * alpha_p + gamma * (1700.0 + 0.5 * 1000.0) * 320.0,
    }  # fmt: skip


def given(gas, dt, sources, state):
    """Vapour and energy that the particles gave in a window, from the returned temperature."""
    V = gas.mesh.volumes
    heat = sources["heat"] - sources["heat_coefficient"] * state.fields["temperature"]
    return dt * (sources["vapour"] * V).sum(), dt * (heat * V).sum()


@pytest.mark.parametrize("equation_of_state", ["constant", "operating"])
@pytest.mark.parametrize("dimensions", [2, 3])
def test_totals_close_with_boundaries_counted(dimensions, equation_of_state):
    size, n = ((0.4, 0.6), 20) if dimensions == 2 else ((0.4, 0.6, 0.4), 8)
    options = {"boundaries": open_box(dimensions), "vapour": OIL, "equation_of_state": equation_of_state}
    gas = gas_of(size, n, gravity=[0.0, -9.81, 0.0][:dimensions], **options)
    rng = np.random.default_rng(1)
    first = state = gas.start(particles(gas, 0.0, rng)["alpha_g"], ALL)
    vapour = energy = 0.0
    for n in range(1, 41):
        sources = particles(gas, n * 2e-3, rng)
        state = gas.advance(2e-3, sources)
        more = given(gas, 2e-3, sources, state)
        vapour, energy = vapour + more[0], energy + more[1]
    now, then = state.budget, first.budget
    drift = {
        "mass": (now.mass - then.mass - now.mass_in - 1.5 * vapour) / now.mass,
        "vapour": (now.vapour - then.vapour - now.vapour_in - vapour) / vapour,
        "energy": (now.energy - then.energy - now.energy_in - now.pressure_work - energy) / now.energy,
    }
    print(dimensions, equation_of_state, drift, "Courant", now.courant, now.residuals)
    assert max(map(abs, drift.values())) < 1e-12
    fields = state.fields
    volumes = gas.mesh.volumes
    assert np.isclose((fields["density"] * sources["alpha_g"] * volumes).sum(), now.mass, rtol=1e-13)
    assert fields["vapour_mass_fraction"].min() >= 0.0 and fields["vapour_mass_fraction"].max() < 1.0
    assert abs(now.residuals["pressure"]) <= 1e-8


@pytest.mark.parametrize("equation_of_state", ["constant", "operating"])
def test_closed_heated_box(equation_of_state):
    """Two-way heat exchange without flow across the boundary: mass and energy stay."""
    gas = gas_of((0.5, 0.5), 30, equation_of_state=equation_of_state, gravity=[0.0, -9.81])
    r = np.linalg.norm(gas.mesh.centres[:, :2] - 0.25, axis=1)
    alpha, eps = np.where(r < 0.1, 0.4, 1.0), np.where(r < 0.1, 5e4, 0.0)
    first = state = gas.start(alpha, ("alpha_g", "heat_coefficient", "heat"))
    heat = 0.0
    for _ in range(50):
        state = gas.advance(1e-3, {"alpha_g": alpha, "heat_coefficient": eps, "heat": eps * 350.0})
        heat += 1e-3 * ((eps * 350.0 - eps * state.fields["temperature"]) * gas.mesh.volumes).sum()
    mass, energy = (
        state.budget.mass / first.budget.mass - 1.0,
        (state.budget.energy - first.budget.energy - heat) / heat,
    )
    print(
        f"closed heated box, {equation_of_state}: mass drift {mass:.1e}, energy drift over the heat given {energy:.1e}"
    )
    assert abs(mass) < 1e-12
    assert abs(energy) < 1e-12
    assert heat > 0.0
    if equation_of_state == "operating":  # p_op rises in proportion to the mean temperature of the gas
        T = state.fields["temperature"]
        expected = alpha.sum() / 300.0 / (alpha / T).sum()
        assert state.budget.held["gas_box_rel"] + 1.0 == pytest.approx(expected, rel=1e-6)  # two passes a window


def test_drag_acts_alike_on_both_sides():
    """In a closed box without friction and weight, the gas takes up exactly what the returned velocity says."""
    gas = gas_of((0.4, 0.4), 16, boundaries={"walls": {"kind": "slip_wall"}})
    x = gas.mesh.centres
    inside = (np.abs(x[:, :2] - 0.2) < 0.1).all(axis=1)
    alpha = np.where(inside, 0.6, 1.0)
    rng = np.random.default_rng(2)
    beta = np.where(inside, 500.0 * rng.random(len(x)), 0.0)
    push = beta[:, None] * np.array([1.0, -0.5, 0.0]) * rng.random((len(x), 1))
    first = gas.start(alpha, ("momentum_coefficient", "momentum"))
    state = gas.advance(1e-3, {"momentum_coefficient": beta, "momentum": push})
    V = gas.mesh.volumes[:, None]
    impulse = 1e-3 * ((push - beta[:, None] * state.fields["velocity"]) * V).sum(axis=0)
    active, grid, flow = gas.momentum.active, gas.box.grid, gas.flow
    pull = grid.padded(beta) * grid.geometry.volume
    for a in range(2):
        f = np.flatnonzero(active[a])
        on_faces = (0.5 * (pull[f] + pull[f - grid.strides[a]]) * flow.velocity[a, f]).sum()
        assert on_faces == pytest.approx((beta * state.fields["velocity"][:, a] * gas.mesh.volumes).sum(), rel=1e-13)
        room = flow.alpha * grid.geometry.volume
        held = 0.5 * (room[f] + room[f - grid.strides[a]])
        pressed = (
            1e-3 * (held * (flow.pressure[f] - flow.pressure[f - grid.strides[a]]) / grid.geometry.gap[a, f]).sum()
        )
        # the momentum counts the mass that the cells hold, within the tolerance of continuity of what they should
        assert state.budget.momentum[a] == pytest.approx(impulse[a] - pressed, abs=1e-9 * np.abs(impulse).max())
    assert first.budget.momentum == (0.0, 0.0, 0.0)


def test_strong_drag_and_long_windows_stay_bounded():
    """Drag times of 1e-6 s and windows of 1e-3 s: the gas takes the velocity of the particles."""
    boundaries = {side: {"kind": "pressure_outlet", "side": side, "pressure_Pa": 0.0} for side in SIDES[:4]}
    gas = gas_of((0.2, 0.2), 10, boundaries=boundaries)
    beta = np.full(100, 5e5)
    gas.start(None, ("momentum_coefficient", "momentum"))
    state = gas.advance(1e-3, {"momentum_coefficient": beta, "momentum": beta[:, None] * [0.5, 0.2, 0.0]})
    assert np.allclose(state.fields["velocity"], [0.5, 0.2, 0.0], atol=5e-3)


def test_closed_box_squeezed_by_particles():
    """Particles that come in leave the gas less room: its mass stays, its density rises alike everywhere."""
    gas = gas_of((0.2, 0.2), 10)
    rng = np.random.default_rng(3)
    first = gas.start(None, ("alpha_g",))
    alpha = 1.0 - 0.3 * rng.random(100)
    state = gas.advance(1e-3, {"alpha_g": alpha})
    assert state.budget.mass == pytest.approx(first.budget.mass, rel=1e-14)
    assert np.allclose(state.fields["density"], 1.2 / alpha.mean(), rtol=3e-8)
    assert state.budget.held["gas_box_rel"] == pytest.approx(1.0 / alpha.mean() - 1.0, rel=1e-9)


def test_gas_at_rest_stays_at_rest():
    """Weight, uneven voidage and openings at several heights: the pressure carries the gas, and nothing moves."""
    boundaries = {side: {"kind": "pressure_outlet", "side": side, "pressure_Pa": 0.0} for side in ("right", "top")}
    boundaries["walls"] = {"kind": "wall"}
    gas = gas_of((0.4, 0.6), 12, gravity=[0.0, -9.81], boundaries=boundaries, stretch=(4.0, 0.3))
    rng = np.random.default_rng(4)
    gas.start(0.4 + 0.6 * rng.random(len(gas.mesh.volumes)), ())
    for _ in range(20):
        state = gas.advance(1e-2, {})
    assert np.abs(state.fields["velocity"]).max() < 1e-6
    level = (0.6 * 0.3 + 0.4 * 0.6) / (0.6 + 0.4)  # centre of the openings
    assert np.allclose(state.fields["pressure"], 1.2 * 9.81 * (level - gas.mesh.centres[:, 1]), atol=1e-5)
    weight = (state.fields["density"] * gas.flow.alpha[gas.box.grid.cells] * gas.mesh.volumes).sum() * 9.81
    held = state.budget.impulse_pressure[1] + state.budget.impulse_room[1]
    assert -state.budget.impulse_gravity[1] == pytest.approx(20 * 1e-2 * weight, rel=1e-9)
    assert held == pytest.approx(20 * 1e-2 * weight, rel=1e-6)
    assert state.budget.impulse_pressure[1] == pytest.approx(20 * 1e-2 * 1.2 * 9.81 * 0.4 * 0.6, rel=1e-6)


def test_three_dimensions_repeat_two():
    """A flow that does not vary along z, between slip walls: the same as in the plane."""
    flat = open_box(2)
    jet = flat["jet"] | {"span_m": [[0.1, 0.3], [0.0, 0.2]], "velocity_m_s": [0.0, 2.0, 0.0]}
    deep = flat | {
        "jet": jet,
        "back": {"kind": "slip_wall", "side": "back"},
        "front": {"kind": "slip_wall", "side": "front"},
    }
    plane, solid = gas_of((0.4, 0.6), 8, boundaries=flat), gas_of((0.4, 0.6, 0.2), 8, boundaries=deep)
    plane.start(None, ())
    solid.start(None, ())
    for _ in range(20):
        two, three = plane.advance(5e-3, {}), solid.advance(5e-3, {})
    layer = np.isclose(solid.mesh.centres[:, 2], 0.125)
    assert solid.mesh.dimensions == 3 and layer.sum() == len(plane.mesh.volumes)
    assert np.allclose(three.fields["velocity"][layer], two.fields["velocity"], atol=1e-6)
    assert np.allclose(three.fields["temperature"][layer], two.fields["temperature"], atol=1e-6)
    assert three.budget.energy_in == pytest.approx(0.2 * two.budget.energy_in, rel=1e-6)
    assert three.budget.momentum[1] == pytest.approx(0.2 * two.budget.momentum[1], rel=1e-6)


def test_checkpoint_goes_on_bit_for_bit(tmp_path):
    case = gas_case(
        (0.4, 0.6), 20, gravity=[0.0, -9.81], boundaries=open_box(2), vapour=OIL, equation_of_state="operating"
    )
    gas, other = EmbeddedGas(case), EmbeddedGas(case)
    rng = np.random.default_rng(5)
    windows = [particles(gas, n * 1e-3, rng) for n in range(8)]
    gas.start(windows[0]["alpha_g"], ALL)
    for sources in windows[1:4]:
        gas.advance(1e-3, sources)
    gas.checkpoint(tmp_path / "gas")
    restored = other.restore(tmp_path / "gas")
    assert restored.time == gas.flow.time
    for sources in windows[4:]:
        a, b = gas.advance(1e-3, sources), other.advance(1e-3, sources)
    assert dataclasses.asdict(a.budget) == dataclasses.asdict(b.budget)
    for name in a.fields:
        assert np.array_equal(a.fields[name], b.fields[name])
    assert [p.name for p in (tmp_path / "gas").iterdir()] == ["embedded_gas.npz"]


def test_is_a_gas():
    gas: Gas = gas_of((0.4, 0.6), 20, boundaries=open_box(2))
    state = gas.start(None, ())
    assert gas.mesh.centres.shape == (600, 3) and gas.mesh.volumes.sum() == pytest.approx(0.24)
    assert np.allclose(gas.mesh.centres[1] - gas.mesh.centres[0], [0.02, 0.0, 0.0])
    assert set(state.fields) == {"velocity", "pressure", "pressure_gradient", "temperature", "density", "power"}
    assert all(len(values) == 600 for values in state.fields.values())


def with_boundary(**boundary):
    return {"odd": boundary, "walls": {"kind": "wall"}}


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"equation_of_state": "ideal"}, "--gas openfoam"),
        ({"boundaries": with_boundary(kind="velocity_inlet", side="left")}, "boundaries.odd.velocity_m_s is missing"),
        ({"boundaries": with_boundary(kind="wall", side="front")}, "has left, right, bottom, top"),
        ({"boundaries": with_boundary(kind="wall", side="left", span_m=[0.0, 0.13])}, "the nearest is 0.12"),
        ({"boundaries": {"odd": {"kind": "wall", "side": "left"}}}, "no boundary covers all of the right side"),
        ({"boundaries": with_boundary(kind="wall", side="top", vapour_mass_fraction=0.5)}, "the case has no [vapour]"),
        ({"stretch": (2.0,)}, "resolution.stretch has 1 components; dimensions = 2 asks for 2"),
        ({"stretch": (2.0, 0.0)}, "resolution.stretch = [2.0, 0.0]; every ratio must be from 0.01 to 100"),
        (
            {"stretch": (1.0, 3.0), "boundaries": with_boundary(kind="wall", side="left", span_m=[0.0, 0.12])},
            "is no edge of a gas cell",
        ),
    ],
)
def test_a_case_it_cannot_run(arguments, says):
    with pytest.raises(CaseError) as error:
        gas_of((0.4, 0.6), 20, **arguments)
    assert says in str(error.value) and "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("sources", "says"),
    [
        ({"heat_coefficient": np.full(600, 1.0)}, "announced at the start were alpha_g, heat"),
        ({"heat_coefficient": np.full(600, np.nan), "alpha_g": np.ones(600)}, "not finite in cell 0"),
        ({"heat_coefficient": np.ones(5), "alpha_g": np.ones(600)}, "it must be (600,)"),
        ({"heat_coefficient": np.ones(600), "alpha_g": np.zeros(600)}, "over-packed"),
    ],
)
def test_sources_it_cannot_take(sources, says):
    gas = gas_of((0.4, 0.6), 20, boundaries=open_box(2))
    gas.start(None, ("alpha_g", "heat_coefficient"))
    with pytest.raises(GasError, match=re.escape(says)):
        gas.advance(1e-3, sources)


def test_a_window_that_is_refused_leaves_the_gas_where_it_was():
    gas = gas_of((0.4, 0.4), 8, boundaries=open_box(2))
    gas.start(np.full(64, 1.0), ("alpha_g",))
    gas.advance(1e-3, {"alpha_g": np.full(64, 1.0)})
    now = gas.advance(1e-3, {"alpha_g": np.full(64, 1.0)})
    with pytest.raises(Unfinished, match="over-packed"):
        gas.advance(1e-3, {"alpha_g": np.full(64, -0.1)})
    assert gas.retreat() is now


def test_motion_along_a_boundary_comes_in_and_leaves_with_the_gas():
    """Of an inlet that blows at an angle, and of gas that turns on its way out: m' u^2/2 with both of its parts."""
    boundaries = {
        "feed": {"kind": "velocity_inlet", "side": "bottom", "velocity_m_s": [1.0, 5.0]},
        "out": {"kind": "pressure_outlet", "side": "top"},
        "sides": {"kind": "slip_wall"},
    }
    gas = gas_of((0.4, 0.4), 4, boundaries=boundaries)
    gas.start(None, (), ())
    set_flow(gas, velocity=lambda a, x, y: 5.0 + 0.0 * x if a else 30.0 * x)
    came, _ = through_motion(gas.box, gas.flow, gas.flow, 0.01)
    faces, outward = gas.box.faces, gas.box.outward(gas.flow.flux)
    top = (faces.axis == 1) & (faces.sign > 0.0)
    middle = faces.middle[top, 0]
    ends = [np.where(edge < 0.39, 30.0 * edge, 0.0) for edge in (middle - 0.05, middle + 0.05)]
    leaves = outward[top] @ (0.5 * 25.0 + 0.25 * (ends[0] ** 2 + ends[1] ** 2))
    enters = -outward[outward < 0.0].sum() * 0.5 * 26.0
    assert came == pytest.approx(0.01 * (enters - leaves), rel=1e-12)
    gas.close()
