"""Balances of motion: what both sides lose becomes heat, to round-off, and a gas that cheats is caught."""

import dataclasses

import numpy as np
import pytest
from grain_boxes import Row, started, table, windows

from coupling.gas import IMPULSES, NOTHING
from sdph.case import read as cases
from sdph.engine.ledger import IMPULSES_OF_GAS

SPEED = 0.3


def dusty(folder, count, gas=Row, gravity=(0.0, 0.0), more=()):
    """Grains that drift through gas at rest in a closed row, for ten relaxation times of the drag, in `count` windows,
    with `more` effects: the run when it is over."""
    own = table(["drag", "gravity", *more], alpha_p=4e-4, gravity=gravity, **windows(0.5, count))
    own["particles"]["bed"]["velocity_m_s"] = [SPEED, 0.0]
    case = cases.from_table(own)
    run = started(case, folder, gas(case))
    while run.time < 0.5:
        run.window()
    run.ledger.table.close()
    return run


def motion(row):
    return row["particle_kinetic_energy_J"] + row["gas_kinetic_J"]


@pytest.mark.parametrize("count", [1, 7, 50])
def test_what_motion_loses_in_a_dusty_box_is_heat(tmp_path, count):
    """Whatever the windows: one of ten relaxation times as well as fifty."""
    own = dusty(tmp_path, count).ledger
    lost, heat = motion(own.first) - motion(own.last), own.last["gas_energy_J"] + own.last["heat_on_its_way_J"]
    assert lost > 0.1 * motion(own.first)
    assert heat == pytest.approx(lost, rel=1e-10)
    summary = own.summary()
    assert summary["motion_drift_rel"] < 1e-12 and summary["energy_drift_rel"] < 1e-12
    assert abs(summary["gas_dissipation_J"]) < 1e-10 * lost
    assert summary["exchange_momentum_mismatch_rel"] < 1e-12 and summary["gas_momentum_drift_rel"] < 1e-12
    assert summary["gas_momentum_drift_kg_m_s"] < 1e-12 * abs(own.last["gas_impulse_exchange_x_kg_m_s"])


def test_what_agitation_loses_to_the_gas_is_heat_of_the_gas(tmp_path):
    own = dusty(tmp_path, 7, more=("granular_temperature",)).ledger
    agitated, damped = own.first["particle_fluctuation_energy_J"], own.sums["damping_heat_J"]
    heat = own.last["gas_energy_J"] + own.last["heat_on_its_way_J"]
    assert damped > 0.1 * agitated > 0.0
    assert heat == pytest.approx(motion(own.first) - motion(own.last) + damped, rel=1e-10)
    assert abs(own.summary()["gas_dissipation_J"]) < 1e-10 * damped


class Cheat(Row):
    """Says of one total that it has a thousandth less after each window."""

    total = ""

    def advance(self, dt, sources):
        self.windows = getattr(self, "windows", 0) + 1
        return super().advance(dt, sources)

    def _state(self):
        state, lost = super()._state(), 1.0 - 1e-3 * getattr(self, "windows", 0)
        if not self.total:
            return state
        own = np.multiply(getattr(state.budget, self.total), lost)
        own = tuple(own.tolist()) if np.ndim(own) else float(own)
        return dataclasses.replace(state, budget=dataclasses.replace(state.budget, **{self.total: own}))


@pytest.mark.parametrize(
    "total, told", [("mass", "mass_drift_rel"), ("energy", "energy_drift_rel"), ("kinetic", "gas_dissipation_rel")]
)
def test_a_gas_that_loses_something_is_caught(tmp_path, total, told):
    honest = dusty(tmp_path, 7, Cheat).ledger.summary()[told]
    cheat = type("Cheats", (Cheat,), {"total": total})
    (tmp_path / "cheat").mkdir()
    assert dusty(tmp_path / "cheat", 7, cheat).ledger.summary()[told] > 1e-6 > 1e3 * abs(honest)


class Viscous(Row):
    """Loses a thousandth of its motion in each window, and says that its viscosity took two thirds of that."""

    gone = 0.0

    def advance(self, dt, sources):
        state = super().advance(dt, sources)
        self.gone += 1e-3 * state.budget.kinetic
        told = {"kinetic": state.budget.kinetic - self.gone, "viscous_work": -2.0 / 3.0 * self.gone}
        return dataclasses.replace(state, budget=dataclasses.replace(state.budget, **told))


def test_work_of_the_gas_s_viscosity_is_apart_from_what_is_numerical(tmp_path):
    run = dusty(tmp_path, 7, Viscous)
    found, gone = run.ledger.summary(), run.gas.gone
    assert found["gas_viscous_work_J"] == pytest.approx(-2.0 / 3.0 * gone) and gone > 0.0
    assert found["gas_numerical_work_J"] == pytest.approx(-1.0 / 3.0 * gone, rel=1e-6)
    physical = run.ledger.sums["friction_J"] + 2.0 / 3.0 * gone
    assert found["gas_numerical_work_rel"] == pytest.approx(1.0 / 3.0 * gone / physical, rel=1e-6)


class Driven(Cheat):
    """The same, which a gradient of pressure drives besides."""

    def __init__(self, case):
        super().__init__(case, gradient=(20.0, 0.0, 0.0))


class Silent(Driven):
    """Says of its momentum and of all that moves it nothing at all."""

    def _state(self):
        state = super()._state()
        nothing = dict.fromkeys(("momentum", *IMPULSES), NOTHING)
        return dataclasses.replace(state, budget=dataclasses.replace(state.budget, **nothing))


@pytest.mark.parametrize(
    "total, told",
    [
        *((total, "gas_momentum_drift") for total in ("momentum", "impulse_pressure", "impulse_gravity")),
        *((total, "gas_momentum_drift") for total in ("impulse_room", "impulse_exchange")),
        ("impulse_exchange", "exchange_momentum_mismatch"),
    ],
)
def test_a_gas_that_loses_momentum_is_caught(tmp_path, total, told):
    """Of its momentum, or of what moves it."""
    honest = dusty(tmp_path, 7, Driven, (0.3, -9.81)).ledger.summary()[f"{told}_rel"]
    cheat = type("Cheats", (Driven,), {"total": total})
    (tmp_path / "cheat").mkdir()
    assert dusty(tmp_path / "cheat", 7, cheat, (0.3, -9.81)).ledger.summary()[f"{told}_rel"] > 1e-6 > 1e3 * honest


def test_a_gas_that_says_nothing_of_its_momentum_is_caught(tmp_path):
    summary = dusty(tmp_path, 7, Silent).ledger.summary()
    assert summary["gas_momentum_drift_kg_m_s"] == 0.0
    assert summary["exchange_momentum_mismatch_rel"] > 1e-2


def test_the_ledger_knows_every_impulse_of_the_gas():
    assert IMPULSES_OF_GAS == IMPULSES


def test_each_work_on_the_grains_counts(tmp_path):
    """A bed that falls on its floor and settles: gravity, walls, contacts and agitation all act, and the sum is what
    motion changed by."""
    effects = ["gravity", "walls", "drag", "granular_pressure", "granular_viscosity", "granular_temperature",
               "friction", "artificial_viscosity", "conduction"]  # fmt: skip
    own = table(effects, periodic=("x",), gravity=(0.0, -9.81), **windows(0.02, 10))
    own["particles"]["bed"]["velocity_m_s"] = [0.0, -0.5]
    run = started(cases.from_table(own), tmp_path)
    while run.time < 0.02:
        run.window()
    sums, summary = run.ledger.sums, run.ledger.summary()
    acted = ("work_of_gravity_J", "work_of_walls_J", "work_of_drag_J", "agitation_J", "collision_heat_J",
             "damping_heat_J", "mechanical_heat_J", "numerical_work_J")  # fmt: skip
    assert all(sums[name] != 0.0 for name in acted), {name: sums[name] for name in acted}
    assert summary["motion_drift_rel"] < 1e-12
