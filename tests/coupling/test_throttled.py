"""A gas that is throttled through a cold bed keeps its temperature: the heat of drag and the work of the pressure
cancel, as for any gas with h = cp T. Both gas solvers; a bed whose drag jumps from cell to cell too."""

import numpy as np
import pytest
from gas_boxes import AIR, box, box_case

from coupling.embedded import EmbeddedGas

SIZE, CELL, SPEED, ALPHA_P, DIAMETER = (0.04, 0.4), 0.01, 0.5, 0.6, 0.5e-3
COLUMN = {
    "below": {"kind": "velocity_inlet", "side": "bottom", "velocity_m_s": [0.0, SPEED], "temperature_K": 300.0},
    "above": {"kind": "pressure_outlet", "side": "top", "pressure_Pa": 0.0},
    "walls": {"kind": "slip_wall"},
}


def throttled(gas, windows=400, dt=5e-3):
    """Bed in the middle of the column, held, without heat of its own; the gas gets the heat of its drag a window later,
    as in a run. Warmest and coldest gas [K] in the end, and what the drag would have warmed it by [K]."""
    y = gas.mesh.centres[:, 1]
    alpha = np.where((y > 0.1) & (y < 0.3), 1.0 - ALPHA_P, 1.0)
    beta = np.where(alpha < 1.0, 150.0 * ALPHA_P**2 * AIR["viscosity_Pa_s"] / (0.4 * DIAMETER**2), 0.0)
    state = gas.start(alpha, ("momentum_coefficient", "momentum", "heat"))
    for _ in range(windows):
        drag = {"momentum_coefficient": beta, "momentum": np.zeros((len(beta), 3))}
        state = gas.advance(dt, drag | {"heat": -state.fields["power"]})
    heat = -(state.fields["power"] * gas.mesh.volumes).sum() / gas.mesh.depth
    flow = AIR["density_kg_m3"] * SPEED * SIZE[0] * AIR["heat_capacity_J_kg_K"]
    temperature = state.fields["temperature"]
    print(f"T from {temperature.min():.5f} to {temperature.max():.5f} K; drag alone would warm by {heat / flow:.3f} K")
    return temperature, heat / flow


def check(temperature, alone):
    assert alone > 4.0
    assert np.abs(temperature - 300.0).max() < 0.01


def test_throttled_embedded_gas():
    check(*throttled(EmbeddedGas(box_case(SIZE, CELL, boundaries=COLUMN))))


@pytest.mark.openfoam
def test_throttled_openfoam_gas(tmp_path):
    with box(tmp_path, SIZE, CELL, boundaries=COLUMN) as gas:
        check(*throttled(gas))


FAST = 20.0
NOZZLE = COLUMN | {"below": COLUMN["below"] | {"velocity_m_s": [0.0, FAST]}}


def narrowed(gas, dt):
    """Gas that the room among grains narrows and widens again, smoothly and without drag: what the narrowest place has
    cooled it by, and what u^2/(2 cp) has grown by [K]."""
    y, cp = gas.mesh.centres[:, 1], AIR["heat_capacity_J_kg_K"]
    alpha = 1.0 - 0.5 * np.exp(-(((y - 0.5 * SIZE[1]) / (0.15 * SIZE[1])) ** 2))
    state = gas.start(alpha, ("alpha_g",))
    for _ in range(round(0.06 / dt)):  # three times through
        state = gas.advance(dt, {"alpha_g": alpha})
    narrow = np.argmin(alpha)
    faster = 0.5 * (state.fields["velocity"][narrow, 1] ** 2 - FAST**2) / cp
    print(f"colder by {300.0 - state.fields['temperature'][narrow]:.4f} K, u^2/(2 cp) higher by {faster:.4f} K")
    return 300.0 - state.fields["temperature"][narrow], faster


def check_narrowed(colder, faster):
    """h + u^2/2 stays. 5 % is our choice: twelve cells over the throat, and upwind temperatures lag by part of one."""
    assert faster > 0.5
    assert colder == pytest.approx(faster, rel=0.05)


def test_narrowed_embedded_gas():
    check_narrowed(*narrowed(EmbeddedGas(box_case(SIZE, CELL, boundaries=NOZZLE)), 1e-4))


@pytest.mark.openfoam
@pytest.mark.parametrize("dt", [1e-4, 1e-3])
def test_narrowed_openfoam_gas(dt, tmp_path):
    """A window of 1 ms has a Courant number of 4, and starts from rest."""
    with box(tmp_path, SIZE, CELL, boundaries=NOZZLE) as gas:
        check_narrowed(*narrowed(gas, dt))
