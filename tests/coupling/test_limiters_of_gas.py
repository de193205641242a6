"""What limiters of the gas take in a step (docs/limiters.md), each against a hand calculation. Both solvers."""

import numpy as np
import pytest
from gas_boxes import AIR, box, total
from test_impulses_of_gas import BOTH, ENDS, running

RHO = AIR["density_kg_m3"]
SLIP = {"walls": {"kind": "slip_wall"}}
CHANNEL = {
    "in": {"kind": "velocity_inlet", "side": "left", "velocity_m_s": [0.5, 0.0]},
    "out": {"kind": "pressure_outlet", "side": "right", "pressure_Pa": 0.0},
} | SLIP  # fmt: skip
EMBEDDED = {"gas_box_rel", "gas_mass_left_rel"}  # columns of each solver
OPENFOAM = EMBEDDED | {"gas_cut_rel", "gas_misfit_kg_m_s", "gas_pressure_unsettled_rel", "gas_splitting_rel"}


@BOTH
def test_density_of_a_box_that_grains_squeeze(tmp_path, solver):
    """The mass stays, so that its density rises as the room falls."""
    with running(solver, tmp_path, (0.04, 0.04), 0.005) as gas:
        x = gas.mesh.centres[:, 0]
        first = gas.start(None, ("alpha_g",))
        alpha = 1.0 - 5.0 * x
        state = gas.advance(1e-3, {"alpha_g": alpha})
        then = gas.advance(1e-3, {"alpha_g": alpha})
    assert first.budget.held == dict.fromkeys(EMBEDDED if solver == "embedded" else OPENFOAM, 0.0)
    assert state.budget.held["gas_box_rel"] == pytest.approx(1.0 / alpha.mean() - 1.0, rel=1e-9)
    assert then.budget.held["gas_box_rel"] == pytest.approx(1.0 / alpha.mean() - 1.0, rel=1e-9)


@BOTH
def test_mass_that_the_pressure_solver_leaves(tmp_path, solver):
    """The worst cell's density, in a box that is open, against the gas's own."""
    with running(solver, tmp_path, (0.04, 0.04), 0.005, boundaries=ENDS | SLIP) as gas:
        x, y = gas.mesh.centres[:, 0], gas.mesh.centres[:, 1]
        gas.start(None, ("alpha_g",))
        state = gas.advance(1e-3, {"alpha_g": 1.0 - 0.3 * np.exp(-((x - 0.02) ** 2 + (y - 0.01) ** 2) / 1e-4)})
    left = np.abs(state.fields["density"] / RHO - 1.0).max()
    print(f"{solver}: mass left {left:.1e}")
    assert 0.0 < left < 1e-5
    assert state.budget.held["gas_mass_left_rel"] == pytest.approx(left, rel=1e-4, abs=1e-14)
    assert state.budget.held["gas_box_rel"] == 0.0


@pytest.mark.openfoam
@pytest.mark.parametrize("courant", [0.5, 2.5])
def test_limited_flux_that_long_steps_cut(tmp_path, courant):
    with box(tmp_path, (0.1, 0.02), 0.005, boundaries=CHANNEL) as gas:
        gas.start(None, ("heat",))
        for _ in range(3):
            state = gas.advance(courant * 0.005 / 0.5, {"heat": np.ones(len(gas.mesh.volumes))})
    assert state.budget.courant == pytest.approx(courant, rel=1e-3)
    cut = 1.0 - 1.0 / state.budget.courant if courant > 1.0 else 0.0
    assert state.budget.held["gas_cut_rel"] == pytest.approx(cut, rel=1e-6)


@pytest.mark.openfoam
def test_momentum_that_the_predictor_takes_out(tmp_path):
    """Room that falls at once everywhere: the fluxes of the step before do not know, and what they leave in a cell
    is the fall times the momentum there."""
    fall, dt = 0.1, 1e-2
    with box(tmp_path, (0.1, 0.02), 0.005, boundaries=CHANNEL) as gas:
        whole = np.ones(len(gas.mesh.volumes))
        gas.start(whole, ("alpha_g",))
        for _ in range(3):
            steady = gas.advance(dt, {"alpha_g": whole})
        state = gas.advance(dt, {"alpha_g": (1.0 - fall) * whole})
    taken = fall * RHO * total(gas, np.linalg.norm(state.fields["velocity"], axis=1))
    assert steady.budget.held["gas_misfit_kg_m_s"] < 1e-6 * taken
    assert state.budget.held["gas_misfit_kg_m_s"] == pytest.approx(taken, rel=1e-6)
