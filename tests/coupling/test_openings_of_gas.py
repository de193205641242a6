"""What passes each opening of a vessel, as both gas solvers tell it and as a run tells its means."""

import math

import numpy as np
import pytest
from gas_boxes import box_case
from test_impulses_of_gas import BOTH, running

from sdph.running import openings

SIZE, SPEED, HOT, DENSITY, CP, CP_VAPOUR, SHARE = (0.2, 0.02), 2.0, 400.0, 1.2, 1000.0, 2000.0, 0.02
VAPOUR = {
    "heat_capacity_J_kg_K": CP_VAPOUR, "conductivity_W_m_K": 0.0251, "diffusivity_m2_s": 2e-5,
    "molar_mass_kg_kmol": 18.0, "viscosity_Pa_s": 1.8e-5, "mass_fraction": SHARE,
}  # fmt: skip
DUCT = {
    "in": {"kind": "velocity_inlet", "side": "left", "velocity_m_s": [SPEED, 0.0], "temperature_K": HOT,
           "vapour_mass_fraction": SHARE},
    "out": {"kind": "pressure_outlet", "side": "right", "pressure_Pa": 0.0}, "walls": {"kind": "slip_wall"},
}  # fmt: skip


@BOTH
def test_gas_that_is_warmed_and_moistened_on_its_way_leaves_so(tmp_path, solver):
    """In the steady state as by hand, and the openings share what went through the boundary in all."""
    options = {"boundaries": DUCT, "vapour": VAPOUR}
    with running(solver, tmp_path, SIZE, 0.005, **options) as gas:
        x, case, volume = gas.mesh.centres[:, 0], box_case(SIZE, 0.005, **options), math.prod(SIZE)
        gas.start(None, ("vapour", "heat"))
        given = {"vapour": np.where(x < 0.1, 0.5, 0.0), "heat": np.where(x < 0.1, 2e4, 0.0)}  # half of the volume each
        budgets = [gas.advance(2e-3, given).budget for _ in range(200)]
    found = openings.mean(case, gas.mesh.depth, budgets[-51], budgets[-1], 0.1)
    flow, moist, warmth = DENSITY * SPEED * SIZE[1], 0.25 * volume, 1e4 * volume
    leaves, vapour = flow + moist, flow * SHARE + moist
    energy = flow * (CP + (CP_VAPOUR - CP) * SHARE) * HOT + warmth
    hand = {
        "in_gas_in_kg_s": flow, "in_gas_out_kg_s": 0.0, "out_gas_in_kg_s": 0.0, "out_gas_out_kg_s": leaves,
        "out_gas_out_vapour_mass_fraction": vapour / leaves,
        "out_gas_out_temperature_K": energy / (CP * (leaves - vapour) + CP_VAPOUR * vapour),
    }  # fmt: skip
    print(f"{solver}: " + ", ".join(f"{name} {found[name]:.7g} ({value:.7g})" for name, value in hand.items()))
    for name, value in hand.items():
        assert found[name] == pytest.approx(value, rel=1e-4, abs=1e-12), name
    assert found.keys() - hand.keys() == {"in_gas_out_temperature_K", "in_gas_out_vapour_mass_fraction"}
    assert all(math.isnan(found[name]) for name in found.keys() - hand.keys())
    passed = np.sum(list(budgets[-1].crossed.values()), axis=0)
    assert passed[0] - passed[1] == pytest.approx(budgets[-1].mass_in, rel=1e-9)


@BOTH
def test_an_outlet_that_lets_in_is_told_to(tmp_path, solver):
    """Of two outlets gas goes from the one of the higher pressure to the other."""
    ends = {
        "high": {"kind": "pressure_outlet", "side": "left", "pressure_Pa": 5.0, "temperature_K": HOT},
        "low": {"kind": "pressure_outlet", "side": "right", "pressure_Pa": 0.0}, "walls": {"kind": "slip_wall"},
    }  # fmt: skip
    with running(solver, tmp_path, SIZE, 0.005, boundaries=ends) as gas:
        first = gas.start(None, ()).budget
        for _ in range(20):
            last = gas.advance(5e-3, {}).budget
    case = box_case(SIZE, 0.005, boundaries=ends)
    found = openings.mean(case, gas.mesh.depth, first, last, 0.1)
    assert found["high_gas_in_kg_s"] == pytest.approx(found["low_gas_out_kg_s"], rel=1e-7)
    assert (
        found["high_gas_out_kg_s"] == found["low_gas_in_kg_s"] == 0 and 300.0 < found["low_gas_out_temperature_K"] < HOT
    )
    assert all(math.isnan(value) for value in openings.mean(case, gas.mesh.depth, None, first, 0.0).values())
