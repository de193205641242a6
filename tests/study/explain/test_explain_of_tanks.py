"""`sdph explain` of tanks that are drained: outlet, damping, tension."""

import dataclasses
import math

import numpy as np
import pytest
from tank_meshes import turned_mesh

from sdph.case import read as cases
from sdph.schema import CaseError
from sdph.study.explain import liquids, tables


def drained(end=4.0, **sections):
    """Water 0.3 m deep over a slot of 40 mm in the floor, 0.135 m2 of which a drain takes from 0.5 s on."""
    return cases.from_table({
        "dimensions": 2, "effects": ["gravity", "density_diffusion", "liquid_damping", "tank", "drain"],
        "run": {"end_time_s": 4.5, "output_interval_s": 0.5},
        "domain": {"size_m": [0.5, 0.6], "gravity_m_s2": [0.0, -9.81]}, "resolution": {"spacing_mm": 10.0},
        "liquid": {"density_kg_m3": 1000.0, "sound_speed_m_s": 25.0, "viscosity_Pa_s": 1e-3},
        "tank": {"open_sides": ["top"], "outlet_radius_m": 0.02, "outlet_length_m": 0.08},
        "drain": {"fill": 0.05, "start_s": 0.5, "end_s": end},
        "pools": {"water": {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.5, 0.3]}},
    } | sections)  # fmt: skip


@pytest.mark.parametrize(("end", "told"), [(4.0, False), (1.8, True)])
def test_a_drain_faster_than_liquid_falls_is_told_of(end, told):
    """Within 3.5 or 1.3 s: 0.96 and 2.6 m/s, of sqrt(2 g (0.03 + 0.08 m)) = 1.47."""
    (found,) = [line for line in tables.warnings(drained(end)) if "Torricelli" in line] or [""]
    assert bool(found) == told
    assert not told or ("2.6 m/s" in found and "1.47 m/s" in found)


def told_of(what, case):
    (row,) = [row for row in tables.explain(case)["expected"] if row["what"] == what]
    return row["value"]


def test_rows_of_the_history_cut_steps():
    """A row each 10 us, far shorter than a step: one step to each of the 450 000."""
    fine = dataclasses.replace(drained().liquid, history_interval=1e-5)
    assert told_of("steps", dataclasses.replace(drained(), liquid=fine)) == 450_000
    assert told_of("steps", drained()) < 100_000


def test_a_drain_costs_the_steps_in_which_it_takes_particles():
    """0.135 m2 of particles of 1 cm2, one to a step at most; 2.3 steps' time each."""
    case = drained()
    closed = dataclasses.replace(
        case,
        effects=tuple(name for name in case.effects if name != "drain"),
        parameters={name: own for name, own in case.parameters.items() if name != "drain"},
    )
    times = [told_of("wall time", own) / told_of("steps", own) for own in (case, closed)]
    assert times[0] / times[1] == pytest.approx(1.0 + liquids.REMOVING * 1348.0 / told_of("steps", case), rel=1e-3)


def test_an_outlet_pipe_without_liquid_is_told_of():
    full = {"water": {"shape": "tank", "fill": 0.5}}
    found = [
        any("pipe begins empty" in line for line in tables.warnings(drained(**own))) for own in ({}, {"pools": full})
    ]
    assert found == [True, False]


def test_viscosity_of_damping_is_told():
    """alpha c h/8 = 0.02 25 m/s 15 mm/8 = 9.4e-4 m2/s in the plane (Monaghan 2005), of 1e-6 of water."""
    rows = {row["number"]: row["value"] for row in tables.explain(drained())["numbers"]}
    ratio = 0.02 * 25.0 * drained().smoothing_length / 8.0 / 1e-6
    assert rows["viscosity of damping / the liquid's"] == pytest.approx(ratio, rel=1e-12)


def test_damping_that_is_off_is_not_told_of():
    rows = {
        row["number"]
        for row in tables.explain(drained(effects=["gravity", "density_diffusion", "tank", "drain"]))["numbers"]
    }
    assert not any("damping" in name for name in rows)


def outline(*below, **more):
    """A tank as wide as `drained` by corners, with those `below` its floor."""
    tank = {"shape": "outline", "corners_m": [[0.0, 0.1], *below, [0.5, 0.1], [0.5, 0.6], [0.0, 0.6]]}
    return drained(tank=tank | more, pools={"water": {"shape": "tank", "fill": 0.5}})


def test_a_drain_of_an_outline_is_its_pipe():
    """Drawn by its corners: the others' keys are not named, and where there is one it is seen."""
    pipe = ([0.23, 0.1], [0.23, 0.0], [0.27, 0.0], [0.27, 0.1])
    (line,) = [line for line in tables.warnings(outline()) if "without an outlet pipe" in line]
    assert "tank.corners_m" in line and "outlet_radius_m" not in line
    assert not [line for line in tables.warnings(outline(*pipe)) if "outlet pipe" in line]
    with pytest.raises(CaseError, match="an outline by tank.corners_m alone: give 0"):
        tables.warnings(outline(outlet_radius_m=0.02, outlet_length_m=0.1))


@pytest.mark.parametrize(("end", "told"), [(0.6, True), (4.0, False)])
def test_a_drain_is_judged_by_a_pipe_that_its_tank_has_drawn(end, told):
    """By hand: 0.45 of 0.254 m2 in 0.1 s through 0.04 m are 28.6 m/s, and in 3.5 s 0.82 m/s."""
    corners = [[0.0, 0.1], [0.23, 0.1], [0.23, 0.0], [0.27, 0.0], [0.27, 0.1], [0.5, 0.1], [0.5, 0.6], [0.0, 0.6]]
    tank, pools = {"shape": "outline", "corners_m": corners}, {"water": {"shape": "tank", "fill": 0.5}}
    lines = [line for line in tables.warnings(drained(end, tank=tank, pools=pools)) if "torn out" in line]
    assert len(lines) == told and all("28.6 m/s" in line and "the notch in tank.corners_m" in line for line in lines)


ROUND = [(0.4 * math.sin(t), 0.5 - 0.4 * math.cos(t)) for t in np.linspace(0.0, 0.5 * math.pi, 13)]
LID = [(0.4, 0.8), (0.0, 0.8)]


@pytest.mark.parametrize(("floor", "pipe"), [
    (ROUND, False),
    ([(0.0, 0.02), (0.06, 0.02), (0.06, ROUND[2][1]), *ROUND[3:]], True),
    ([(0.0, 0.1), (0.4, 0.1)], False),
])  # fmt: skip
def test_a_drain_of_a_mesh_is_its_pipe_where_it_is_level_and_narrow(tmp_path, floor, pipe):
    """A round floor, one with a pipe 0.12 m wide in it, and a flat one."""
    mesh = turned_mesh(tmp_path / "tank.stl", [*floor, *LID])
    case = drained(
        dimensions=3, domain={"size_m": [1.0, 1.0, 1.0], "lower_m": [-0.5, -0.5, 0.0], "gravity_m_s2": [0, 0, -9.81]},
        resolution={"spacing_mm": 30.0}, tank={"shape": "mesh", "mesh": str(mesh)},
        pools={"water": {"shape": "tank", "fill": 0.5}},
    )  # fmt: skip
    assert (liquids._pipe_drawn(case, case.parameters["tank"]) > 0.0) == pipe


def hint(**tank):
    """What is told of a tank without an outlet pipe."""
    case = drained(tank=tank, pools={"water": {"shape": "tank", "fill": 0.5}})
    (line,) = [line for line in tables.warnings(case) if "without an outlet pipe" in line]
    return line.rsplit("; ", 1)[1]


def test_what_gives_a_plane_tank_a_pipe_is_what_it_may_have():
    """A disc has no outlet by keys, and meshes are of three dimensions."""
    assert hint(open_sides=["top"]) == "give tank.outlet_radius_m and outlet_length_m"
    disc = {"shape": "sphere", "centre_m": [0.25, 0.3], "radius_m": 0.2}
    assert 'tank.shape = "outline"' in hint(**disc) and "outlet_radius_m" not in hint(**disc)


def test_a_full_pipe_is_counted_once():
    """The level is that over the floor: 0.45 left of 0.5, over a pipe of 0.3 m, sqrt(2 g 0.57 m) = 3.34 m/s."""
    pipe = {"open_sides": ["top"], "outlet_radius_m": 0.02, "outlet_length_m": 0.3}
    drain = {"fill": 0.45, "start_s": 0.5, "end_s": 0.6}
    case = drained(tank=pipe, drain=drain, pools={"water": {"shape": "tank", "fill": 0.5}})
    (found,) = [line for line in tables.warnings(case) if "Torricelli" in line]
    told = float(found.split(" m/s at most")[0].rsplit(" ", 1)[1])
    assert told == pytest.approx(math.sqrt(2.0 * 9.81 * 0.57), rel=0.02)


def test_a_liquid_without_a_known_surface_is_that_of_water_there():
    """Above its critical point a fluid has none; explain goes on."""
    own = {"density_kg_m3": 70.8, "sound_speed_m_s": 25.0, "viscosity_Pa_s": 1.3e-5}
    own |= {"fluid": "ParaHydrogen", "fluid_temperature_K": 300.0}
    rows = {row["number"]: row for row in tables.explain(drained(liquid=own))["numbers"]}
    assert "surface tension of water" in str(rows["Bond, rho g L2/sigma"])


def test_weber_and_bond_have_the_tension_of_a_liquid_by_name():
    """Hydrogen that boils at 20.3 K has 1.9 mN/m (Leachman et al. 2009), a fortieth of water's."""
    own = {"density_kg_m3": 70.8, "sound_speed_m_s": 25.0, "viscosity_Pa_s": 1.3e-5}
    bond = []
    for more in ({}, {"fluid": "ParaHydrogen", "fluid_temperature_K": 20.3}):
        rows = {row["number"]: row["value"] for row in tables.explain(drained(liquid=own | more))["numbers"]}
        bond.append(rows["Bond, rho g L2/sigma"])
    assert bond[1] / bond[0] == pytest.approx(0.0728 / 1.93e-3, rel=0.05)
