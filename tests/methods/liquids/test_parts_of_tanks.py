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
    """Four spacings high: 1.5 % and 0.5 % too little. Where pressures change for their sum by their directions alone it
    is 5 % too much, as by the sum over particles."""
    mesh = {"tank": {"slip": "free_slip", "shape": "mesh", "mesh": with_blocks(tmp_path / "tank.stl")}}
    parts = {"first": {"lower_m": [0.08, 0.08, 0.12], "upper_m": [0.24, 0.24, 0.28]},
             "second": {"lower_m": [0.36, 0.08, 0.12], "upper_m": [0.56, 0.24, 0.28]}}  # fmt: skip
    more = mesh | {"parts": parts, "pools": {"water": {"shape": "tank", "fill": 0.9}}}
    own = run(tank((0.64, 0.32, 0.48), (), 0.04, ["first", "second", "tank"], **more), tmp_path)
    told = own.summary(None)
    lift = [told[f"mean_{name}_liquid_pressure_force_z_N"] for name in parts]
    over = [force / (DENSITY * G * 0.16**2 * wide) for force, wide in zip(lift, (0.16, 0.2))]
    print(f"lift over the weight of the liquid displaced: {over[0]:.4f}, {over[1]:.4f}")
    assert all(abs(value - 1.0) < 0.04 for value in over)
    np.testing.assert_allclose(on(own, "tank"), -of_ledger(own), atol=1e-10 * np.abs(of_ledger(own)).max())


WIDE, UP = 0.24, 0.3  # m, of a tank and of the liquid in it


def prism(path, outline):
    """A tank of an outline (x, z) [m], anticlockwise, that is as deep as WIDE along y."""
    flat = pyvista.PolyData([(x, 0.0, z) for x, z in outline], [len(outline), *range(len(outline))])
    solid = flat.triangulate().extrude((0.0, WIDE, 0.0), capping=True).triangulate().clean()
    solid.compute_normals(auto_orient_normals=True).save(path)
    return str(path)


def settled(folder, outline, long, pools, named):
    """Forces [N] that press the boxes `named`, the sum over them, and what presses the tank, once its liquid rests."""
    parts = {name: {"lower_m": list(low), "upper_m": list(high)} for name, (low, high) in named.items()}
    mesh = {"slip": "free_slip", "shape": "mesh", "mesh": prism(folder / "tank.stl", outline)}
    pools = {f"pool{n}": {"shape": "box", "lower_m": [low, 0.0, 0.0], "upper_m": [high, WIDE, up]}
             for n, (low, high, up) in enumerate(pools)}  # fmt: skip
    own = run(tank((long, WIDE, 0.42), (), 0.03, [*parts, "tank"], 0.6, tank=mesh, parts=parts, pools=pools), folder)
    row = own.row()
    found = {name: np.array([row[f"{name}_liquid_pressure_force_{a}_N"] for a in "xyz"]) for name in (*parts, "tank")}
    return found, sum(found[name] for name in parts), on(own, *parts), on(own, "tank")


def test_floor_and_sides_of_a_mesh_bear_what_hydrostatics_says_and_all_of_the_force(tmp_path):
    """A corner of a mesh is of no one side: floor and sides bore 4 and 5 % too much, and 10 % more than the tank."""
    a, b, c = WIDE, WIDE, 0.42
    named = {"floor": ((0, 0, 0), (a, b, 0)), "lid": ((0, 0, c), (a, b, c)),
             "west": ((0, 0, 0), (0, b, c)), "east": ((a, 0, 0), (a, b, c)),
             "south": ((0, 0, 0), (a, 0, c)), "north": ((0, b, 0), (a, b, c))}  # fmt: skip
    found, of_row, parts, whole = settled(tmp_path, [(0, 0), (a, 0), (a, c), (0, c)], a, [(0.0, a, UP)], named)
    down, across = DENSITY * G * UP * a * b, 0.5 * DENSITY * G * UP**2 * b
    over = [found["floor"][2] / -down, found["west"][0] / -across, found["north"][1] / across]
    print("over hydrostatics: floor {:.4f}, west {:.4f}, north {:.4f}".format(*over))
    assert all(abs(value - 1.0) < 0.02 for value in over)
    assert np.abs(found["west"][1:]).max() < 1e-3 * across and not found["lid"].any()
    np.testing.assert_allclose(of_row, found["tank"], atol=1e-10 * down)
    np.testing.assert_allclose(parts, whole, atol=1e-10 * np.abs(whole).max())


@pytest.mark.parametrize("right", [0.0, 0.18])
def test_each_face_of_a_thin_plate_bears_the_liquid_on_its_own_side(tmp_path, right):
    """Two spacings thick, with liquid on the left 0.3 m high, and on the right none or less: the sum over the particles
    behind a face has what presses the other one too, by a tenth of its load and half of it."""
    outline = [(0, 0), (0.24, 0), (0.24, 0.36), (0.3, 0.36), (0.3, 0), (0.54, 0), (0.54, 0.42), (0, 0.42)]
    named = {"one": ((0.24, 0, 0), (0.24, WIDE, 0.36)), "other": ((0.3, 0, 0), (0.3, WIDE, 0.36)),
             "plate": ((0.24, 0, 0), (0.3, WIDE, 0.36))}  # fmt: skip
    pools = [(0.0, 0.24, UP), *([(0.3, 0.54, right)] if right else [])]
    found, *_ = settled(tmp_path, outline, 0.54, pools, named)
    left, right = (0.5 * DENSITY * G * up**2 * WIDE for up in (UP, right))
    over = found["one"][0] / left, found["other"][0] / -(right or np.inf), found["plate"][0] / (left - right)
    print("over hydrostatics: {:.4f}, {:.4f}, both {:.4f}".format(*over))
    assert over[0] == pytest.approx(1.0, abs=0.04) and over[2] == pytest.approx(1.0, abs=0.04)
    assert over[1] == pytest.approx(1.0, abs=0.05) if right else not found["other"].any()
    np.testing.assert_allclose(found["one"] + found["other"], found["plate"], atol=1e-3 * left)


def test_without_names_there_is_no_column(tmp_path):
    own = Alone(tank((0.2, 0.2), (0.2, 0.1), 0.02, []), tmp_path / "ledger.csv")
    own.start()
    own.window()
    assert own.stepper.parts is None and not [key for key in own.row() if "_liquid_" in key]
