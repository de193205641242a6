"""The ledger: its rows, and that it tells a leak from a closed budget."""

import dataclasses

import numpy as np
import pytest
from builders import disc, fixed_windows, run, simulation
from fakes import StillGas

from sdph.engine.ledger import Column, Ledger
from sdph.running import output
from sdph.running.balances import BARS

SHORT = (
    "resolution.spacing_mm=10",
    "resolution.cell_mm=25",
    "run.end_time_s=0.004",
    "run.output_interval_s=0.004",
    "run.report_at_s=[]",
)


class LeakyGas(StillGas):
    """Loses a millionth of its temperature in every step."""

    def advance(self, dt, sources):
        self.temperature *= 1.0 - 1e-6
        return super().advance(dt, sources)


class HeatedGas(StillGas):
    """Gets 1 J per step through its boundary, and says so."""

    crossed = 0.0

    def advance(self, dt, sources):
        self.temperature += (
            1.0 / (self.alpha * self.mesh.volumes).sum() / self.case.gas.density / self.case.gas.heat_capacity
        )
        self.crossed += 1.0
        return super().advance(dt, sources)

    def _state(self):
        state = super()._state()
        return dataclasses.replace(state, budget=dataclasses.replace(state.budget, energy_in=self.crossed))


def test_closed_box_is_closed(tmp_path):
    done = run(disc(*SHORT), tmp_path)
    summary = done.ledger.summary()
    assert summary["heat_exchanged_J"] > 1.0
    assert summary["exchange_energy_mismatch_rel"] <= 1e-12
    assert summary["energy_drift_rel"] <= 1e-9
    assert summary["mass_drift_rel"] == 0.0


def test_leak_shows(tmp_path):
    done = run(disc(*SHORT), tmp_path, gas=LeakyGas)
    lost = done.ledger.first["gas_energy_J"] * 1e-6 * done.windows
    assert done.ledger.summary()["energy_drift_J"] == pytest.approx(lost, rel=0.5)
    assert done.ledger.summary()["energy_drift_rel"] > 1e-6


def test_a_leak_with_nothing_exchanged_shows(tmp_path):
    """There is nothing to relate it to, so that the joules are judged."""
    run = simulation(disc(*SHORT), tmp_path)
    totals, budget = run.grains.totals() | {"heat_on_its_way_J": 0.0}, run.gas_state.budget
    leaky = dataclasses.replace(budget, energy=budget.energy - 3.0)
    run.ledger.close_window(1e-3, 1e-3, "largest", totals, leaky, run.ledger.nothing)
    assert run.ledger.summary()["energy_drift_rel"] == pytest.approx(3.0, rel=1e-6)


def test_a_drift_is_related_to_what_came_in_through_the_boundary(tmp_path):
    """Gas at rest that its boundary warms exchanges nothing: round-off of it was judged by 1e-16 J of pressure."""
    run = simulation(disc(*SHORT), tmp_path)
    totals, budget = run.grains.totals() | {"heat_on_its_way_J": 0.0}, run.gas_state.budget
    warmed = dataclasses.replace(budget, energy=budget.energy + 4.99, energy_in=budget.energy_in + 5.0)
    warmed = dataclasses.replace(warmed, pressure_work=warmed.pressure_work + 1e-16)
    run.ledger.close_window(1e-3, 1e-3, "largest", totals, warmed, run.ledger.nothing)
    assert run.ledger.summary()["energy_drift_rel"] == pytest.approx(0.01 / 5.0, rel=1e-6)


def test_round_off_of_heat_that_next_to_nothing_is_exchanged_of_is_no_drift(tmp_path):
    """A hopper in gas at rest warned of a drift of 2.7e6: 5e-12 J of 2e-18."""
    run = simulation(disc(*SHORT), tmp_path)
    totals, budget = run.grains.totals() | {"heat_on_its_way_J": 0.0}, run.gas_state.budget
    off = dataclasses.replace(budget, energy=budget.energy * (1.0 + 4e-16), pressure_work=budget.pressure_work + 1e-18)
    run.ledger.close_window(1e-3, 1e-3, "largest", totals, off, run.ledger.nothing)
    told = run.ledger.summary()
    assert 0.0 < told["energy_drift_rel"] == told["energy_drift_J"] < 1e-8


def drifted(tmp_path, windows, lost):
    """Summary of gas at rest in a big and warm room (2e9 J) that lost a share of its heat in so many windows."""
    tmp_path.mkdir()
    run = simulation(disc(*SHORT), tmp_path)
    totals, budget = run.grains.totals() | {"heat_on_its_way_J": 0.0}, run.gas_state.budget
    run.ledger.first = run.ledger.last = run.ledger.first | {"gas_energy_J": 2e9}
    for number in range(1, windows + 1):
        energy = 2e9 * run.ledger.depth * (1.0 - lost * number / windows)
        run.ledger.close_window(
            1e-3 * number, 1e-3, "largest", totals, dataclasses.replace(budget, energy=energy), run.ledger.nothing
        )
    return run.ledger.summary()


def test_round_off_of_many_windows_is_no_drift_and_a_leak_is(tmp_path):
    """Dust that sank in still air lost 2e-14 of 2.8 MJ in 6540 windows and was told to have made something. A leak of
    as much in one window, and one of 1e-12 of the heat, are told."""
    bar = BARS["energy_drift_rel"]
    many, few = drifted(tmp_path / "a", 400, 1e-14), drifted(tmp_path / "b", 1, 1e-14)
    assert 0.0 < many["energy_drift_rel"] < bar < few["energy_drift_rel"]
    assert drifted(tmp_path / "c", 400, 1e-12)["energy_drift_rel"] > 20.0 * bar


def test_numerical_work_is_told_beside_what_is_dissipated(tmp_path):
    run = simulation(disc(*SHORT), tmp_path)
    totals = run.grains.totals() | {"heat_on_its_way_J": 0.0}
    done = {"numerical_work_J": -0.3, "friction_J": 4.0, "mechanical_heat_J": 1.5, "collision_heat_J": 0.5}
    run.ledger.close_window(1e-3, 1e-3, "largest", totals, run.gas_state.budget, run.ledger.nothing | done)
    assert run.ledger.summary()["numerical_work_rel"] == pytest.approx(0.05, rel=1e-12)


def test_unequal_exchange_shows(tmp_path):
    """One of three windows in which the gas gave a millionth more than the particles took."""
    run = simulation(disc(*SHORT), tmp_path)
    for window, given in enumerate((10.0, 10.00001, 10.0)):
        exchanged = run.ledger.nothing | {"heat_to_particles_J": 10.0, "heat_to_gas_J": -given}
        totals = run.grains.totals() | {"heat_on_its_way_J": 0.0}
        run.ledger.close_window(1e-3 * (window + 1), 1e-3, "largest", totals, run.gas_state.budget, exchanged)
    summary = run.ledger.summary()
    assert summary["heat_exchanged_J"] == 30.0
    assert summary["exchange_energy_mismatch_rel"] == pytest.approx(1e-5 / 30.0, rel=1e-6)


@pytest.mark.parametrize("missing", [0.0, 0.01])
def test_mass_that_comes_and_goes_is_no_drift(tmp_path, missing):
    """2 kg come in, 0.75 kg leave, 0.25 kg evaporate, and what is `missing` of the rest is told."""
    run = simulation(disc(*SHORT), tmp_path)
    totals, budget = run.grains.totals() | {"heat_on_its_way_J": 0.0}, run.gas_state.budget
    first = totals["particle_mass_kg"]
    totals["particle_mass_kg"] += 2.0 - 0.75 - 0.25 - missing
    moved = run.ledger.nothing | {"injected_kg": 2.0, "left_kg": 0.75, "evaporated_kg": 0.25}
    run.ledger.close_window(1e-3, 1e-3, "largest", totals, dataclasses.replace(budget, mass=budget.mass + 0.25), moved)
    summary = run.ledger.summary()
    assert summary["mass_drift_rel"] == pytest.approx(missing / (first + 2.0 + budget.mass), rel=1e-6, abs=1e-15)
    assert summary["particle_mass_drift_rel"] == pytest.approx(missing / (first + 2.0), rel=1e-6, abs=1e-15)


def test_what_crosses_the_boundary_is_no_drift(tmp_path):
    done = run(disc(*SHORT), tmp_path, gas=HeatedGas)
    assert done.ledger.last["gas_energy_in_J"] == done.windows
    assert done.ledger.summary()["energy_drift_rel"] <= 1e-9


def test_one_row_a_window_with_what_was_exchanged(tmp_path):
    done = run(disc(*SHORT, *fixed_windows(0.001)), tmp_path)
    table = output.read_table(tmp_path / "ledger.csv")
    assert len(table["time_s"]) == done.windows + 1 == 5
    np.testing.assert_allclose(np.diff(table["time_s"]), table["window_s"][1:], rtol=1e-12)
    np.testing.assert_allclose(np.diff(table["particle_energy_J"]), table["heat_to_particles_J"][1:], rtol=1e-6)
    np.testing.assert_allclose(table["heat_to_particles_J"], -table["heat_to_gas_J"], rtol=1e-12)
    assert table["particle_mass_kg"][0] == pytest.approx(done.state.mass.sum(), rel=1e-15)
    assert set(table["limit"][1:]) == {"largest"}


def test_momentum_and_kinetic_energy_of_moving_grains(tmp_path):
    started = simulation(disc(*SHORT, "particles.disc.velocity_m_s=[3.0,-4.0]"), tmp_path)
    started.ledger.table.close()
    table, mass = output.read_table(tmp_path / "ledger.csv"), started.state.mass.sum()
    assert table["particle_momentum_x_kg_m_s"][0] == pytest.approx(3.0 * mass, rel=1e-12)
    assert table["particle_momentum_y_kg_m_s"][0] == pytest.approx(-4.0 * mass, rel=1e-12)
    assert table["particle_kinetic_energy_J"][0] == pytest.approx(12.5 * mass, rel=1e-12)


def test_one_way_exchanges_nothing_with_the_gas(tmp_path):
    done = run(disc(*SHORT, "coupling.one_way=true"), tmp_path)
    table = output.read_table(tmp_path / "ledger.csv")
    np.testing.assert_array_equal(table["heat_to_gas_J"], 0.0)
    assert done.ledger.last["gas_energy_J"] == done.ledger.first["gas_energy_J"]
    assert done.state.temperature.mean() > 288.0


@pytest.mark.parametrize("missing", [0.0, 0.5])
def test_a_column_of_an_effect_counts_with_its_signs(tmp_path, missing):
    """2 J become motion and are taken from heat; what is `missing` of the motion is told."""
    started = simulation(case := disc(*SHORT), tmp_path)
    columns = (Column("turned_J", motion=1, heat=-1), Column("seen"))
    own = Ledger(tmp_path / "own.csv", case, started.gas.mesh.depth, columns, ("turned_J", "seen"))
    totals, budget = started.grains.totals() | {"heat_on_its_way_J": 0.0}, started.gas_state.budget
    own.open(totals, budget)
    totals["particle_kinetic_energy_J"] += 2.0 - missing
    totals["particle_energy_J"] -= 2.0
    own.close_window(1e-3, 1e-3, "largest", totals, budget, own.nothing | {"turned_J": 2.0, "seen": 7.0})
    summary = own.summary()
    assert (summary["turned_J"], summary["seen"]) == (2.0, 7.0)
    assert summary["motion_drift_J"] == pytest.approx(missing, abs=1e-9)
    assert summary["energy_drift_J"] == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize(("friction", "told"), [(1e-30, 1.01e-28), (1e-6, 1.0)])
def test_round_off_is_nothing_to_relate_work_of_the_gas_to(tmp_path, friction, told):
    """Gas at rest that has 1e-28 J of motion was said to do a hundred times as much numerical work as its friction."""
    ledger = run(disc(*SHORT), tmp_path).ledger
    ledger.sums |= dict.fromkeys(("work_of_drag_J", "damping_heat_J", "vapour_motion_J"), 0.0)
    ledger.sums["friction_J"], ledger.last["gas_kinetic_J"] = friction, 1e-28
    assert ledger.summary()["gas_numerical_work_rel"] == pytest.approx(told)
