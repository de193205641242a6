"""sdphGasFoam on real OpenFOAM, each part of its equations alone, against exact solutions."""

import numpy as np
import pytest
from gas_boxes import AIR, box, total
from gas_columns import CP, OPEN, RHO, gas_volume

from coupling.gas import Unfinished

pytestmark = pytest.mark.openfoam
COLUMN = {
    "below": {"kind": "velocity_inlet", "side": "bottom", "velocity_m_s": [0.0, 0.2]},
    "above": {"kind": "pressure_outlet", "side": "top", "pressure_Pa": 0.0},
    "walls": {"kind": "slip_wall"},
}


@pytest.mark.parametrize("dt, steps", [(1e-4, 300), (1e-2, 30)])
def test_ergun_pressure_drop(tmp_path, dt, steps):
    """Fixed bed, Ergun (Chem. Eng. Prog. 48, 89, 1952); the drag coefficient follows the velocity handed back."""
    alpha_p, d, mu, speed = 0.6, 0.5e-3, AIR["viscosity_Pa_s"], 0.2
    with box(tmp_path, (0.04, 0.4), 0.01, boundaries=COLUMN) as gas:
        alpha = np.full(len(gas.mesh.volumes), 1 - alpha_p)
        state = gas.start(alpha, ("momentum_coefficient", "momentum"))
        for _ in range(steps):
            slip = np.linalg.norm(state.fields["velocity"], axis=1)
            beta = 150 * alpha_p**2 * mu / (alpha * d**2) + 1.75 * alpha_p * RHO * slip / d
            before = state.budget.impulse_pressure[1]
            state = gas.advance(dt, {"momentum_coefficient": beta, "momentum": np.zeros((len(beta), 3))})
        y, column = gas.mesh.centres[:, 1], gas.mesh.volumes.sum()
    ergun = (150 * alpha_p**2 * mu * speed / d**2 + 1.75 * alpha_p * RHO * speed**2 / d) / (1 - alpha_p) ** 3
    inside = y > 0.05  # the gas comes in as through alpha_g = 1, and speeds up in the first cells
    slope = np.polyfit(y[inside], state.fields["pressure"][inside], 1)[0]
    print(f"Ergun {-ergun:.2f} Pa/m, computed {slope:.2f}")
    assert slope == pytest.approx(-ergun, rel=1e-3)
    assert state.fields["pressure_gradient"][inside, 1] == pytest.approx(-ergun, rel=1e-3)
    # grains in the first row, and the inlet itself, bear what the speed between the grains asks for
    faster = RHO * speed / (1 - alpha_p) * (speed / (1 - alpha_p) - speed) / 0.01  # 18 Pa/m in a row of 10 mm
    assert state.fields["pressure_gradient"][y < 0.01, 1] == pytest.approx(-ergun - faster, rel=1e-3)
    assert (state.budget.impulse_pressure[1] - before) / dt == pytest.approx(ergun * column, rel=1e-3)


@pytest.mark.parametrize("dt, steps", [(1e-4, 300), (1e-2, 40)])
def test_rim_of_a_bed_makes_no_waves(tmp_path, dt, steps):
    """alpha_g jumps from 1 to 0.4 between two cells: the flux of each cell stays near the one that comes in, whatever
    the step, and the drag balances the pressure of the whole column, as in the momentum equation of a steady gas of low
    inertia."""
    alpha_p, d, mu, speed = 0.6, 0.5e-3, AIR["viscosity_Pa_s"], 0.2
    with box(tmp_path, (0.02, 0.4), 0.01, boundaries=COLUMN) as gas:
        y = gas.mesh.centres[:, 1]
        alpha = np.where((y > 0.1) & (y < 0.3), 1 - alpha_p, 1.0)
        beta = np.where(alpha < 1, 150 * alpha_p**2 * mu / (0.4 * d**2), 0.0)
        state = gas.start(alpha, ("momentum_coefficient", "momentum"))
        for _ in range(steps):
            state = gas.advance(dt, {"momentum_coefficient": beta, "momentum": np.zeros((len(beta), 3))})
    flux = alpha * state.fields["velocity"][:, 1] / speed
    # on the face between the two alpha_g is their mean, 0.7: half of each cell at the rim is filled with that
    assert flux.min() == pytest.approx(0.5 * (1 + 0.4 / 0.7), rel=1e-2)
    assert flux.max() == pytest.approx(0.5 * (1 + 1 / 0.7), rel=1e-2)
    drag = total(gas, beta * state.fields["velocity"][:, 1])
    pressure = total(gas, alpha * state.fields["pressure_gradient"][:, 1])
    assert pressure == pytest.approx(-drag, rel=1e-3)


def test_uniform_heat_source_is_exact(tmp_path):
    source, dt, steps = 5e4, 2e-3, 10
    with box(tmp_path, (0.02, 0.02), 0.005) as gas:
        alpha = np.full(len(gas.mesh.volumes), 0.7)
        start = gas.start(alpha, ("heat",))
        for _ in range(steps):
            state = gas.advance(dt, {"heat": np.full(len(alpha), source)})
    rise = source * dt * steps / (0.7 * RHO * CP)
    assert state.fields["temperature"] == pytest.approx(300.0 + rise, rel=1e-13)
    assert state.budget.energy - start.budget.energy == pytest.approx(source * dt * steps * gas_volume(gas), rel=1e-11)


def test_two_temperatures_relax(tmp_path):
    """Grains and gas with one exchange coefficient: each implicit step is the closed form of that step."""
    eps, dt, grains = 2e5, 1e-3, 280.0
    content = 0.4 * RHO * CP / dt
    with box(tmp_path, (0.02, 0.02), 0.005) as gas:
        n = len(gas.mesh.volumes)
        state = gas.start(np.full(n, 0.4), ("heat_coefficient", "heat"))
        expected = 300.0
        for _ in range(20):
            state = gas.advance(dt, {"heat_coefficient": np.full(n, eps), "heat": np.full(n, eps * grains)})
            expected = (content * expected + eps * grains) / (content + eps)
    assert state.fields["temperature"] == pytest.approx(expected, rel=1e-13)


def test_heat_given_is_heat_gained(tmp_path):
    """Uneven exchange in still gas with conduction: drift of the energy below 1e-9 of the heat exchanged."""
    with box(tmp_path, (0.1, 0.1), 0.005) as gas:
        x, y = gas.mesh.centres[:, 0], gas.mesh.centres[:, 1]
        heat = np.where(np.hypot(x - 0.05, y - 0.05) < 0.03, 2e4, 0.0)
        state = gas.start(np.where(heat > 0, 0.4, 1.0), ("heat_coefficient", "heat"))
        first, given = state.budget.energy, 0.0
        for _ in range(50):
            state = gas.advance(2e-4, {"heat_coefficient": heat, "heat": heat * 280.0})
            given += 2e-4 * total(gas, heat * (280.0 - state.fields["temperature"]))
    drift = abs(state.budget.energy - first - given) / abs(given)
    print(f"energy drift {drift:.1e} of the heat exchanged")
    assert drift < 1e-9


def moving_alpha(gas, t):
    """A dense blob that goes round in the middle of a box of 0.1 m."""
    x, y = gas.mesh.centres[:, 0], gas.mesh.centres[:, 1]
    cx, cy = 0.05 + 0.02 * np.cos(20 * t), 0.05 + 0.02 * np.sin(20 * t)
    return 1.0 - 0.5 * np.exp(-((x - cx) ** 2 + (y - cy) ** 2) / 0.015**2)


@pytest.mark.parametrize("equation", ["constant", "operating", "ideal"])
def test_moving_alpha_in_a_closed_box(tmp_path, equation):
    """The room for the gas changes and moves: its mass and its energy stay, and gas of one temperature keeps it."""
    dt = 1e-3
    with box(tmp_path, (0.1, 0.1), 0.005, equation_of_state=equation, molar_mass_kg_kmol=29.5) as gas:
        state = gas.start(moving_alpha(gas, 0.0), ("alpha_g",))
        first = state.budget
        for step in range(1, 21):
            state = gas.advance(dt, {"alpha_g": moving_alpha(gas, step * dt)})
    assert state.budget.mass == pytest.approx(first.mass, rel=1e-13)
    assert state.budget.energy - state.budget.pressure_work == pytest.approx(first.energy, rel=1e-12)
    # on gas of constant density the pressure works, by the order of U^2/cp [K]
    works = np.abs(state.fields["velocity"]).max() ** 2 / CP if equation == "constant" else 300.0 * 1e-8
    assert state.fields["temperature"] == pytest.approx(300.0, abs=works)
    assert equation == "constant" or state.budget.pressure_work == 0.0
    assert total(gas, moving_alpha(gas, 20 * dt) * state.fields["density"]) == pytest.approx(first.mass, rel=1e-13)
    assert np.abs(state.fields["velocity"]).max() < 1.0
    assert np.abs(state.fields["velocity"]).max() > 0.01


def test_moving_alpha_with_heat_conserves_energy(tmp_path):
    dt = 1e-3
    with box(tmp_path, (0.1, 0.1), 0.005) as gas:
        alpha = moving_alpha(gas, 0.0)
        state = gas.start(alpha, ("alpha_g", "heat_coefficient", "heat"))
        first, given = state.budget, 0.0
        for step in range(1, 31):
            alpha = moving_alpha(gas, step * dt)
            heat = 1e5 * (1 - alpha)
            state = gas.advance(dt, {"alpha_g": alpha, "heat_coefficient": heat, "heat": heat * 290.0})
            given += dt * total(gas, heat * (290.0 - state.fields["temperature"]))
    drift = abs(state.budget.energy - state.budget.pressure_work - first.energy - given) / abs(given)
    print(f"energy drift {drift:.1e} of the heat exchanged, with flow")
    assert drift < 1e-9


def test_drag_given_is_drag_gained(tmp_path):
    """Momentum: in a box with slip walls the whole change is drag, but for the pressure on the walls.

    Uniform grains pull the gas along x in a channel without ends (inlet and outlet move with it): dU/dt = beta (v_p -
    U).
    """
    beta, pull, dt = 50.0, 2.0, 1e-3
    boundaries = {
        "ends": {"kind": "pressure_outlet", "pressure_Pa": 0.0},
        "sides": {"kind": "slip_wall", "side": "bottom"},
    }
    boundaries["lid"] = {"kind": "slip_wall", "side": "top"}
    with box(tmp_path, (0.1, 0.02), 0.005, boundaries=boundaries) as gas:
        n = len(gas.mesh.volumes)
        alpha = np.full(n, 0.8)
        drag, drag_velocity = np.full(n, beta), np.tile([beta * pull, 0.0, 0.0], (n, 1))
        state = gas.start(alpha, ("momentum_coefficient", "momentum"))
        speed = 0.0
        for _ in range(10):
            state = gas.advance(dt, {"momentum_coefficient": drag, "momentum": drag_velocity})
            speed = (0.8 * RHO / dt * speed + beta * pull) / (0.8 * RHO / dt + beta)
    inside = (gas.mesh.centres[:, 0] > 0.03) & (gas.mesh.centres[:, 0] < 0.07)
    assert state.fields["velocity"][inside, 0] == pytest.approx(speed, rel=1e-6)


def test_impulse_of_the_particles_is_what_they_reckon(tmp_path):
    """From the fields that are handed back: drag, and the pressure on the room of the particles."""
    dt = 5e-4
    with box(tmp_path, (0.1, 0.1), 0.005, gravity=(0.0, -9.81)) as gas:
        alpha = moving_alpha(gas, 0.0)
        state = gas.start(alpha, ("alpha_g", "momentum_coefficient", "momentum"))
        for step in range(1, 11):
            before = state.budget
            alpha = moving_alpha(gas, step * dt)
            drag = 300.0 * (1 - alpha)
            pull = drag[:, None] * [0.5, 0.2, 0.0]
            state = gas.advance(dt, {"alpha_g": alpha, "momentum_coefficient": drag, "momentum": pull})
            fields = state.fields
            given = dt * total(gas, pull - drag[:, None] * fields["velocity"])
            room = dt * total(gas, (1 - alpha)[:, None] * fields["pressure_gradient"])
            grown = np.subtract(state.budget.impulse_exchange, before.impulse_exchange)
            assert grown == pytest.approx(given, rel=1e-10, abs=1e-15)
            grown = np.subtract(state.budget.impulse_room, before.impulse_room)
            assert grown == pytest.approx(room, rel=1e-9, abs=1e-15)
    assert np.abs(state.budget.momentum).max() > 1e-6


def test_hydrostatic_gas_rests(tmp_path):
    """Gas alone under gravity between a floor and an outlet: no motion, and the pressure is the weight above."""
    boundaries = {"above": {"kind": "pressure_outlet", "side": "top", "pressure_Pa": 0.0}, "walls": {"kind": "wall"}}
    with box(tmp_path, (0.1, 0.2), 0.01, boundaries=boundaries, gravity=(0.0, -9.81)) as gas:
        alpha = np.full(len(gas.mesh.volumes), 0.9)
        gas.start(alpha, ("alpha_g",))
        for _ in range(5):
            state = gas.advance(1e-3, {"alpha_g": alpha})
    depth = 0.2 - gas.mesh.centres[:, 1]
    assert np.abs(state.fields["velocity"]).max() < 1e-12
    assert state.fields["pressure"] == pytest.approx(RHO * 9.81 * depth, rel=1e-9)
    assert state.fields["pressure_gradient"][:, 1] == pytest.approx(-RHO * 9.81, rel=1e-9)


def test_heated_gas_of_an_open_box_expands(tmp_path):
    """Ideal gas at operating pressure: density follows the temperature, the rest leaves through the outlet."""
    with box(
        tmp_path, (0.05, 0.05), 0.005, boundaries=OPEN, equation_of_state="operating", molar_mass_kg_kmol=28.96
    ) as gas:
        n = len(gas.mesh.volumes)
        start = gas.start(None, ("heat",))
        for _ in range(20):
            state = gas.advance(1e-3, {"heat": np.full(n, 1e5)})
    expected = 101325.0 * 28.96 / (8314.462618 * state.fields["temperature"])
    assert state.fields["temperature"].min() > 301.0
    assert state.fields["density"] == pytest.approx(expected, rel=2e-5)
    assert state.budget.mass - start.budget.mass == pytest.approx(state.budget.mass_in, rel=1e-10)
    gained = state.budget.energy - start.budget.energy - state.budget.energy_in - state.budget.pressure_work
    assert gained == pytest.approx(1e5 * 0.02 * gas_volume(gas), rel=1e-9)


FILLED = {"in": {"kind": "velocity_inlet", "side": "left", "velocity_m_s": [0.1, 0.0]}, "walls": {"kind": "wall"}}


@pytest.mark.parametrize("boundaries", [{"walls": {"kind": "wall"}}, FILLED])
def test_a_closed_box_of_ideal_gas_has_one_pressure(tmp_path, boundaries):
    """Heated, or filled: every cell has the pressure of what is in it, and no cell is given more than the others."""
    molar, dt, steps = 28.96, 1e-3, 20
    with box(
        tmp_path, (0.1, 0.1), 0.005, boundaries=boundaries, equation_of_state="ideal", molar_mass_kg_kmol=molar
    ) as gas:
        n = len(gas.mesh.volumes)
        start = gas.start(None, ("heat",))
        for _ in range(steps):
            state = gas.advance(dt, {"heat": np.full(n, 2e5 if boundaries is not FILLED else 0.0)})
    fields, volume = state.fields, gas.mesh.volumes.sum()
    absolute = fields["density"] * 8314.462618 / molar * fields["temperature"]
    risen = (state.budget.mass * 8314.462618 / molar / volume) * fields["temperature"].mean() - 101325.0
    assert fields["pressure"] == pytest.approx(absolute - 101325.0, rel=1e-3)
    assert fields["pressure"] == pytest.approx(risen, rel=1e-2) and risen > 800.0
    assert state.budget.held["gas_mass_left_rel"] < 1e-7
    if boundaries is not FILLED:
        assert np.abs(fields["velocity"]).max() < 1e-6
        assert fields["density"] == pytest.approx(start.budget.mass / volume, rel=1e-7)


def test_heat_that_is_not_found_is_told(tmp_path):
    """So good a conductor takes more sweeps than the case allows."""
    with box(tmp_path, (0.1, 0.1), 0.005, conductivity_W_m_K=1e4) as gas:
        gas.start(None, ("heat",))
        spot = np.hypot(*(gas.mesh.centres[:, :2] - 0.02).T) < 0.01
        with pytest.raises(Unfinished, match="T has not converged: .* of it is left after 50 sweeps, 1e-09 is allowed"):
            gas.advance(1e-2, {"heat": 1e8 * spot})
