"""Burn-off in a closed box: its oxidant runs out as its equation says; mass, species, momentum and heat of both sides;
any window."""

import math

import numpy as np
import pytest
from char_boxes import (
    BOTH,
    DENSITY,
    DIAMETER,
    END,
    GAS,
    HEAT,
    LEFT,
    OXIDANT,
    RATE,
    RATIO,
    SPECIES,
    D,
    boxed,
    finished,
    started,
)  # fmt: skip
from scipy.integrate import solve_ivp

from coupling.gas import Unfinished
from sdph.effects.gas import reaction


def test_a_box_runs_out_of_oxidant_as_its_equation_says(tmp_path):
    """Grains so heavy that they stay as they are strip the gas of a box: its oxidant is m_0 exp(-K t)."""
    case = boxed(count=4, grains={"density_kg_m3": 9e5})
    run = finished(case, tmp_path)
    strip = run.exchange.losing._taken(run.state, run.weights, _stripped(run))[0]
    gas = run.gas_state
    mass, vapour = gas.budget.mass, gas.budget.vapour
    first = run.ledger.first
    assert strip == pytest.approx(-math.log(LEFT) / END, rel=5e-4)  # they shrink a little
    assert vapour == pytest.approx(LEFT * first["gas_vapour_kg"], rel=5e-4)
    burned = (1.0 - vapour / first["gas_vapour_kg"]) * first["gas_vapour_kg"] / RATIO
    assert mass == pytest.approx(first["gas_mass_kg"] + burned, rel=1e-12)


def _stripped(run):
    p, s = run.parameters["reaction"], run.state
    return np.array([reaction.stripped(p, (), s, i, reaction.surface(p, 1100.0), 0.0) for i in range(len(s.x))])


def errors(folder, **more):
    """Mass burned in `boxed` in 10, 20 and 40 windows, less that of an integration of the two equations, over it."""
    return [_burned(folder / str(n), n, **more) for n in (10, 20, 40)]


def _burned(folder, count):
    """As much solid as the oxidant burns: both run low."""
    folder.mkdir()
    case = boxed(count=count, vapour=SPECIES | {"mass_fraction": 0.3})
    run = finished(case, folder)
    first = run.ledger.first
    volume, alpha_p = 4e-4, first["particle_mass_kg"] / DENSITY / 4e-4
    number = alpha_p * volume / (math.pi / 6.0 * DIAMETER**3)

    def both(t, y):
        d, oxidant = y
        k = 1.0 / (1.0 / RATE + d / (2.0 * D))
        content = oxidant / (volume * (1.0 - number * math.pi / 6.0 * d**3 / volume))
        taken = number * math.pi * d * d * k * content
        return [-2.0 * k * content / (RATIO * DENSITY), -taken]

    start = [DIAMETER, first["gas_vapour_kg"]]
    d = solve_ivp(both, (0.0, END), start, rtol=1e-11, atol=1e-18).y[0, -1]
    expected = first["particle_mass_kg"] * (1.0 - (d / DIAMETER) ** 3)
    return (run.ledger.sums["reacted_kg"] - expected) / expected


def test_the_order_in_the_window_is_the_second_at_one_temperature(tmp_path):
    """Windows halved quarter the error, of grains and oxidant that both change much."""
    coarse, middle, fine = errors(tmp_path)
    print("burned in 10, 20, 40 windows, off by", coarse, middle, fine)
    assert abs(fine) < 1e-4
    assert coarse / middle == pytest.approx(4.0, rel=0.1) and middle / fine == pytest.approx(4.0, rel=0.1)


@pytest.mark.parametrize("more", [
    {},
    {"reaction": {"gas_share": 0.3}},
    {"reaction": {"film": False}},
    {"gas": {"equation_of_state": "operating"}},
    {"grains": {"diameter_std_mm": 0.03}},
    {"particles": {"bed": {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.01, 0.01], "temperature_K": 900.0}}},
    {"resolution": {"cell_mm": 5.0}},
])  # fmt: skip
def test_what_grains_lose_and_use_up_the_gas_gets(tmp_path, more):
    """Mass, species and energy of both sides over a run in a closed box, to 1e-10 of what was exchanged."""
    run = finished(_hot(more), tmp_path)
    summary = run.ledger.summary()
    assert summary["reacted_kg"] > 0.05 * run.ledger.first["gas_vapour_kg"] / RATIO
    assert summary["reaction_heat_J"] == pytest.approx(HEAT * summary["reacted_kg"], rel=1e-12)
    for name in ("exchange_mass_mismatch_rel", "exchange_energy_mismatch_rel", "species_drift_rel", "energy_drift_rel"):
        assert summary[name] <= 1e-10, name
    assert summary["particle_mass_drift_rel"] <= 1e-12 and summary["mass_drift_rel"] <= 1e-12
    gone = run.ledger.first["gas_vapour_kg"] - run.ledger.last["gas_vapour_kg"]
    assert gone == pytest.approx(RATIO * summary["reacted_kg"], rel=1e-10)
    assert run.state.temperature.max() > 1100.0


def _hot(more):
    given = {key: dict(value) for key, value in more.items()}
    given["reaction"] = {"heat_J_kg": HEAT} | given.get("reaction", {})
    if "particles" in given:
        given["particles"]["bed"]["volume_fraction"] = 2e-4
    return boxed(effects=BOTH, **given)


def test_grains_that_burn_up_hand_their_heat_on(tmp_path):
    """More oxidant than they need: nothing is left of them, and all of the heat is in the gas."""
    case = boxed(
        count=5, effects=BOTH, vapour=SPECIES | {"mass_fraction": 0.9}, grains={"density_kg_m3": 120.0},
        reaction={"heat_J_kg": HEAT},
    )  # fmt: skip
    run = finished(case, tmp_path)
    summary = run.ledger.summary()
    assert len(run.state.x) == 0
    assert summary["reacted_kg"] == pytest.approx(run.ledger.first["particle_mass_kg"], rel=1e-12)
    assert summary["energy_drift_rel"] <= 1e-10 and summary["species_drift_rel"] <= 1e-10


def test_momentum_of_what_was_solid_goes_along(tmp_path):
    bed = {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.02, 0.02], "volume_fraction": 1e-4}
    case = boxed(particles={"bed": bed | {"temperature_K": 1100.0, "velocity_m_s": [0.3, -0.2]}})
    run = started(case, tmp_path)
    handed = run.hand(0.01)
    volumes, burned = run.exchange.volumes, handed.loss.mass.sum()
    momentum = (handed.terms["momentum", "reaction"] * volumes[:, None]).sum(axis=0)
    np.testing.assert_allclose(0.01 * momentum, burned * np.array([0.3, -0.2, 0.0]), rtol=1e-12, atol=1e-30)
    assert (handed.sources["vapour"] * volumes).sum() * 0.01 == pytest.approx(-RATIO * burned, rel=1e-12)
    assert (handed.sources["carrier"] * volumes).sum() * 0.01 == pytest.approx((1.0 + RATIO) * burned, rel=1e-12)


def test_no_window_takes_more_than_a_cell_holds(tmp_path):
    """Grains that strip their cell a hundred times over in a window leave nothing, and not less."""
    case = boxed(count=1, reaction={"rate_m_s": 1e3, "film": False}, grains={"density_kg_m3": 9e5})
    run = started(case, tmp_path)
    run.clock.limits = {"largest": END}
    run.window()
    oxidant = run.gas_state.fields["vapour_mass_fraction"]
    assert -1e-12 < oxidant.min() <= oxidant.max() < 1e-3 * OXIDANT
    assert run.ledger.summary()["species_drift_rel"] <= 1e-10


def test_a_gas_that_has_less_than_is_used_up_says_so(tmp_path):
    run = started(boxed(), tmp_path)
    handed = run.hand(0.01)
    more = handed.sources | {"vapour": -np.full(1, 0.2 * GAS / 0.01)}
    with pytest.raises(Unfinished, match="less vapour than"):
        run.gas.advance(0.01, more)


def test_windows_take_a_fifth_of_the_oxidant(tmp_path):
    """The limit is there from the start, is obeyed and has the reaction's name."""
    run = started(boxed(count=1, grains={"density_kg_m3": 9e5}), tmp_path)
    before = run.gas_state.budget.vapour
    for _ in range(2):
        run.window()
        assert run.clock.limit == "reaction"
        taken, before = before - run.gas_state.budget.vapour, run.gas_state.budget.vapour
        assert 0.1 < taken / run.ledger.first["gas_vapour_kg"] < 0.2
