"""A vessel of the user's own: its patches are the walls, it is filled to a level, and what does not fit is refused."""

import dataclasses
import json
import math
import tomllib
import types

import meshio
import numpy as np
import pytest
import pyvista
import tomli_w
from test_own_meshes import round_vessel

from sdph.case import read as cases
from sdph.cli import main
from sdph.engine import regions, table
from sdph.engine import state as particles
from sdph.engine.world import ALONE
from sdph.methods.grains import start
from sdph.running import vessel
from sdph.schema import CaseError
from sdph.show import timeline
from tests.of_ranks import Among, together

KINDS = ("pressure", "friction")
INSIDE = {"shape": "walls", "mass_kg": 2.0, "volume_fraction": 0.6, "temperature_K": 350.0, "disorder": 0.1}


def filled(folder, region, **more):
    own = round_vessel(folder, [])
    case = tomllib.loads((own / "case.toml").read_text())
    case["particles"], case["run"] = {"bed": region}, {"end_time_s": 1e-4, "output_interval_s": 1e-4}
    del case["walls"]["source"]
    (own / "case.toml").write_text(tomli_w.dumps(case | more))
    return own


@pytest.mark.openfoam
def test_a_round_vessel_is_filled_to_a_mass_and_its_patches_hold_it(tmp_path, capsys):
    run = {"end_time_s": 1e-4, "output_interval_s": 1e-4, "forces": ["inlet", "outlet", "wall"]}
    own, out = filled(tmp_path / "own", INSIDE, run=run), tmp_path / "out"
    assert main(["explain", str(own)]) == 0
    assert "inlet gas, grains outlet gas wall gas, grains" in " ".join(capsys.readouterr().out.split())
    assert main(["explain", str(own), "--set", "run.forces=['left']"]) == 2  # a vessel has patches, no sides
    assert "'left', which is no boundary or wall of the case; it has inlet" in capsys.readouterr().err
    assert main(["run", str(own), "--gas", "openfoam", "--out", str(out)]) == 0, capsys.readouterr().err
    summary = json.loads((out / "summary.json").read_text())
    assert summary["outside_mesh_particles"] == 0 if "outside_mesh_particles" in summary else True
    of_walls = ("time_s", *(f"impulse_of_walls_{a}_kg_m_s" for a in "xyz"))
    bears_its_ledger(summary, table.numbers(out / "ledger.csv", of_walls)[1])
    _, cloud, _ = timeline.state_at(timeline.read(out), 0.0)
    assert cloud["mass"].sum() == pytest.approx(2.0, rel=1e-12)
    off = np.hypot(*(cloud.points[:, :2] - 0.1).T)
    assert off.max() < 0.1 - 0.24 * 0.01 and off.max() > 0.09
    assert cloud.points[:, 2].max() == pytest.approx(2.0 / (0.6 * 3060.0 * math.pi * 0.0092), rel=0.1)
    kept = tomllib.loads((out / "case.toml").read_text())["walls"]
    assert kept["source"] == "gas" and (out / kept["mesh"]).is_file()
    again = cases.load(out / "case.toml")
    assert vessel.walled(again, None, out) is again  # what was found is kept
    assert len(start.fill(again, ()).x) == cloud.n_points


def bears_its_ledger(summary, ledger):
    """Patches bear together what the ledger has; the outlet, which lets grains through, has no force of theirs."""
    for a in "xyz":
        force = [summary[f"mean_{name}_grain_{kind}_force_{a}_N"] for name in ("inlet", "wall") for kind in KINDS]
        given = -ledger[f"impulse_of_walls_{a}_kg_m_s"].sum() / ledger["time_s"][-1]
        assert sum(force) == pytest.approx(given, rel=1e-9, abs=1e-9 * sum(map(abs, force)))
    assert summary["mean_wall_grain_pressure_force_x_N"] != 0.0 != summary["mean_inlet_grain_pressure_force_z_N"]
    assert not [key for key in summary if key.startswith("mean_outlet_grain_")]


@pytest.mark.parametrize("parted", [True, False])
def test_processes_refuse_grains_outside_a_mesh_that_the_first_has_alone(parted):
    """Each with a part of them, the last with none, or with all, as where nozzles let some in."""
    case = grains()
    whole = start.fill(case, ())

    def refused(world):
        cells = vessel.Cells(case, None)
        if world.chief:  # a mesh from x = 2 cm to 8 cm, up to 15 cm
            cells.grid = pyvista.ImageData(dimensions=(7, 16, 2), spacing=(0.01, 0.01, 0.02), origin=(0.02, 0.0, -0.01))
        own = particles.take(whole, whole.ident % 2 == world.rank) if parted and world.number > 1 else whole
        with pytest.raises(CaseError) as told:
            vessel.refuse_outside(case, cells, own, world)
        return str(told.value)

    alone = refused(ALONE)
    assert alone.startswith("particles.bed holds 110 particles in no cell of the gas, the first at (0.005, 0.005) m;")
    assert together(refused, Among.several(3)) == [alone] * 3


def test_processes_whose_gas_fills_the_domain_refuse_no_grains():
    case = grains()
    whole = start.fill(case, ())
    cells = vessel.Cells(case, None)
    assert not any(together(lambda own: vessel.refuse_outside(case, cells, whole, own), Among.several(2)))


@pytest.mark.openfoam
def test_grains_outside_the_gas_are_refused_with_region_count_and_place(tmp_path, capsys):
    corner = {"shape": "box", "lower_m": [0.0, 0.0, 0.0], "upper_m": [0.04, 0.04, 0.05], "volume_fraction": 0.6}
    own = filled(tmp_path / "own", corner | {"temperature_K": 350.0}, walls={"source": "mesh"})
    assert main(["run", str(own), "--gas", "openfoam", "--out", str(tmp_path / "out")]) == 2
    said = capsys.readouterr().err.splitlines()[-1]
    assert "particles.bed holds " in said and "in no cell of the gas, the first at (0.005, 0.005, 0.005) m" in said


@pytest.mark.openfoam
def test_a_boundary_that_is_no_patch_is_refused(tmp_path, capsys):
    own = filled(tmp_path / "own", INSIDE)
    case = tomllib.loads((own / "case.toml").read_text())
    case["boundaries"]["flue"] = {"kind": "wall"}
    (own / "case.toml").write_text(tomli_w.dumps(case))
    assert main(["run", str(own), "--gas", "openfoam", "--out", str(tmp_path / "out")]) == 2
    said = capsys.readouterr().err.splitlines()[-1]
    assert "boundaries.flue is no patch of the mesh of the gas; it has inlet, outlet, wall" in said


def test_a_mesh_of_ones_own_is_refused_by_the_embedded_gas(tmp_path, capsys):
    own = filled(tmp_path / "own", INSIDE)
    assert main(["run", str(own), "--gas", "embedded", "--out", str(tmp_path / "out")]) == 2
    assert "is a mesh that only OpenFOAM reads; give --gas openfoam" in capsys.readouterr().err.splitlines()[-1]


def grains(**region):
    place = {} if "shape" in region else {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.1, 0.2]}
    return cases.from_table({
        "dimensions": 2, "effects": ["gravity", "walls"], "run": {"end_time_s": 1.0, "output_interval_s": 1.0},
        "domain": {"size_m": [0.1, 0.2], "gravity_m_s2": [0.0, -9.81]},
        "resolution": {"spacing_mm": 10.0, "cell_mm": 20.0},
        "gas": {"density_kg_m3": 1.2, "viscosity_Pa_s": 1e-5, "conductivity_W_m_K": 0.02, "heat_capacity_J_kg_K": 1e3,
                "temperature_K": 300.0},
        "grains": {"density_kg_m3": 2500.0, "diameter_mm": 0.5, "heat_capacity_J_kg_K": 800.0,
                   "conductivity_W_m_K": 1.0},
        "boundaries": {"walls": {"kind": "wall"}},
        "particles": {"bed": place | {"volume_fraction": 0.5, "temperature_K": 300.0} | region},
    })  # fmt: skip


def test_a_level_is_told_by_mass_or_height():
    assert start.fill(grains(mass_kg=3.0), ()).mass.sum() == pytest.approx(3.0, rel=1e-12)
    assert start.fill(grains(height_m=0.1), ()).mass.sum() == pytest.approx(0.5 * 2500.0 * 0.01, rel=1e-12)
    with pytest.raises(CaseError, match=r"particles.bed.mass_kg = 30; 25 kg fit"):
        start.fill(grains(mass_kg=30.0), ())


def test_estimates_know_the_level_of_a_region():
    """Else a bed in the lower half would reach the outlet above, and `explain` call for outflow."""
    case = grains(height_m=0.05)
    low, high = start.extents(case, case.particles["bed"])
    assert low.tolist() == [0.0, 0.0] and high == pytest.approx([0.1, 0.05])
    upside = dataclasses.replace(case, domain=dataclasses.replace(case.domain, gravity=(0.0, 9.81)))
    low, high = start.extents(upside, case.particles["bed"])
    assert low == pytest.approx([0.0, 0.15]) and high.tolist() == [0.1, 0.2]


@pytest.mark.parametrize(
    ("region", "told"),
    [
        ({"height_m": 0.1, "mass_kg": 1.0}, "either is a level: give one"),
        ({"shape": "cylinder", "centre_m": [0.0, 0.0], "radius_m": 0.1, "length_m": 0.1}, "of three dimensions"),
        ({"shape": "disc", "centre_m": [0.0, 0.0]}, r"particles.bed.radius_m is missing"),
        ({"disorder": 0.3}, "disorder"),
        ({"mass_kg": 0.0}, "mass_kg"),
        ({"seed": -1}, "seed"),
    ],
)
def test_a_region_that_cannot_be_is_refused(region, told):
    with pytest.raises(CaseError, match=told):
        grains(**region)


def test_what_walls_enclose_is_refused_where_there_is_no_mesh_of_them():
    with pytest.raises(CaseError, match="the walls are the sides of the domain"):
        start.fill(grains(shape="walls"), ())


ROUND = {"shape": "disc", "centre_m": [0.05, 0.1]}


@pytest.mark.parametrize(
    ("region", "given", "told"),
    [
        ({}, 25.0, ""),
        ({"mass_kg": 3.0}, 3.0, ""),
        ({"height_m": 0.1}, 12.5, ""),
        ({"height_m": 0.104}, 13.0, "particles.bed holds 12.5 kg, 4% less than volume_fraction of its volume, 13 kg"),
        (ROUND | {"radius_m": 0.012}, 0.5 * 2500.0 * math.pi * 0.012**2, "12% less"),
        (ROUND | {"radius_m": 0.016}, 0.5 * 2500.0 * math.pi * 0.016**2, "49% more"),
        (ROUND | {"radius_m": 0.04, "height_m": 0.04}, 0.25 * 2500.0 * math.pi * 0.04**2, "3% more"),
    ],
)
def test_the_mass_of_a_region_is_told_beside_what_it_is_given(region, given, told):
    case, notices, masses = grains(**region), [], {}
    state = start.fill(case, (), notices, masses)
    assert masses == {"bed": state.mass.sum()}
    counted = case.particles["bed"].shape != "box" and case.particles["bed"].height is not None
    assert start.meant(case, case.particles["bed"]) == pytest.approx(given, rel=2e-3 if counted else 1e-12)
    assert len(notices) == bool(told) and all(told in line for line in notices)


def lines(path, *polygons):
    """Walls of closed lines, anticlockwise about what grains are in, clockwise about what they are not."""
    ends, first = [], 0
    for polygon in polygons:
        own = first + np.arange(len(polygon))
        ends.append(np.stack([own, np.roll(own, -1)], axis=1))
        first += len(polygon)
    meshio.write_points_cells(path, np.pad(np.concatenate(polygons), ((0, 0), (0, 1))), {"line": np.concatenate(ends)})
    return str(path)


@pytest.mark.parametrize("region", [{"shape": "walls"}, {"shape": "walls", "height_m": 0.1}, {}])
def test_mass_that_walls_and_internals_cost_is_told(tmp_path, region):
    """A funnel 20 mm wide below and 100 mm above, and a tube of 16 mm in it: of 10 and 5 kg 17 % and 21 % were missing
    without a word, in a box that is cut by them the volume of both and of what grains leave free beside them."""
    angle = -2.0 * np.pi * np.arange(32) / 32
    tube = np.array([0.05, 0.09]) + 0.008 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    funnel = np.array([(0.04, 0.0), (0.06, 0.0), (0.1, 0.2), (0.0, 0.2)])
    own = {"walls": {"source": "mesh", "mesh": lines(tmp_path / "walls.vtk", funnel, tube)}}
    case, notices, masses = cases.from_table(cases.to_table(grains(**region)) | own), [], {}
    start.fill(case, (), notices, masses)
    up = region.get("height_m", 0.2)
    area = up * (0.02 + 0.5 * up * 0.4) - 0.5 * 32 * 0.008**2 * np.sin(2.0 * np.pi / 32)
    given = start.meant(case, case.particles["bed"])
    assert given == pytest.approx(0.5 * 2500.0 * area, rel=5e-3)
    lost = round(100.0 * (1.0 - masses["bed"] / given))
    print(f"{masses['bed']:.4g} kg of {given:.4g} kg")
    line = notices[-1]
    assert lost > 3 and f"{lost}% less than volume_fraction of its volume" in line and "bed.mass_kg gives them" in line


def test_volumes_of_shapes_in_closed_form():
    ball = {"shape": "sphere", "centre": (0, 0, 0), "radius": 2.0, "length": 3.0, "end_radius": 1.0}
    shaped = {
        shape: types.SimpleNamespace(**ball | {"shape": shape}) for shape in ("sphere", "cylinder", "cone", "mesh")
    }
    found = {shape: regions.closed_form(region, 3) / math.pi for shape, region in shaped.items()}
    assert found == pytest.approx({"sphere": 32.0 / 3.0, "cylinder": 12.0, "cone": 7.0, "mesh": math.nan}, nan_ok=True)


@pytest.mark.parametrize(("axis", "meant"), [("z", 0.3 * math.pi), ("x", math.acos(0.7 / 1.0) - 0.7 * math.sqrt(0.51))])
def test_a_cylinder_is_known_up_to_its_level(axis, meant):
    """Upright, and a segment of one that lies."""
    shape = {"shape": "cylinder", "centre": (0.0, 0.0, 0.5), "radius": 1.0, "end_radius": None, "length": 1.0}
    region = types.SimpleNamespace(**shape, axis=axis, height=0.3, mass=None, volume_fraction=0.5, material="")
    bed = types.SimpleNamespace(
        dimensions=3, effects=(), parameters={"walls": None}, domain=types.SimpleNamespace(gravity=(0.0, 0.0, -9.81)),
        of=lambda material: types.SimpleNamespace(density=2500.0), resolution=types.SimpleNamespace(spacing=0.05),
    )  # fmt: skip
    assert start.meant(bed, region) == pytest.approx(0.5 * 2500.0 * meant, rel=1e-12 if axis == "z" else 5e-3)


OTHER = {"shape": "box", "lower_m": [0.05, 0.0], "upper_m": [0.1, 0.2], "temperature_K": 300.0, "volume_fraction": 0.1}


@pytest.mark.parametrize(
    ("other", "told"),
    [
        (OTHER, "100 of 100 particles of more (100%) stand among those of bed, the first at (0.055, 0.005) m"),
        (OTHER | {"lower_m": [0.0, 0.15]}, "50 of 50 particles of more"),
        (OTHER | {"volume_fraction": 0.2, "upper_m": [0.1, 0.1]}, "alpha_p adds up to 0.4 there"),
    ],
)
def test_regions_of_one_material_that_overlap_are_told(other, told):
    case, notices = grains(volume_fraction=0.2), []
    more = cases.from_table(
        cases.to_table(case) | {"particles": {"bed": cases.to_table(case)["particles"]["bed"], "more": other}}
    )
    start.fill(more, (), notices)
    (line,) = notices
    assert told in line and line.startswith("particles.bed and particles.more are the same grains and overlap")


def test_regions_that_touch_and_mixtures_are_not_told_of():
    case, notices = grains(volume_fraction=0.2, upper_m=[0.05, 0.2]), []
    table = cases.to_table(case)
    regions = {"bed": table["particles"]["bed"], "more": OTHER}
    start.fill(cases.from_table(table | {"particles": regions}), (), notices)
    own = {
        key: table["grains"][key]
        for key in ("density_kg_m3", "diameter_mm", "heat_capacity_J_kg_K", "conductivity_W_m_K")
    }
    kinds = {"a": own, "b": own | {"density_kg_m3": 1000.0}}
    among = {"bed": regions["bed"] | {"material": "a"}, "more": OTHER | {"lower_m": [0.0, 0.0], "material": "b"}}
    start.fill(cases.from_table(table | {"grains": kinds, "particles": among}), (), notices)
    assert notices == []


def test_explain_warns_of_regions_that_overlap(tmp_path, capsys):
    table = cases.to_table(grains(volume_fraction=0.2))
    table["particles"]["more"] = OTHER
    (tmp_path / "case.toml").write_text(tomli_w.dumps(table))
    assert main(["explain", str(tmp_path), "--gas", "embedded"]) == 0
    assert "particles.bed and particles.more are the same grains and overlap" in capsys.readouterr().out
