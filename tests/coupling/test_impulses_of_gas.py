"""What moves the gas, each impulse against a hand calculation; and what its momentum grows by besides. Both solvers."""

import contextlib
import itertools
import math

import numpy as np
import pytest
from gas_boxes import AIR, box, box_case

from coupling.embedded import EmbeddedGas
from coupling.gas import IMPULSES

RHO, CP = AIR["density_kg_m3"], AIR["heat_capacity_J_kg_K"]
BOTH = pytest.mark.parametrize("solver", ["embedded", pytest.param("openfoam", marks=pytest.mark.openfoam)])
ENDS = {side: {"kind": "pressure_outlet", "side": side, "pressure_Pa": 0.0} for side in ("left", "right")}


@contextlib.contextmanager
def running(solver, folder, *args, **kwargs):
    if solver == "embedded":
        yield EmbeddedGas(box_case(*args, **kwargs))
    else:
        with box(folder, *args, **kwargs) as gas:
            yield gas


def grown(gas, before, after):
    """Momentum and impulses (3,) [kg m/s] between two states, per metre of depth, and `numerical`, the rest."""
    names = ("momentum", *IMPULSES)
    found = {name: np.subtract(getattr(after.budget, name), getattr(before.budget, name)) for name in names}
    found["numerical"] = found["momentum"] - sum(found[name] for name in IMPULSES)
    return {name: values / gas.mesh.depth for name, values in found.items()}


@BOTH
def test_wall_that_slides(tmp_path, solver):
    """Stokes' first problem: a wall that slides at once gives 2 rho U sqrt(nu t/pi) per area in the time t."""
    speed, length, height, mu, t, steps = 0.7, 0.04, 0.02, 1.2e-3, 8e-3, 200
    lid = {"kind": "wall", "side": "top", "velocity_m_s": [speed, 0.0]}
    boundaries = ENDS | {"lid": lid, "floor": {"kind": "wall", "side": "bottom"}}
    with running(solver, tmp_path, (length, height), 5e-4, boundaries=boundaries, viscosity_Pa_s=mu) as gas:
        first = gas.start(None, ())
        for _ in range(steps):
            state = gas.advance(t / steps, {})
    found = grown(gas, first, state)
    hand = 2.0 * RHO * speed * math.sqrt(mu / RHO * t / math.pi) * length
    print(f"{solver}: walls {found['impulse_walls'][0]:.5e}, by hand {hand:.5e}, numerical {found['numerical'][0]:.1e}")
    assert found["impulse_walls"][0] == pytest.approx(hand, rel=0.01)
    assert state.budget.patches["lid"][1][0] / gas.mesh.depth == pytest.approx(hand, rel=0.01)
    assert found["momentum"][0] == pytest.approx(hand, rel=0.01)
    others = set(found) - {"impulse_walls", "momentum"}
    assert max(abs(found[name][0]) for name in others) < 1e-3 * hand


@BOTH
def test_gas_that_heat_speeds_up(tmp_path, solver):
    """Gas warmed on its way through a channel leaves faster: G (u_in - u_out) is what convection brings on balance, and
    the pressure in front pushes by as much."""
    speed, warmer, size, dt, steps, last = 2.0, 150.0, (0.2, 0.02), 2e-3, 150, 50
    boundaries = {
        "in": {"kind": "velocity_inlet", "side": "left", "velocity_m_s": [speed, 0.0], "temperature_K": 300.0},
        "out": {"kind": "pressure_outlet", "side": "right", "pressure_Pa": 50.0}, "walls": {"kind": "slip_wall"},
    }  # fmt: skip
    options = {"boundaries": boundaries, "equation_of_state": "operating", "molar_mass_kg_kmol": 29.5}
    with running(solver, tmp_path, size, 0.005, **options) as gas:
        x = gas.mesh.centres[:, 0]
        gas.start(None, ("heat",))
        density = 101325.0 * 29.5 / (8314.462618 * 300.0)
        warm = (x > 0.05) & (x < 0.15)
        heat = np.where(warm, density * speed * CP * warmer / 0.1, 0.0)
        states = [gas.advance(dt, {"heat": heat}) for _ in range(steps)]
    found = grown(gas, states[-last - 1], states[-1])
    hand = density * speed * (speed - speed * (300.0 + warmer) / 300.0) * size[1] * last * dt
    parts = ", ".join(f"{name} {values[0]:.5e}" for name, values in found.items())
    print(f"{solver}: by hand {hand:.5e}, {parts}")
    assert found["momentum_in"][0] == pytest.approx(hand, rel=0.01)
    assert found["impulse_pressure"][0] == pytest.approx(-hand, rel=0.01)
    assert max(abs(found["numerical"])) < 0.01 * abs(hand)


@BOTH
def test_bed_that_holds_the_gas_back(tmp_path, solver):
    """A bed that is held, dense in the middle of the channel: -alpha dp/dx = beta u, with u = u_in/alpha between the
    grains, integrated over the channel."""
    speed, beta, (length, height), dt, steps, last = 0.2, 3000.0, (0.2, 0.02), 2e-3, 60, 20
    boundaries = {
        "in": {"kind": "velocity_inlet", "side": "left", "velocity_m_s": [speed, 0.0]},
        "out": {"kind": "pressure_outlet", "side": "right", "pressure_Pa": 0.0}, "walls": {"kind": "slip_wall"},
    }  # fmt: skip
    bed = lambda x: np.exp(-(((x - 0.5 * length) / (length / 8.0)) ** 2))  # noqa: E731
    with running(solver, tmp_path, (length, height), 0.0025, boundaries=boundaries) as gas:
        grains = bed(gas.mesh.centres[:, 0])
        gas.start(1.0 - 0.6 * grains, ("momentum_coefficient", "momentum"))
        drag = {"momentum_coefficient": beta * grains, "momentum": np.zeros((len(grains), 3))}
        states = [gas.advance(dt, drag) for _ in range(steps)]
    found = grown(gas, states[-last - 1], states[-1])
    x = (np.arange(10000) + 0.5) * length / 10000
    alpha_g, slope = 1.0 - 0.6 * bed(x), -beta * bed(x) * speed / (1.0 - 0.6 * bed(x)) ** 2
    whole = length * height * last * dt
    hand = {
        "impulse_exchange": whole * (alpha_g * slope).mean(), "impulse_pressure": -whole * slope.mean(),
        "impulse_room": whole * ((1.0 - alpha_g) * slope).mean(),
    }  # fmt: skip
    print(solver, {name: float(found[name][0] / value - 1.0) for name, value in hand.items()}, found["numerical"][0])
    for name, value in hand.items():
        assert found[name][0] == pytest.approx(value, rel=0.01), name
    assert max(abs(found["numerical"])) < 1e-3 * hand["impulse_pressure"]


@BOTH
def test_weight_of_gas_among_grains(tmp_path, solver):
    """Gas at rest: its weight, the pressure of the box and that on the room of the grains, which are held."""
    alpha_g, size, gravity, dt, steps = 0.7, (0.02, 0.04), (3.0, -9.81), 1e-2, 5
    with running(solver, tmp_path, size, 0.005, gravity=gravity) as gas:
        first = gas.start(np.full(len(gas.mesh.volumes), alpha_g), ("alpha_g",))
        for _ in range(steps):
            state = gas.advance(dt, {"alpha_g": np.full(len(gas.mesh.volumes), alpha_g)})
    found = grown(gas, first, state)
    weight = RHO * size[0] * size[1] * dt * steps * np.array((*gravity, 0.0))
    assert found["impulse_gravity"] == pytest.approx(alpha_g * weight, rel=1e-9)
    assert found["impulse_pressure"] == pytest.approx(-weight, rel=1e-6)
    assert found["impulse_room"] == pytest.approx((1.0 - alpha_g) * weight, rel=1e-6)
    assert max(np.abs(found[name]).max() for name in ("momentum", "momentum_in", "impulse_walls", "numerical")) < 1e-9


def stirred(gas, dt, steps, moves):
    """Gas that a dense blob drags round, in a box with a jet, a sliding lid and weight: what it grew by."""
    x, y = gas.mesh.centres[:, 0], gas.mesh.centres[:, 1]

    def room(t):
        cx, cy = 0.05 + moves * 0.02 * math.cos(20 * t), 0.05 + moves * 0.02 * math.sin(20 * t)
        return 1.0 - 0.5 * np.exp(-((x - cx) ** 2 + (y - cy) ** 2) / 0.015**2)

    first, moved = gas.start(room(0.0), ("alpha_g", "momentum_coefficient", "momentum")), 0.0
    before = first
    for step in range(1, steps + 1):
        alpha = room(step * dt)
        drag = 300.0 * (1.0 - alpha)
        push = drag[:, None] * [0.5, 0.2, 0.0]
        state = gas.advance(dt, {"alpha_g": alpha, "momentum_coefficient": drag, "momentum": push})
        now = grown(gas, before, state)
        moved, before = moved + sum(np.linalg.norm(now[name]) for name in IMPULSES), state
    return np.linalg.norm(grown(gas, first, state)["numerical"]) / moved


STIRRED = {
    "jet": {"kind": "velocity_inlet", "side": "left", "velocity_m_s": [0.4, 0.0]},
    "lid": {"kind": "wall", "side": "top", "velocity_m_s": [0.5, 0.0]},
    "out": {"kind": "pressure_outlet", "side": "right", "pressure_Pa": 3.0}, "walls": {"kind": "wall"},
}  # fmt: skip
THICK = {"boundaries": STIRRED, "gravity": (1.0, -9.81), "viscosity_Pa_s": 1e-3}


@pytest.mark.parametrize("stretch", [[1.0, 1.0], [3.0, 0.5]])
def test_embedded_gas_keeps_its_momentum(stretch):
    """Grains that rest: nothing is numerical beyond the tolerance of continuity, on graded cells too."""
    rel = stirred(EmbeddedGas(box_case((0.1, 0.1), 0.005, stretch=stretch, **THICK)), 1e-3, 40, 0)
    print(f"stretch {stretch}: numerical {rel:.1e} of what moved the gas")
    assert rel < 1e-8


@pytest.mark.parametrize(
    "solver, moves",
    [("embedded", 1)] + [pytest.param("openfoam", moves, marks=pytest.mark.openfoam) for moves in (0, 1)],
)
def test_numerical_impulse_falls_with_cells_and_windows(tmp_path, solver, moves):
    """Grains that move, and grains that rest in cells that get their velocity from faces: at most 0.05 % of what moves
    the gas, and less with cells and windows halved together. In OpenFOAM it is 1e-4 of that and falls by 0.3 to 0.7 of
    an order, as the lid's first windows have a shear that no cell resolves; before inlets set the gas moving before the
    first window it was 1.7e-2, of first order, all of it from there."""
    found = []
    for parts in (1, 2, 4):
        (tmp_path / str(parts)).mkdir()
        with running(solver, tmp_path / str(parts), (0.1, 0.1), 0.01 / parts, **THICK) as gas:
            found.append(stirred(gas, 2e-3 / parts, 20 * parts, moves))
    orders = [math.log2(a / b) for a, b in itertools.pairwise(found)]
    print(f"{solver}: numerical {', '.join(f'{rel:.1e}' for rel in found)} of what moved the gas, orders {orders}")
    assert max(found) < 5e-4
    assert min(orders) > (0.7 if solver == "embedded" else 0.0)


@pytest.mark.openfoam
def test_what_splitting_leaves_falls_with_outer_iterations(tmp_path):
    """By which the velocity would still change, over the fastest; one iteration is not the last."""
    left = {}
    for outers in (1, 2, 4):
        (tmp_path / str(outers)).mkdir()
        with box(tmp_path / str(outers), (0.1, 0.1), 0.005, outers=outers, **THICK) as gas:
            blob = 0.5 * np.exp(-((gas.mesh.centres[:, :2] - 0.05) ** 2).sum(axis=1) / 0.015**2)
            drag = {"momentum_coefficient": 300.0 * blob, "momentum": 300.0 * blob[:, None] * [0.5, 0.2, 0.0]}
            gas.start(1.0 - blob, ("alpha_g", *drag))
            for _ in range(3):
                state = gas.advance(4e-3, drag | {"alpha_g": 1.0 - blob})
            left[outers] = state.budget.held["gas_splitting_rel"]
    print(f"splitting leaves {left}")
    assert 0.05 > left[1] > 3.0 * left[2] > 9.0 * left[4] > 0.0


@BOTH
def test_weight_of_gas_on_each_wall(tmp_path, solver):
    """Gas at rest: p = rho g (H/2 - y) on floor, lid and sides, and its moment about the origin, cell by cell."""
    (length, height), g, t = (0.02, 0.04), 9.81, 1e-2
    sides = {side: {"kind": "wall", "side": side} for side in ("left", "right", "bottom", "top")}
    with running(solver, tmp_path, (length, height), 0.005, gravity=(0.0, -g), boundaries=sides) as gas:
        gas.start(None, ())
        given = gas.advance(t, {}).budget.patches
    found = {name: np.array(values) / (t * gas.mesh.depth) for name, values in given.items()}
    y = (np.arange(8) + 0.5) * height / 8
    on_left = RHO * g * (0.5 * height - y) * 0.005
    assert found["bottom"][0, 1] == pytest.approx(RHO * g * 0.5 * height * length, rel=1e-6)
    assert found["top"][0, 1] == pytest.approx(RHO * g * 0.5 * height * length, rel=1e-6)
    assert found["bottom"][2, 2] == pytest.approx(0.5 * length * found["bottom"][0, 1], rel=1e-6)
    assert found["left"][2, 2] == pytest.approx(-(y * on_left).sum(), rel=1e-6)
    assert found["right"][2, 2] == pytest.approx((y * on_left).sum(), rel=1e-6)
    assert max(np.abs(values[1]).max() for values in found.values()) < 1e-12


@BOTH
def test_patches_share_what_the_boundary_gives(tmp_path, solver):
    """Pressure and viscous stress of a stirred gas, on graded cells: patch by patch as much as in all; the lid drags,
    the wind presses."""
    graded = {"stretch": [2.0, 0.5]} if solver == "embedded" else {}
    with running(solver, tmp_path, (0.1, 0.1), 0.01, **graded, **THICK) as gas:
        first = gas.start(None, ()).budget
        for _ in range(10):
            now = gas.advance(2e-3, {}).budget
    patches = {name: np.array(given) for name, given in now.patches.items() if name in STIRRED}
    for kind, name in enumerate(("impulse_pressure", "impulse_walls")):
        whole = np.subtract(getattr(now, name), getattr(first, name))
        assert sum(patches.values())[kind] == pytest.approx(whole, rel=1e-10, abs=1e-13)
    assert patches.keys() == STIRRED.keys()
    assert patches["lid"][1, 0] > 0.0 > patches["walls"][1, 0]
