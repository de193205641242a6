"""Lattice numbers, tension, sheets and drops against values that were made apart (swirl_reference.json)."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

from sdph.effects.liquids.free_energy_tension import FreeEnergyTension
from sdph.laws import moving_particles, sheets
from sdph.schema import fields

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
    "sheet_thickness": lambda i: float(sheets.thickness(i["z_m"], i["r0_m"], i["h0_m"], i["alpha"])),
    "distance_where_thickness": lambda i: sheets.distance_of_thickness(i["h_m"], i["r0_m"], i["h0_m"], i["alpha"]),
    "rayleigh_plateau_k": lambda i: sheets.rayleigh_plateau(i["k"]),
    "piece_diameter": lambda i: sheets.diameter_of(i["particles"] * i["l0_m"] ** 3, 3),
    "discharge_coefficient": lambda i: sheets.discharge_coefficient(i["X"]),
    "geometric_characteristic": lambda i: sheets.geometric_characteristic(i["X"]),
    "half_angle_inviscid": lambda i: math.degrees(sheets.inviscid_half_angle(i["X"])),
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
    assert len(CASES) == 54


@pytest.mark.parametrize(
    ("reach", "dimensions", "pull"), [(3.1, 2, 0.784), (4.1, 2, 0.939), (3.1, 3, 0.930), (4.1, 3, 1.011)]
)
def test_a_resting_film_is_pulled_by_less_or_more_than_two_sigma(reach, dimensions, pull):
    """Numbers of swirl-sheet.md, section 5."""
    assert moving_particles.film_pull(reach, dimensions) == pytest.approx(pull, abs=6e-4)


@pytest.mark.parametrize("dimensions", [2, 3])
def test_at_all_reaches_that_a_case_may_have_tension_pulls(dimensions):
    """C above 0, a film that is pulled together by about 2 sigma, and a lattice that holds together."""
    _, kind = fields(FreeEnergyTension)["reach"]
    for reach in np.linspace(kind.least, kind.most, 40).tolist():
        assert moving_particles.tension_coefficient(reach, dimensions) > 0.0
        assert 0.6 < moving_particles.film_pull(reach, dimensions) < 1.2
        assert moving_particles.cohesion_pressure(reach, dimensions) < 0.0


@pytest.mark.parametrize("r", np.linspace(0.3, 3.0, 10))
def test_the_force_is_the_slope_of_the_energy(r):
    """F = -dE/dr, E/C = -cohesion."""
    d = 1e-6
    slope = (moving_particles.cohesion(r + d, 3.1) - moving_particles.cohesion(r - d, 3.1)) / (2.0 * d)
    assert slope == pytest.approx(moving_particles.tension(r, 3.1), abs=1e-8)


def test_beyond_their_reach_nobody_feels_anything():
    assert moving_particles.weight(2.1, 2.1) == moving_particles.tension(3.1, 3.1) == 0.0
    assert moving_particles.cohesion(3.1, 3.1) == 0.0


# kg/m3, kg/m3, N/m: kerosene, air; u [m/s] -> growth at the exit [1/ms], z [mm] of the break: swirl-sheet.md, 6, b
KEROSENE = (780.0, 1.2, 0.024)
BROKEN = {15.0: (7.6, 11.95), 20.0: (17.2, 9.5), 25.0: (33.4, 7.6)}


@pytest.mark.parametrize("u", BROKEN)
def test_waves_on_the_sheet_grow_and_break_it_as_the_specification_says(u):
    density, gas, sigma = KEROSENE
    growth, place = BROKEN[u]
    slip = math.sqrt(2.0) * u
    k = sheets.fastest_wave(1e-4, slip, gas, sigma)
    assert 1e-3 * sheets.wave_growth(k, 1e-4, slip, density, gas, sigma) == pytest.approx(growth, abs=0.05)
    assert 1e3 * sheets.suction_length(1.4e-3, 2e-4, u, 1.0, *KEROSENE) == pytest.approx(place, abs=0.05)


@pytest.mark.parametrize("half", [1e-6, 2e-5, 1e-4, 1e-3])
def test_the_fastest_wave_is_the_fastest(half):
    density, gas, sigma = KEROSENE
    k = sheets.fastest_wave(half, 28.0, gas, sigma)
    rates = [sheets.wave_growth(k * c, half, 28.0, density, gas, sigma) for c in (0.97, 1.0, 1.03)]
    assert max(rates) == rates[1] > 0.0


def test_waves_of_thin_and_of_thick_sheets():
    """Squire: k = rho_g U^2/(2 sigma), omega = sqrt((rho_g U^2 k - sigma k^2)/(rho h)) where k h is small; 2/3 in thick
    ones; nothing grows from rho_g U^2/sigma on (swirl_reference.json, at 15 m/s)."""
    density, gas, sigma = KEROSENE
    slip = math.sqrt(2.0) * 15.0
    thin = sheets.fastest_wave(1e-9, slip, gas, sigma)
    assert thin == pytest.approx(11250.0, rel=1e-4)
    assert sheets.wave_growth(thin, 1e-9, slip, density, gas, sigma) * math.sqrt(1e-9) == pytest.approx(
        6240.377 * math.sqrt(1e-4), rel=1e-5
    )
    assert sheets.fastest_wave(1.0, slip, gas, sigma) == pytest.approx(4.0 / 3.0 * 11250.0, rel=1e-4)
    assert sheets.wave_growth(22501.0, 1e-4, slip, density, gas, sigma) == 0.0


def test_a_sheet_that_does_not_turn_does_not_thin():
    assert sheets.distance_of_thickness(1e-4, 1.4e-3, 2e-4, 0.0) == math.inf
    assert sheets.distance_of_thickness(3e-4, 1.4e-3, 2e-4, 1.0) == 0.0
