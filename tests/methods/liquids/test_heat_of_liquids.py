"""Heat in liquids and bodies: two slabs, a cylinder under flux, nothing lost; values of gel_reference.json."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

from sdph.case import read as cases
from sdph.running.alone import Alone
from sdph.running.together import Together

FILE = Path(__file__).parents[2] / "data" / "gel_reference.json"
VALUES = {value["name"]: value for value in json.loads(FILE.read_text())["values"]}
SPACING = 1.25e-5  # m


def table(**own) -> dict:
    return {
        "dimensions": 2, "effects": ["density_diffusion", "liquid_heat"],
        "run": {"end_time_s": 1e-5, "output_interval_s": 1e-5},
        "domain": {"size_m": [2e-3, 2e-3], "gravity_m_s2": [0.0, 0.0]},
        "resolution": {"spacing_mm": 1e3 * SPACING, "smoothing_ratio": 1.3},
        "liquid": {"density_kg_m3": 1500.0, "sound_speed_m_s": 100.0},
        "liquid_heat": {"conductivity_W_m_K": 0.5, "heat_capacity_J_kg_K": 5000.0, "temperature_K": 500.0},
    } | own  # fmt: skip


def test_a_cylinder_under_flux_warms_as_the_series_says(tmp_path):
    """Within 1 %: 0.4 % at the rim, 0.04 % in the middle; without the lattice's share 2 and 6 %."""
    centre, rim = VALUES["cylinder_flux_r0_t0.5"], VALUES["cylinder_flux_r0.0005_t0.5"]
    given = rim["inputs"]
    own = table(
        pools={"gel": {"shape": "ring", "centre_m": [1e-3, 1e-3], "radius_m": given["R"], "inner_radius_m": 1e-9}}
    )
    own["liquid_heat"] |= {"flux_W_m2": given["q"]}
    stepper = Alone(cases.from_table(own), tmp_path / "ledger.csv").stepper
    stepper.heat.advance(given["t"])
    s, rise = stepper.state, stepper.state.temperature - 500.0
    r = np.hypot(s.x - 1e-3, s.y - 1e-3)
    outer = rise[r > given["R"] - SPACING].mean() + 0.5 * SPACING * given["q"] / given["k"]
    assert rise[r < 2.0 * SPACING].mean() == pytest.approx(centre["expected"], rel=0.01)
    assert outer == pytest.approx(rim["expected"], rel=0.01)
    assert stepper.heat.came == pytest.approx(given["q"] * 2.0 * math.pi * given["R"] * given["t"], rel=1e-12)
    assert stepper.heat.summary()["heat_drift_rel"] < 1e-12


def test_two_slabs_meet_at_the_temperature_of_their_effusivities(tmp_path):
    """A liquid and a body of another conductivity, within 1 % of the step between them."""
    contact, deep = VALUES["slabs_contact_T"], VALUES["slabs_T_x"]
    own, wide, long = contact["inputs"], 9 * SPACING, 32 * SPACING
    given = table(
        pools={"hot": {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [long, wide]}},
        bodies={"cold": {"shape": "box", "lower_m": [long, 0.0], "upper_m": [2.0 * long, wide]}},
        solid={"density_kg_m3": own["rho2"], "youngs_modulus_Pa": 1e6, "poisson_ratio": 0.3},
    )  # fmt: skip
    given["liquid_heat"] |= {"body_conductivity_W_m_K": own["k2"], "body_heat_capacity_J_kg_K": own["cp2"]}
    stepper = Together(cases.from_table(given), tmp_path / "ledger.csv").stepper
    s, middle = stepper.state, np.abs(stepper.state.y - 0.5 * wide) < SPACING
    s.temperature[:] = np.where(s.x < long, own["T1"], own["T2"])
    stepper.heat.advance(deep["inputs"]["t"])
    step = own["T1"] - own["T2"]

    def at(x):
        order = np.argsort(s.x[middle])
        return np.interp(x, s.x[middle][order], s.temperature[middle][order])

    left, right = (float(at(long + side * 0.5 * SPACING)) for side in (-1.0, 1.0))
    face = (own["k1"] * left + own["k2"] * right) / (own["k1"] + own["k2"])  # of one flux on both sides
    assert face == pytest.approx(contact["expected"], abs=0.01 * step)
    assert float(at(long + deep["inputs"]["x"])) == pytest.approx(deep["expected"], abs=0.01 * step)
    assert (
        abs(stepper.heat.capacity @ (s.temperature - own["T2"]) / (stepper.heat.capacity @ (s.x < long)) - step)
        < 1e-9 * step
    )
