"""OpenFOAM case files made from case.toml: macros, meshes, boundaries, and what is refused."""

import gzip
import re
import shutil
import subprocess
import tomllib

import numpy as np
import pytest
from gas_boxes import AIR, TEMPLATE, box, box_case

from coupling.openfoam import case as case_files
from coupling.openfoam.block_mesh import block_mesh
from coupling.openfoam.programs import install
from coupling.openfoam.programs import run as programs
from sdph import scenes
from sdph.case import read as cases
from sdph.schema import CaseError

SLOT = {
    "slot": {
        "kind": "velocity_inlet",
        "side": "bottom",
        "span_m": [0.04, 0.06],
        "velocity_m_s": [0.0, 7.5],
        "temperature_K": 350.0,
    },
    "floor": {"kind": "velocity_inlet", "side": "bottom", "velocity_m_s": [0.0, 0.08]},
    "outlet": {"kind": "pressure_outlet", "side": "top", "pressure_Pa": 0.0},
    "walls": {"kind": "wall"},
}


def test_macros_hold_every_number_of_the_case_in_si():
    case = cases.load(scenes.HERE / "disc_cluster" / "case.toml", ("resolution.spacing_mm=2.0",))
    found = case_files.macros(case)
    assert float(found["resolution_spacing"]) == case.resolution.spacing
    assert float(found["gas_viscosity"]) == case.gas.viscosity
    assert float(found["particles_disc_radius"]) == case.particles["disc"].radius
    assert float(found["grains_diameter"]) == case.grains.diameter
    assert found["domain_size"] == "(0.5 0.5 1.0)"
    assert found["domain_gravity"] == "(0.0 0.0 0.0)"
    assert found["heat_law"] == "gunn"
    assert found["gas_equation_of_state"] == "constant"
    assert found["coupling_one_way"] == "false"


def test_macros_of_boundaries_have_three_components():
    found = case_files.macros(box_case((0.1, 0.2), 0.01, boundaries=SLOT))
    assert found["boundaries_slot_velocity"] == "(0.0 7.5 0.0)"
    assert found["boundaries_slot_span"] == "(0.04 0.06)"
    assert found["boundaries_slot_temperature"] == "350.0"
    assert "boundaries_walls_temperature" not in found


def test_texts_cannot_break_out_of_their_macro(tmp_path):
    import dataclasses

    case = dataclasses.replace(box_case((0.1, 0.1), 0.01), title='a"; #calc "1"; $b \\ {')
    title = case_files.macros(case)["title"]
    assert title.startswith('"') and title.endswith('"')
    assert not set('"$#;\\{') & set(title[1:-1])


def test_names_cannot_break_out_of_their_macro():
    evil = 'a 1; libs ("x.so"); #calc'
    text = (scenes.HERE / "disc_cluster" / "case.toml").read_text()
    found = case_files.macros(cases.from_table(tomllib.loads(text) | {"probes": {evil: {"at_m": [0.1, 0.1]}}}))
    assert found["probes_a1libsx.socalc_at"] == "(0.1 0.1 0.0)"
    assert all(re.fullmatch(r"[\w.]+", name) for name in found)


def test_a_boundary_that_openfoam_could_not_call_so_is_refused(tmp_path):
    case = box_case((0.1, 0.1), 0.01, boundaries={"walls; #calc": {"kind": "wall"}})
    with pytest.raises(CaseError, match="boundaries.'walls; #calc': OpenFOAM takes letters"):
        case_files.write_case(case, TEMPLATE, tmp_path / "out")


@pytest.mark.parametrize(("folder", "wall"), [("a run/tfm", "wall"), ("run/tfm", "a wall")])
def test_what_a_reference_cannot_take_names_no_option_of_other_commands(tmp_path, folder, wall):
    """`sdph compare` has neither --out nor --gas."""
    case = box_case((0.1, 0.1), 0.01, boundaries={wall: {"kind": "wall"}})
    with pytest.raises(CaseError, match="OpenFOAM takes .*; the reference is a run of OpenFOAM") as caught:
        case_files.refuse_reference(case, tmp_path / folder)
    assert "--" not in str(caught.value)


@pytest.mark.parametrize("entry", [
    '#calc "1+1"', "#codeStream { code #{ #}; }", "type coded;", "type codedFixedValue;", "type systemCall;",
    'libs ("libx.so");',
])  # fmt: skip
def test_code_in_a_case_is_refused(tmp_path, entry):
    shutil.copytree(TEMPLATE, tmp_path / "template")
    with (tmp_path / "template" / "system" / "controlDict").open("a") as file:
        file.write(f"// {entry}\nnote fine;\n")
    case_files.refuse_code(tmp_path / "template")
    with (tmp_path / "template" / "system" / "fvSchemes").open("a") as file:
        file.write(f"x {{ {entry} }}\n")
    with pytest.raises(CaseError, match="runs code of the case"):
        case_files.write_case(box_case((0.1, 0.1), 0.01), tmp_path / "template", tmp_path / "a")
    case_files.write_case(box_case((0.1, 0.1), 0.01), tmp_path / "template", tmp_path / "b", allow_code=True)


def test_code_in_a_compressed_file_is_refused(tmp_path):
    shutil.copytree(TEMPLATE, tmp_path / "template")
    (tmp_path / "template" / "constant" / "hidden.gz").write_bytes(gzip.compress(b'x #calc "1";'))
    with pytest.raises(CaseError, match="hidden.gz"):
        case_files.refuse_code(tmp_path / "template")


def test_a_folder_that_is_no_case_is_refused(tmp_path):
    with pytest.raises(CaseError, match="no OpenFOAM case"):
        case_files.write_case(box_case((0.1, 0.1), 0.01), tmp_path, tmp_path / "out")


@pytest.mark.parametrize(("kind", "says"), [("symmetryPlane", "slip_wall"), ("wedge", "whole vessel, or a slab")])
def test_patches_that_the_gas_has_not_are_refused(tmp_path, kind, says):
    """Whatever the case says of them: the line tells what to make of them."""
    folder = tmp_path / "constant" / "polyMesh"
    folder.mkdir(parents=True)
    patch = f"{{ type {kind}; nFaces 4; startFace 0; }}"
    (folder / "boundary").write_text(f"FoamFile {{ class polyBoundaryMesh; }}\n1 ( middle {patch} )\n")
    case = box_case((0.1, 0.1), 0.01, boundaries={"middle": {"kind": "slip_wall"}})
    with pytest.raises(CaseError, match=f"patch middle of the mesh of the gas is {kind}.*{says}"):
        case_files.others(case, tmp_path)


def test_gas_templates_have_the_same_schemes_and_solvers():
    """But for its mesh, and two gradients that are limited off boxes, a scene's gas is that of all."""
    found = [folder for folder in sorted(TEMPLATE.parents[1].glob("*/gas")) if folder != TEMPLATE]
    assert len(found) >= 3
    for file in (path.relative_to(TEMPLATE) for path in TEMPLATE.rglob("*") if path.is_file()):
        assert [folder for folder in found if _rows(folder / file) != _rows(TEMPLATE / file)] == []
    for folder in found:
        text = (folder / "system/fvSchemes").read_text()
        assert re.findall(r"grad\((\w+)\) +cellLimited leastSquares 1;", text) == ["T", "Y"]


def _rows(file) -> list[list[str]]:
    """Words of the lines of a template, without comments and limits of gradients."""
    text = file.read_text().replace("cellLimited leastSquares 1", "leastSquares")
    return [line.split() for line in text.splitlines() if not line.strip().startswith("//")]


def test_own_files_of_a_template_win(tmp_path):
    shutil.copytree(TEMPLATE, tmp_path / "template")
    for own in ("system/blockMeshDict", "0/T"):
        (tmp_path / "template" / own).parent.mkdir(exist_ok=True)
        (tmp_path / "template" / own).write_text("mine")
    case_files.write_case(box_case((0.1, 0.1), 0.01), tmp_path / "template", tmp_path / "out", ranks=2)
    assert (tmp_path / "out" / "system" / "blockMeshDict").read_text() == "mine"
    assert (tmp_path / "out" / "0" / "T").read_text() == "mine"
    assert "numberOfSubdomains 2;" in (tmp_path / "out" / "system" / "decomposeParDict").read_text()


@pytest.mark.parametrize("boundaries, says", [
    ({"slot": {"kind": "wall", "side": "bottom"}}, "belongs to no boundary"),
    ({"a": {"kind": "wall"}, "b": {"kind": "wall"}}, "belongs to a and b"),
    ({"a": {"kind": "wall"}, "b": {"kind": "wall", "side": "top", "span_m": [0.05, 0.3]}},
    "the box goes from 0 to 0.1"),
    ({"a": {"kind": "wall"}, "b": {"kind": "wall", "side": "top", "span_m": [0.05, 0.02]}}, r"give \[low, high\]"),
])  # fmt: skip
def test_boundaries_that_do_not_fit_are_named(boundaries, says):
    with pytest.raises(CaseError, match=says):
        block_mesh(box_case((0.1, 0.1), 0.01, boundaries=boundaries), 1.0)


def test_an_inlet_needs_a_velocity(tmp_path):
    boundaries = {"in": {"kind": "velocity_inlet", "side": "left"}, "walls": {"kind": "wall"}}
    shutil.copytree(TEMPLATE, tmp_path / "template")
    with pytest.raises(CaseError, match="boundaries.in.velocity_m_s is missing"):
        case_files.write_case(
            box_case((0.1, 0.1), 0.01, boundaries=boundaries), tmp_path / "template", tmp_path / "out"
        )


def test_more_ranks_than_slabs_are_refused(tmp_path):
    with pytest.raises(CaseError, match="coupling.gas_ranks = 21; .* has 20 cells"):
        case_files.write_decomposition(box_case((0.1, 0.2), 0.01), tmp_path, 21)


@pytest.mark.openfoam
def test_flux_through_a_slot_is_the_superficial_one(tmp_path):
    with box(tmp_path, (0.1, 0.2), 0.01, boundaries=SLOT) as gas:
        assert len(gas.mesh.volumes) == 200
        assert gas.mesh.depth == 1.0
        assert gas.mesh.volumes.sum() == pytest.approx(0.1 * 0.2)
        alpha = np.full(200, 0.5)
        gas.start(alpha, ("momentum_coefficient",))
        state = gas.advance(1e-3, {"momentum_coefficient": np.full(200, 1e3)})
    expected = 1e-3 * AIR["density_kg_m3"] * (7.5 * 0.02 + 0.08 * 0.08)
    inflow = state.budget.mass_in + 1e-3 * AIR["density_kg_m3"] * outflow(gas, state)
    assert inflow == pytest.approx(expected, rel=1e-3)


def outflow(gas, state):
    """Through the top, from the cells below it: of constant density and alpha_g as much leaves as comes in."""
    top = gas.mesh.centres[:, 1] > 0.19
    return (0.5 * state.fields["velocity"][top, 1] * 0.01).sum()


@pytest.mark.openfoam
def test_a_mesh_in_three_dimensions_with_a_window(tmp_path):
    boundaries = {
        "window": {
            "kind": "pressure_outlet",
            "side": "right",
            "span_m": [[0.02, 0.04], [0.0, 0.03]],
            "pressure_Pa": 0.0,
        },
        "lid": {"kind": "slip_wall", "side": "front"},
        "walls": {"kind": "wall"},
    }
    case = box_case((0.1, 0.06, 0.05), 0.01, boundaries=boundaries)
    case_files.write_case(case, TEMPLATE, tmp_path / "out")
    programs.run(["blockMesh"], tmp_path / "out", tmp_path / "log.blockMesh")
    check = ["checkMesh", "-case", tmp_path / "out", "-time", "0"]
    done = subprocess.run(check, env=install.environment(), capture_output=True, text=True)
    assert "Mesh OK." in done.stdout
    boundary = (tmp_path / "out" / "constant" / "polyMesh" / "boundary").read_text()
    faces = {
        name: int(boundary.partition(f"    {name}\n")[2].partition("nFaces")[2].partition(";")[0])
        for name in boundaries
    }
    assert faces == {"window": 2 * 3, "lid": 10 * 6, "walls": 2 * 10 * 5 + 2 * 6 * 5 - 6 + 10 * 6}
