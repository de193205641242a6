"""Lattice numbers, tension, sheets and drops against values that were made apart (swirl_reference.json)."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

from sdph.laws import moving_particles, sheets

# numbers from ../shared/data/swirl_reference.json: closed forms and differential equations in double precision
VALUES = json.loads((Path(__file__).parents[1] / "data" / "swirl_reference.json").read_text())["values"]
KNOWN = {
    "number_density": lambda i: moving_particles.lattice(i["re"], i["dimensions"]).number,
    "lambda": lambda i: moving_particles.lattice(i["re"], i["dimensions"]).spread,
    "tension_coefficient": lambda i: moving_particles.tension_coefficient(i["re"], i["dimensions"]),
    "tension_lattice_pressure": lambda i: moving_particles.cohesion_pressure(i["re"], i["dimensions"]),
    "ballistic_radius": lambda i: sheets.ballistic_radius(i["z_m"], i["r0_m"], i["alpha"]),
    "sheet_radius": lambda i: _meridian(i)[0],
    "sheet_half_angle": lambda i: math.degrees(_meridian(i)[1]),
    "taylor_culick": lambda i: sheets.taylor_culick(i["sigma_N_m"], i["rho_kg_m3"], i["h_m"]),
    "piece_diameter": lambda i: sheets.diameter_of(i["particles"] * i["l0_m"] ** 3, 3),
    "han_length": lambda i: sheets.han_length(
        i["rho_kg_m3"], i["sigma_N_m"], i["h_m"], math.radians(i["half_angle_deg"]), i["rho_gas_kg_m3"], i["U_m_s"]
    ),
}
CASES = [
    pytest.param(begin, value, id=value["name"])
    for value in VALUES
    for begin in KNOWN
    if value["name"].startswith(begin) and value["inputs"].get("r0", 1.5) == 1.5
]


def _meridian(i):
    given = i["r0_m"], i["h0_m"], i["u_m_s"], i["alpha"], i["rho_kg_m3"], i["sigma_N_m"]
    radius, angle = sheets.meridian([i["z_m"]], *given)
    return float(radius[0]), float(angle[0])


@pytest.mark.parametrize(("begin", "value"), CASES)
def test_value(begin, value):
    assert KNOWN[begin](value["inputs"]) == pytest.approx(value["value"], rel=2e-6)


def test_as_many_values_are_tested_as_there_are():
    assert len(CASES) == 36


@pytest.mark.parametrize(
    ("reach", "dimensions", "pull"), [(3.1, 2, 0.784), (4.1, 2, 0.939), (3.1, 3, 0.930), (4.1, 3, 1.011)]
)
def test_a_resting_film_is_pulled_by_less_or_more_than_two_sigma(reach, dimensions, pull):
    """Numbers of swirl-sheet.md, section 5."""
    assert moving_particles.film_pull(reach, dimensions) == pytest.approx(pull, abs=6e-4)


@pytest.mark.parametrize("r", np.linspace(0.3, 3.0, 10))
def test_the_force_is_the_slope_of_the_energy(r):
    """F = -dE/dr, E/C = -cohesion."""
    d = 1e-6
    slope = (moving_particles.cohesion(r + d, 3.1) - moving_particles.cohesion(r - d, 3.1)) / (2.0 * d)
    assert slope == pytest.approx(moving_particles.tension(r, 3.1), abs=1e-8)


def test_beyond_their_reach_nobody_feels_anything():
    assert moving_particles.weight(2.1, 2.1) == moving_particles.tension(3.1, 3.1) == 0.0
    assert moving_particles.cohesion(3.1, 3.1) == 0.0
