"""`sdph init --from-openfoam`: cases of others become cases of sdph that can be explained and run."""

import json
import tomllib

import foam_cases
import numpy as np
import own_meshes
import pytest

from coupling.openfoam import dictionary, poly_mesh
from sdph.cli import main

UP, BLOWN = "(0 0 -9.81)", "(0 0 0.25)"
openfoam = pytest.mark.openfoam


def adopted(source, folder) -> dict:
    """Table of the case made of an OpenFOAM case."""
    assert main(["init", "--from-openfoam", str(source), str(folder)]) == 0
    return tomllib.loads((folder / "case.toml").read_text())


def moved(text: str, by: float) -> str:
    """blockMeshDict of `own_meshes.cylinder` moved along x and y."""
    head, rest = text.split("vertices\n(\n")
    lines, tail = rest.split(");\nblocks")
    rows = [[float(v) for v in line.strip(" ()").split()] for line in lines.strip().split("\n")]
    lines = "".join(f"    ({x + by!r} {y + by!r} {z!r})\n" for x, y, z in rows)
    hexes, arcs = tail.split("edges\n(\n")
    arcs, patches = arcs.split(");\nboundary")
    places = [line.replace("(", "").replace(")", "").split() for line in arcs.strip().split("\n")]
    arcs = "".join(
        f"    arc {a} {b} ({float(x) + by!r} {float(y) + by!r} {z})\n" for _, a, b, x, y, z in places
    )  # fmt: skip
    return f"{head}vertices\n(\n{lines});\nblocks{hexes}edges\n(\n{arcs});\nboundary{patches}"


@openfoam
def test_a_bed_of_two_fluids_in_a_round_vessel(tmp_path, capsys):
    blocks = own_meshes.cylinder(0.05, 0.2, 4, 10)
    table = adopted(foam_cases.fluidised_bed(tmp_path / "foam", blocks, BLOWN, UP), tmp_path / "mine")
    assert table["dimensions"] == 3 and table["domain"] == {"gravity_m_s2": [0.0, 0.0, -9.81]}
    assert table["run"] == {"end_time_s": 2.0, "output_interval_s": 0.01}
    gas, grains = table["gas"], table["grains"]
    assert gas["equation_of_state"] == "operating" and gas["operating_pressure_Pa"] == 1e5
    assert gas["density_kg_m3"] == pytest.approx(1e5 * 28.9 / (8314.4626 * 300.0), rel=1e-6)
    assert gas["conductivity_W_m_K"] == pytest.approx(1.84e-5 * 1007.0 / 0.7)
    assert (grains["density_kg_m3"], grains["diameter_mm"], grains["packing_limit"]) == (2500.0, 0.3, 0.62)
    assert grains["restitution"] == 0.8 and table["friction"]["angle_deg"] == 28.5
    assert table["drag"]["law"] == "gidaspow_switch"
    assert table["particles"]["bed"] == {"shape": "walls", "volume_fraction": 0.55, "temperature_K": 300.0}
    inlet, outlet, wall = (table["boundaries"][name] for name in ("inlet", "outlet", "wall"))
    assert inlet == {"kind": "velocity_inlet", "velocity_m_s": [0.0, 0.0, 0.25], "temperature_K": 300.0}
    assert outlet["kind"] == "pressure_outlet" and outlet["pressure_Pa"] == 0.0 and wall == {"kind": "wall"}
    assert "conductivity_W_m_K = 1: our choice" in capsys.readouterr().out


@openfoam
def test_a_liquid_is_not_taken_for_grains(tmp_path, capsys):
    foam = foam_cases.fluidised_bed(tmp_path / "foam", own_meshes.cylinder(0.05, 0.2, 4, 10), BLOWN, UP)
    own = next(
        path for path in (foam / "constant").glob("thermophysicalProperties.*") if "rhoConst" in path.read_text()
    )
    own.write_text(own.read_text().replace("rhoConst", "perfectFluid"))
    assert main(["init", "--from-openfoam", str(foam), str(tmp_path / "mine")]) == 2
    assert (
        "a liquid (perfectFluid): no grains to import" in capsys.readouterr().err and not (tmp_path / "mine").exists()
    )


@openfoam
def test_what_is_made_is_explained_and_run_wherever_the_mesh_stands(tmp_path, capsys):
    """The same vessel about the origin and away from it: the domain is the box around the mesh, and grains and gas go
    the same way."""
    found = []
    for by in (0.0, -0.05):
        blocks = moved(own_meshes.cylinder(0.05, 0.2, 4, 10), by)
        folder = tmp_path / f"at{by}"
        source = foam_cases.fluidised_bed(folder / "foam", blocks, BLOWN, UP)
        adopted(source, folder / "mine")
        assert main(["explain", str(folder / "mine")]) == 0, capsys.readouterr().err
        again = folder / "run"
        assert main(["run", str(folder / "mine"), "--until", "0.002", "--out", str(again)]) == 0, (
            capsys.readouterr().err
        )
        found.append(json.loads((again / "summary.json").read_text()))
        domain = tomllib.loads((again / "case.toml").read_text())["domain"]
        assert domain.get("lower_m", [0.0] * 3) == pytest.approx([by, by, 0.0])
        assert domain["size_m"] == pytest.approx([0.1, 0.1, 0.2])
    first, second = found
    assert first["particles"] == second["particles"] > 1000 and first["windows"] == second["windows"]
    assert second["drag_heat_J"] == pytest.approx(
        first["drag_heat_J"], rel=1e-3
    )  # 7e-5: facets are of single precision


def heaped(low: float, high: float, count: int) -> str:
    """alpha.particles of a mesh of `own_meshes.cylinder`, whose cells are counted up block by block: 0.5 in some."""
    values = np.where((np.arange(count) >= low * count) & (np.arange(count) < high * count), 0.5, 0.0)
    return "nonuniform List<scalar>\n{}\n(\n{}\n)".format(count, "\n".join(map(str, values)))


@openfoam
def test_a_plane_bed_of_set_fields(tmp_path):
    """The box of setFieldsDict, cut off at the mesh, and sides of a plane mesh of any name."""
    blocks = own_meshes.taper(0.1, 0.14, 0.3, 8, 20)
    source = foam_cases.fluidised_bed(
        tmp_path / "foam", blocks, "(0 0.25 0)", "(0 -9.81 0)", "uniform 0", plane=True
    )  # fmt: skip
    box = "boxToCell { box (-1 0 -1) (1 0.12 2); fieldValues ( volScalarFieldValue alpha.particles 0.55 ); }"
    foam_cases.put(source, "system/setFieldsDict", f"regions ( {box} );\n")
    boundary = source / "constant/polyMesh/boundary"
    boundary.write_text(boundary.read_text().replace("frontAndBack", "planes"))
    table = adopted(source, tmp_path / "mine")
    bed = {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.14, 0.12], "volume_fraction": 0.55}
    assert table["dimensions"] == 2 and table["particles"]["bed"] == bed | {"temperature_K": 300.0}
    assert "planes" not in table["boundaries"] and table["boundaries"]["inlet"]["velocity_m_s"] == [0.0, 0.25]


@openfoam
def test_a_heap_keeps_its_mass(tmp_path):
    blocks = own_meshes.cylinder(0.05, 0.2, 4, 10)
    source = foam_cases.fluidised_bed(tmp_path / "foam", blocks, BLOWN, UP)
    volumes = poly_mesh.PolyMesh(source).volumes
    field = source / "0/alpha.particles"
    field.write_text(field.read_text().replace("uniform 0.55", heaped(0.1, 0.5, len(volumes))))
    table, inside = adopted(source, tmp_path / "mine"), np.arange(len(volumes))
    dense = (inside >= 0.1 * len(volumes)) & (inside < 0.5 * len(volumes))
    bed = table["particles"]["bed"]
    assert bed["shape"] == "walls" and bed["volume_fraction"] == 0.5
    assert bed["mass_kg"] == pytest.approx(2500.0 * 0.5 * volumes[dense].sum(), rel=1e-5)


@openfoam
def test_conditions_of_gas_alone(tmp_path, capsys):
    """A rate becomes a velocity, a kinematic pressure Pa; what is not known is told in one line and can be chosen."""
    conditions = {
        "inlet": ("type flowRateInletVelocity; volumetricFlowRate constant 0.002;", "type zeroGradient;"),
        "outlet": ("type inletOutlet; inletValue uniform (0 0 0);", "type totalPressure; p0 uniform 10;"),
        "wall": ("type codedFixedValue; name x;", "type zeroGradient;"),
    }
    source = foam_cases.gas_alone(tmp_path / "foam", own_meshes.cylinder(0.05, 0.2, 4, 10), conditions)
    table = adopted(source, tmp_path / "mine")
    told = capsys.readouterr().out
    area, _ = poly_mesh.PolyMesh(source).outwards("inlet")
    assert table["boundaries"]["inlet"]["velocity_m_s"] == pytest.approx([0.0, 0.0, 0.002 / area])
    assert table["boundaries"]["outlet"] == {"kind": "pressure_outlet", "pressure_Pa": 0.0}
    assert table["boundaries"]["wall"]["kind"] == "wall"
    assert "boundaries.wall: U is codedFixedValue" in told and "kEpsilon" not in told
    assert "turbulence (RAS) is left out" in told and "glass beads" in told
    text = (tmp_path / "mine/case.toml").read_text()
    assert "[boundaries.wall]  # U is codedFixedValue, p zeroGradient, which is not known" in text
    assert table["gas"]["viscosity_Pa_s"] == pytest.approx(1.5e-5 * 1.225)


def tetrahedra(folder):
    """An OpenFOAM case of a cube of tetrahedra, without fields."""
    own_meshes.write_tetrahedra(folder / "constant/polyMesh", 0.1, 2)
    foam_cases.put(folder, "system/controlDict", foam_cases.CONTROL)
    return folder


@openfoam
@pytest.mark.parametrize(
    ("condition", "told"),
    [
        ("type movingWallVelocity; value uniform (0 0 0);", "(U is movingWallVelocity)"),
        ("type fixedValue; value uniform (0 0 1.5);", "(U is fixedValue (0 0 1.5) along it)"),
    ],
)
def test_a_wall_that_moves_stands_still_and_is_told_of(tmp_path, capsys, condition, told):
    source = foam_cases.fluidised_bed(tmp_path / "foam", own_meshes.cylinder(0.05, 0.2, 4, 10), BLOWN, UP)
    velocity = source / "0" / "U.air"
    text = velocity.read_text()
    still = "wall { type fixedValue; value uniform (0 0 0); }"
    assert text.count(still) == 1
    velocity.write_text(text.replace(still, f"wall {{ {condition} }}"))
    table = adopted(source, tmp_path / "mine")
    assert table["boundaries"]["wall"] == {"kind": "wall"} and table["boundaries"]["inlet"]["kind"] == "velocity_inlet"
    (line,) = [line for line in capsys.readouterr().out.splitlines() if "wall moves" in line]
    assert line.startswith("note: boundaries.wall") and told in line and "gas/0" in line


@openfoam
def test_of_hot_walls_is_told_that_grains_do_not_feel_them(tmp_path, capsys):
    source = foam_cases.fluidised_bed(tmp_path / "foam", own_meshes.cylinder(0.05, 0.2, 4, 10), BLOWN, UP)
    heat = source / "0" / "T.air"
    text = heat.read_text()
    assert text.count("wall { type zeroGradient; }") == 1
    heat.write_text(text.replace("wall { type zeroGradient; }", "wall { type fixedValue; value uniform 400; }"))
    table = adopted(source, tmp_path / "mine")
    assert table["boundaries"]["wall"]["temperature_K"] == 400.0 and "wall_heat" not in table["effects"]
    (line,) = [line for line in capsys.readouterr().out.splitlines() if "wall_heat" in line]
    assert (
        line.startswith("note: boundaries wall: the gas feels")
        and line[6:] in (tmp_path / "mine/case.toml").read_text()
    )


def refused(capsys, *given) -> str:
    assert main(["init", *map(str, given)]) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    return error


def test_bad_input_is_told_in_one_line(tmp_path, capsys):
    made = tmp_path / "mine"
    assert "no such folder" in refused(capsys, "--from-openfoam", tmp_path / "none", made)
    (tmp_path / "empty").mkdir()
    assert "no system/controlDict" in refused(capsys, "--from-openfoam", tmp_path / "empty", made)
    foam_cases.put(tmp_path / "bare", "system/controlDict", foam_cases.CONTROL)
    foam_cases.put(tmp_path / "bare", "system/blockMeshDict", "scale 1;\n")
    (tmp_path / "bare/0").mkdir()
    assert "run blockMesh there first" in refused(capsys, "--from-openfoam", tmp_path / "bare", made)
    cube = tetrahedra(tmp_path / "cube")
    (cube / "0.25").mkdir()
    assert "no folder 0 and no 0.orig, but 0.25)" in refused(capsys, "--from-openfoam", cube, made)
    assert "SCENE DIR" in refused(capsys, made)
    assert "leave disc_cluster out" in refused(capsys, "--from-openfoam", cube, "disc_cluster", made)
    (cube / "0").mkdir()
    boundary = cube / "constant/polyMesh/boundary"
    boundary.write_text(boundary.read_text().replace("type patch", "type cyclic"))
    assert "patch all is of type cyclic" in refused(capsys, "--from-openfoam", cube, made)
    (cube / "constant/polyMesh/faces").write_text("FoamFile { format ascii; }\n3\n(\n")
    assert "missing or damaged" in refused(capsys, "--from-openfoam", cube, made)
    assert not made.exists()


def test_symmetry_becomes_a_slip_wall(tmp_path):
    """Without OpenFOAM: it is not needed to read a case."""
    cube = tetrahedra(tmp_path / "cube")
    foam_cases.put_field(cube, "U", "uniform (0 0 0)", {"all": "type symmetryPlane;"})
    boundary = cube / "constant/polyMesh/boundary"
    boundary.write_text(boundary.read_text().replace("type patch", "type symmetryPlane"))
    table = adopted(cube, tmp_path / "mine")
    assert table["boundaries"] == {"all": {"kind": "slip_wall"}}
    assert poly_mesh.patches(tmp_path / "mine/gas")["all"].kind == "patch"


def test_macros_includes_and_patterns_of_dictionaries(tmp_path):
    (tmp_path / "more").write_text("deep { value 4; }\n")
    (tmp_path / "a").write_text(
        '#include "more"\nx 2; /* y 3; */ y $x; z { w $x; v $deep.value; u #calc "1+1"; } // t 5;\n'
        'boundaryField { "(in|out)let" { type a; } inlet { type b; } ".*" { $z; } }\n'
    )
    found = dictionary.read(tmp_path / "a")
    assert found["y"] == [2.0] and found["z"] == {"w": [2.0], "v": [4.0], "u": ["#unknown", "1+1"]}
    of = found["boundaryField"]
    assert dictionary.of_patch(of, "inlet") == {"type": ["b"]}
    assert dictionary.of_patch(of, "outlet") == found["z"]  # the last pattern that fits, as in OpenFOAM
    assert dictionary.number(found["z"]["u"]) is None and "t" not in found


@openfoam
def test_meshes_are_read_as_text_and_as_binary_alike(tmp_path):
    found = []
    for form in ("ascii", "binary"):
        foam_cases.put(tmp_path / form, "system/controlDict", "")
        control = foam_cases.CONTROL.replace("ascii", form)
        foam_cases.make_mesh(tmp_path / form, own_meshes.cylinder(0.05, 0.2, 4, 10), control)
        found.append(poly_mesh.PolyMesh(tmp_path / form))
    text, binary = found
    np.testing.assert_allclose(text.volumes, binary.volumes, rtol=1e-7)
    assert text.patches == binary.patches and (text.owner == binary.owner).all()
    assert binary.volumes.sum() == pytest.approx(np.pi * 0.05**2 * 0.2, rel=0.03)
    assert binary.outwards("outlet")[1] == pytest.approx([0.0, 0.0, 1.0])


@openfoam
def test_speeds_between_grains_become_superficial(tmp_path, capsys):
    """U of two fluids is that between grains; of sdph what enters through the whole patch."""
    source = foam_cases.fluidised_bed(tmp_path / "foam", own_meshes.cylinder(0.05, 0.2, 4, 10), BLOWN, UP)
    field = source / "0/U.air"
    given = field.read_text()
    kept = given.replace("type interstitialInletVelocity; inletVelocity", "type fixedValue; value")
    field.write_text(kept.replace("value $internalField; }\n    outlet", "}\n    outlet"))
    inlet = adopted(source, tmp_path / "mine")["boundaries"]["inlet"]
    assert inlet["velocity_m_s"] == pytest.approx([0.0, 0.0, 0.25 * 0.45])
    assert "boundaries.inlet: superficial" in capsys.readouterr().out
    alpha = source / "0/alpha.particles"
    alpha.write_text(alpha.read_text().replace('".*"', 'inlet { type fixedValue; value uniform 0; }\n    ".*"'))
    alpha.write_text(alpha.read_text().replace('    ".*"', '    "(outlet|wall)"'))
    inlet = adopted(source, tmp_path / "again")["boundaries"]["inlet"]
    assert inlet["velocity_m_s"] == pytest.approx([0.0, 0.0, 0.25])


@openfoam
def test_normal_speeds_rates_of_mass_and_gas_drawn_off(tmp_path, capsys):
    conditions = {
        "inlet": ("type surfaceNormalFixedValue; refValue uniform -0.4;", "type zeroGradient;"),
        "outlet": ("type flowRateInletVelocity; massFlowRate constant -0.01; rhoInlet 2;", "type zeroGradient;"),
        "wall": ("type slip;", "type zeroGradient;"),
    }
    source = foam_cases.gas_alone(tmp_path / "foam", own_meshes.cylinder(0.05, 0.2, 4, 10), conditions)
    found = adopted(source, tmp_path / "mine")["boundaries"]
    assert found["inlet"]["velocity_m_s"] == pytest.approx([0.0, 0.0, 0.4]) and found["wall"]["kind"] == "slip_wall"
    assert found["outlet"]["kind"] == "pressure_outlet"
    assert "boundaries.outlet: gas leaves here at a given speed" in capsys.readouterr().out
