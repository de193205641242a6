"""Vapour in sdphGasFoam against exact solutions: its mass, temperature and diffusion."""

import numpy as np
import pytest
from gas_boxes import box, total
from gas_columns import CP, OPEN, RHO, gas_volume

from coupling.gas import Unfinished

VAPOUR = {
    "molar_mass_kg_kmol": 142.284, "diffusivity_m2_s": 3.79e-6, "heat_capacity_J_kg_K": 2470.0,
    "conductivity_W_m_K": 0.0178, "viscosity_Pa_s": 7e-6,
}  # fmt: skip


def test_vapour_mass(tmp_path):
    """Vapour set free in still gas of a box open all round: what is there and what left is what was given, within 0.01
    %."""
    dt, steps = 1e-3, 40
    with box(tmp_path, (0.1, 0.1), 0.005, boundaries=OPEN, vapour=VAPOUR) as gas:
        x, y = gas.mesh.centres[:, 0], gas.mesh.centres[:, 1]
        vapour = np.exp(-((x - 0.05) ** 2 + (y - 0.05) ** 2) / 0.01**2) * 5.0
        names = ("vapour", "momentum", "heat")
        start = gas.start(None, names)
        warm = {"vapour": vapour, "momentum": np.zeros((len(x), 3)), "heat": vapour * 2470.0 * 310.0}
        for _ in range(steps):
            state = gas.advance(dt, warm)
    given = dt * steps * total(gas, vapour)
    held = total(gas, state.fields["density"] * state.fields["vapour_mass_fraction"])
    assert state.budget.vapour == pytest.approx(held, rel=1e-12)
    error = (state.budget.vapour - state.budget.vapour_in - given) / given
    print(f"vapour mass error {error:.1e}")
    assert abs(error) < 1e-4
    assert state.budget.mass - start.budget.mass == pytest.approx(state.budget.mass_in + given, rel=1e-10)
    gained = state.budget.energy - start.budget.energy - state.budget.energy_in - state.budget.pressure_work
    assert gained == pytest.approx(given * 2470.0 * 310.0, rel=1e-9)
    assert state.fields["vapour_mass_fraction"].min() >= 0.0 and state.fields["vapour_mass_fraction"].max() < 1.0


@pytest.mark.parametrize("equation", ["constant", "operating"])
def test_vapour_of_the_gas_temperature_changes_no_temperature(tmp_path, equation):
    """Convection and diffusion of a vapour of another heat capacity: gas and vapour of 300 K stay at 300 K."""
    with box(
        tmp_path,
        (0.1, 0.1),
        0.005,
        boundaries=OPEN,
        vapour=VAPOUR,
        equation_of_state=equation,
        molar_mass_kg_kmol=28.96,
    ) as gas:
        x, y = gas.mesh.centres[:, 0], gas.mesh.centres[:, 1]
        vapour = np.exp(-((x - 0.05) ** 2 + (y - 0.05) ** 2) / 0.01**2) * 5.0
        gas.start(None, ("vapour", "heat"))
        for _ in range(20):
            state = gas.advance(1e-3, {"vapour": vapour, "heat": vapour * 2470.0 * 300.0})
    assert state.fields["vapour_mass_fraction"].max() > 0.01
    # on gas of constant density the pressure works, by the order of U^2/cp [K]
    works = np.abs(state.fields["velocity"]).max() ** 2 / CP if equation == "constant" else 300.0 * 1e-10
    assert works < 1e-3 and state.fields["temperature"] == pytest.approx(300.0, abs=works)


def test_vapour_diffuses(tmp_path):
    """Slab of vapour spreading in still gas: variance grows by 2 D t."""
    with box(tmp_path, (0.2, 0.005), 0.0025, vapour=VAPOUR | {"diffusivity_m2_s": 1e-3}) as gas:
        x = gas.mesh.centres[:, 0]
        source = np.exp(-((x - 0.1) ** 2) / (2 * 0.01**2)) * 1e-4
        gas.start(None, ("vapour",))
        state = gas.advance(1e-4, {"vapour": source})
        spread = [variance(x, state)]
        for _ in range(100):
            state = gas.advance(1e-4, {"vapour": np.zeros_like(x)})
        spread.append(variance(x, state))
    assert spread[1] - spread[0] == pytest.approx(2 * 1e-3 * 1e-2, rel=5e-3)


def variance(x, state):
    weight = state.fields["vapour_mass_fraction"]
    mean = (weight * x).sum() / weight.sum()
    return (weight * (x - mean) ** 2).sum() / weight.sum()


def test_closed_box_of_constant_density_takes_the_vapour(tmp_path):
    """Nothing can leave: the gas gets denser everywhere alike, by just the mass of the vapour."""
    with box(tmp_path, (0.05, 0.05), 0.005, vapour=VAPOUR) as gas:
        vapour = np.where(gas.mesh.centres[:, 0] < 0.025, 2.0, 0.0)
        start = gas.start(None, ("vapour",))
        for _ in range(10):
            state = gas.advance(1e-3, {"vapour": vapour})
    given = 1e-2 * total(gas, vapour)
    assert state.budget.mass - start.budget.mass == pytest.approx(given, rel=1e-11)
    assert state.fields["density"] == pytest.approx(RHO + given / gas_volume(gas), rel=1e-6)


@pytest.mark.parametrize("equation", ["constant", "operating"])
def test_vapour_that_is_used_up(tmp_path, equation):
    """What a reaction takes of it and gives of the rest of the gas, at 300 K, in an open box: mass, vapour and energy
    are those given, no temperature changes but by the works, and none is left where nearly all is taken."""
    dt, steps, more = 1e-3, 5, {"equation_of_state": equation}
    dry = {"all": OPEN["all"] | {"vapour_mass_fraction": 0.0}}
    with box(tmp_path, (0.1, 0.1), 0.005, boundaries=dry, vapour=VAPOUR | {"mass_fraction": 0.1}, **more) as gas:
        x = gas.mesh.centres[:, 0]
        start = gas.start(None, ("vapour", "carrier", "heat"))
        used, totals, fastest = 0.0, 0.0, 0.0
        state = start
        for _ in range(steps):
            there = state.fields["density"] * state.fields["vapour_mass_fraction"]
            taken = (0.1 + 0.899 * (x > 0.08)) * there / dt
            heat = (1.4 * CP - 2470.0) * taken * 300.0
            state = gas.advance(dt, {"vapour": -taken, "carrier": 1.4 * taken, "heat": heat})
            used, totals = used + dt * total(gas, taken), totals + dt * total(gas, heat)
            fastest = max(fastest, np.abs(state.fields["velocity"]).max())
    now, then = state.budget, start.budget
    assert now.vapour - then.vapour == pytest.approx(now.vapour_in - used, rel=1e-9)
    assert now.mass - then.mass == pytest.approx(now.mass_in + 0.4 * used, rel=1e-9, abs=1e-12 * then.mass)
    gained = now.energy - then.energy - now.energy_in - now.pressure_work
    assert gained == pytest.approx(totals, rel=1e-8, abs=1e-11 * then.energy)
    assert state.fields["vapour_mass_fraction"].min() > -1e-12
    works = fastest**2 / CP if equation == "constant" else 300.0 * 1e-10
    assert works < 1e-3 and state.fields["temperature"] == pytest.approx(300.0, abs=works)


def test_more_vapour_than_there_is_cannot_be_used_up(tmp_path):
    with box(tmp_path, (0.1, 0.1), 0.02, boundaries=OPEN, vapour=VAPOUR | {"mass_fraction": 0.1}) as gas:
        start = gas.start(None, ("vapour", "carrier"))
        taken = 1.01 * 0.1 * start.fields["density"] / 1e-3
        with pytest.raises(Unfinished, match="less vapour than"):
            gas.advance(1e-3, {"vapour": -taken, "carrier": taken})
        again = gas.retreat()
        np.testing.assert_array_equal(again.fields["vapour_mass_fraction"], start.fields["vapour_mass_fraction"])
        state = gas.advance(1e-3, {"vapour": -0.5 * taken, "carrier": 0.5 * taken})
    assert state.fields["vapour_mass_fraction"].max() < 0.06
