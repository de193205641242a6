"""Grains of two materials in gas: each falls at its own speed, warms by its own heat capacity, and what the gas gets is
the opposite."""

import numpy as np
import pytest
from grain_boxes import DENSITY, VISCOSITY, Row, go, several, started, windows
from scipy.optimize import brentq

from sdph.laws import drag, heat

SAND_CAPACITY = 1000.0  # J/kg/K, of all grains of a box
SAND, CHAR = {"diameter_mm": 0.1}, {"diameter_mm": 0.15, "density_kg_m3": 1000.0, "heat_capacity_J_kg_K": 2500.0}
WHOLE = {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.06, 0.06], "temperature_K": 300.0}


class Still(Row):
    """Gas at rest, whatever happens."""

    def advance(self, dt, sources):
        state = super().advance(dt, sources)
        self.velocity[:] = 0.0
        state.fields["velocity"][:] = 0.0
        return state


def mixed(effects, temperatures=(300.0, 300.0), speeds=(0.0, 0.0), **more):
    own = zip(("sand", "char"), (0.03, 0.02), temperatures, speeds)
    parts = {
        name: WHOLE
        | {"material": name, "volume_fraction": alpha_p, "temperature_K": warmth, "velocity_m_s": [speed, 0.0]}
        for name, alpha_p, warmth, speed in own
    }
    return several(effects, parts, {"sand": SAND, "char": CHAR}, **more)


def test_each_falls_at_its_own_speed(tmp_path):
    """Weight against drag at the material's own Reynolds number and the voidage of all grains."""
    sections = windows(0.5, 1000)
    sections["coupling"] |= {"one_way": True}
    case = mixed(["drag", "gravity"], gravity=(0.0, -9.81), **sections)
    run = go(started(case, tmp_path, Still(case, alpha_g=1.0)))
    s = run.state

    def pull(v, density, diameter):
        return drag.gidaspow(0.05, v, diameter, 1.225, VISCOSITY) / density * v - 9.81

    np.testing.assert_allclose(s.density / s.grain_density, 0.05, rtol=0.02)
    for number, (density, diameter) in enumerate(((DENSITY, 1e-4), (1000.0, 1.5e-4))):
        slip = brentq(pull, 1e-6, 10.0, args=(density, diameter))
        own = s.material == number
        assert -s.v[own].mean() == pytest.approx(slip, rel=1e-3)
        assert np.ptp(s.v[own]) < 0.01 * slip


def test_each_warms_by_its_own_heat_capacity_and_the_gas_gets_the_opposite(tmp_path):
    case = mixed(["drag", "heat"], temperatures=(350.0, 320.0), speeds=(0.5, -0.3), **windows(1e-3, 2))
    run = started(case, tmp_path)
    s = run.state
    before = s.mass * s.grain_capacity * s.temperature
    momentum = float(s.mass @ s.u)
    go(run)
    after = run.state.mass * run.state.grain_capacity * run.state.temperature
    sums, told = run.ledger.sums, run.ledger.summary()
    assert sums["heat_to_particles_J"] == pytest.approx(float((after - before).sum()), rel=1e-9) != 0.0
    assert float(run.state.mass @ run.state.u) - momentum == pytest.approx(
        sums["impulse_to_particles_x_kg_m_s"], rel=1e-9
    )
    assert told["exchange_energy_mismatch_rel"] < 1e-12 and told["exchange_momentum_mismatch_rel"] < 1e-12
    totals = run.grains.totals()
    assert totals["particle_energy_J"] == pytest.approx(float(after.sum()), rel=1e-14)


def test_the_gas_leaves_room_by_the_volume_of_each(tmp_path):
    run = started(mixed(["drag"], **windows(1e-3, 1)), tmp_path)
    np.testing.assert_allclose(run._alpha_g(), 0.95, rtol=1e-12)


def test_history_tells_of_each(tmp_path):
    run = started(mixed(["drag", "gravity"], gravity=(0.0, -9.81), **windows(1e-3, 1)), tmp_path)
    row = run.row()
    assert row["material_sand_kg"] == pytest.approx(0.03 * DENSITY * 0.06**2, rel=1e-12)
    assert row["material_char_height_m"] == pytest.approx(0.03, rel=0.1)
    assert row["material_char_rise_m_s"] == 0.0


def test_a_gradient_of_pressure_pushes_each_by_its_own_density(tmp_path):
    sections = windows(1e-3, 1)
    sections["coupling"] |= {"one_way": True}
    case = mixed(["gas_pressure"], speeds=(0.1, 0.1), **sections)
    run = go(started(case, tmp_path, Row(case, alpha_g=1.0, gradient=(-500.0, 0.0, 0.0))))
    s = run.state
    np.testing.assert_allclose(s.u - 0.1, 1e-3 * 500.0 / s.grain_density, rtol=1e-10)


def test_nozzles_give_grains_of_their_material(tmp_path):
    """Mass by the density of each, and their heat as it comes in."""
    slot = {"shape": "slot", "width_m": 0.02, "direction": [1.0, 0.0], "speed_m_s": 1.0, "volume_fraction": 0.2}
    nozzles = {
        name: slot | {"centre_m": [0.005, y], "temperature_K": warmth, "material": name}
        for name, y, warmth in (("sand", 0.015, 320.0), ("char", 0.045, 280.0))
    }
    case = several(
        ["inflow", "outflow", "drag", "heat"], {}, {"sand": SAND, "char": CHAR}, periodic=(), nozzles=nozzles,
        boundaries={"sides": {"kind": "pressure_outlet", "pressure_Pa": 0.0}}, **windows(0.02, 8),
    )  # fmt: skip
    run = go(started(case, tmp_path))
    s = run.state
    for number, grains in enumerate(case.kinds):
        own = s.nozzle == number + 1
        assert own.any() and (s.material[own] == number).all()
        for name, value in zip(("grain_density", "grain_capacity", "grain_conductivity"), grains.of_particles):
            assert (getattr(s, name)[own] == value).all()
        assert (s.diameter[own] == grains.diameter).all()
        np.testing.assert_allclose(s.mass[own], 0.2 * grains.density * 0.005**2, rtol=1e-12)
    assert run.ledger.sums["injected_kg"] > 0.0
    came = {number: float(s.mass[(s.nozzle == number + 1) & (s.kind == 0)].sum()) for number in (0, 1)}
    brought = came[0] * SAND_CAPACITY * 320.0 + came[1] * 2500.0 * 280.0
    assert run.ledger.sums["injected_J"] == pytest.approx(brought, rel=1e-12)


def test_each_takes_the_temperature_of_the_gas_in_its_own_time(tmp_path):
    """exp(-eps t/(alpha_p rho_p c_p)) of the material's own rho_p, c_p and d, in windows as long as that time."""
    run = go(started(mixed(["heat"], temperatures=(400.0, 400.0), **windows(0.2, 2)), tmp_path))
    s, nusselt = run.state, heat.gunn(0.95, 0.0, heat.prandtl_number(VISCOSITY, 1006.43, 0.0242))
    for number, (density, capacity, diameter) in enumerate(((DENSITY, SAND_CAPACITY, 1e-4), (1000.0, 2500.0, 1.5e-4))):
        rate = heat.exchange_geometric(0.95, nusselt, 0.0242, diameter) / (density * capacity)
        left = (s.temperature[s.material == number] - 300.0) / 100.0
        assert 0.05 < left.mean() < 0.5
        np.testing.assert_allclose(np.log(left), -0.2 * rate, rtol=0.01)
