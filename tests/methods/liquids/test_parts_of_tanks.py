"""Forces of a liquid on named walls of its tank: hydrostatics, Archimedes, and the ledger's impulse, split."""

import numpy as np
import pytest
import pyvista

from sdph.case import read as cases
from sdph.methods.liquids.totals import IMPULSES
from sdph.running.alone import Alone

G, DENSITY = 9.81, 1000.0
SIDES = ["left", "right", "bottom", "top", "back", "front"]


def tank(size, up, spacing, names, end=0.2, **more):
    d = len(size)
    given = {
        "dimensions": d, "effects": ["gravity", "density_diffusion", "liquid_damping", "tank"],
        "run": {"end_time_s": end, "output_interval_s": end, "forces": names},
        "domain": {"size_m": list(size), "gravity_m_s2": [*[0.0] * (d - 1), -G]},
        "resolution": {"spacing_mm": 1e3 * spacing},
        "liquid": {"density_kg_m3": DENSITY, "sound_speed_m_s": 25.0, "history_interval_s": 0.5 * end},
        "tank": {"slip": "free_slip"},
        "pools": {"water": {"shape": "box", "lower_m": [0.0] * d, "upper_m": list(up)}},
    }  # fmt: skip
    return cases.from_table(given | more)


def run(case, folder):
    own = Alone(case, folder / "ledger.csv")
    own.start()
    while own.time < case.run.end_time:
        own.window()
    return own


def on(own, *names):
    """(3,) [N s] that these walls got."""
    pushed = own.method.pushed
    return sum(pushed.sums[1, pushed.names.index(name), :2].sum(axis=0) for name in names)


def of_ledger(own):
    return own.ledger.impulses[IMPULSES.index("walls")]


@pytest.mark.parametrize(
    "size, up, spacing", [((0.5, 0.6), (0.5, 0.4), 0.025), ((0.3, 0.3, 0.45), (0.3, 0.3, 0.3), 0.03)]
)
def test_liquid_at_rest_bears_on_floor_and_sides_as_hydrostatics_says(tmp_path, size, up, spacing):
    """rho g H L on the floor, rho g H^2/2 L on a side, rho g H^3/6 L about its foot; 16 and 10 rows of particles."""
    d, depth, sides = len(size), up[-1], SIDES[: 2 * len(size)]
    own = run(tank(size, up, spacing, [*sides, "tank"]), tmp_path)
    told, floor = own.summary(None), ("bottom", "back")[d - 2]
    wide, deep = size[0], 1.0 if d == 2 else size[1]
    moment = "mean_left_liquid_moment_z_Nm" if d == 2 else "mean_left_liquid_moment_y_Nm"
    found = {
        "floor": told[f"mean_{floor}_liquid_pressure_force_{'xyz'[d - 1]}_N"] / -(DENSITY * G * depth * wide * deep),
        "side": told["mean_left_liquid_pressure_force_x_N"] / -(0.5 * DENSITY * G * depth**2 * deep),
        "moment": told[moment] / (DENSITY * G * depth**3 / 6.0 * deep * (1.0 if d == 2 else -1.0)),
    }  # fmt: skip
    print(f"{d}-D, over hydrostatics: " + ", ".join(f"{name} {value:.4f}" for name, value in found.items()))
    assert all(abs(value - 1.0) < (0.01, 0.03)[d - 2] for value in found.values())
    for names in (sides, ["tank"]):
        np.testing.assert_allclose(on(own, *names), -of_ledger(own), atol=1e-10 * np.abs(of_ledger(own)).max())
    lid = ("top", "front")[d - 2]
    untouched = [value for key, value in own.row().items() if key.startswith(f"{lid}_liquid_")]
    assert len(untouched) == (5 if d == 2 else 9) and not any(untouched)


def test_forces_of_a_row_are_its_mean_load_and_friction_is_told_apart(tmp_path):
    """Liquid that flows over a floor that grips: the last row has what the momentum theorem has."""
    water = {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.4, 0.2], "velocity_m_s": [1.0, 0.0]}
    liquid = {"density_kg_m3": DENSITY, "viscosity_Pa_s": 5.0, "sound_speed_m_s": 20.0, "history_interval_s": 0.02}
    effects = ["gravity", "density_diffusion", "laminar_viscosity", "tank"]
    more = {"pools": {"water": water}, "liquid": liquid, "tank": {"slip": "no_slip"}, "effects": effects}
    row = run(tank((0.4, 0.3), (0.4, 0.2), 0.02, ["bottom", "tank"], 0.04, **more), tmp_path).row()
    for a in "xy":
        force = sum(row[f"tank_liquid_{kind}_force_{a}_N"] for kind in ("pressure", "viscous"))
        assert force == pytest.approx(row[f"mean_force_{a}_N"], rel=1e-9, abs=1e-9 * abs(row["mean_force_y_N"]))
    assert row["tank_liquid_moment_z_Nm"] == pytest.approx(row["mean_moment_z_Nm"], rel=0.05)
    assert row["bottom_liquid_viscous_force_x_N"] > 0.0  # dragged along


def with_blocks(path):
    """A tank with two blocks in it, 0.16 m high and deep, 0.16 and 0.2 m wide."""
    mesh = pyvista.Box((0.0, 0.64, 0.0, 0.32, 0.0, 0.48)).triangulate()
    for low, high in ((0.08, 0.24), (0.36, 0.56)):
        block = pyvista.Box((low, high, 0.08, 0.24, 0.12, 0.28)).triangulate()
        block.flip_faces(inplace=True)
        mesh = mesh.append_polydata(block)
    mesh.clean().save(path)
    return str(path)


def test_blocks_in_a_liquid_are_lifted_as_archimedes_says(tmp_path):
    """Four spacings high: 5 % too much, 2 % with eight (0.1 s and 0.2 s of a run with 20 mm)."""
    mesh = {"tank": {"slip": "free_slip", "shape": "mesh", "mesh": with_blocks(tmp_path / "tank.stl")}}
    parts = {"first": {"lower_m": [0.08, 0.08, 0.12], "upper_m": [0.24, 0.24, 0.28]},
             "second": {"lower_m": [0.36, 0.08, 0.12], "upper_m": [0.56, 0.24, 0.28]}}  # fmt: skip
    more = mesh | {"parts": parts, "pools": {"water": {"shape": "tank", "fill": 0.9}}}
    own = run(tank((0.64, 0.32, 0.48), (), 0.04, ["first", "second", "tank"], **more), tmp_path)
    told = own.summary(None)
    lift = [told[f"mean_{name}_liquid_pressure_force_z_N"] for name in parts]
    over = [force / (DENSITY * G * 0.16**2 * wide) for force, wide in zip(lift, (0.16, 0.2))]
    print(f"lift over the weight of the liquid displaced: {over[0]:.4f}, {over[1]:.4f}")
    assert all(abs(value - 1.0) < 0.08 for value in over)
    np.testing.assert_allclose(on(own, "tank"), -of_ledger(own), atol=1e-10 * np.abs(of_ledger(own)).max())


def test_without_names_there_is_no_column(tmp_path):
    own = Alone(tank((0.2, 0.2), (0.2, 0.1), 0.02, []), tmp_path / "ledger.csv")
    own.start()
    own.window()
    assert own.stepper.parts is None and not [key for key in own.row() if "_liquid_" in key]
