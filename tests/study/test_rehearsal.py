"""What `sdph run` refuses, `sdph explain` refuses too, in the same words, before anything is made."""

import re
import tomllib

import pytest
import tomli_w
from test_cli import refused  # noqa: F401  (a fixture)
from test_own_meshes import round_vessel

from sdph import scenes
from sdph.case import read as cases
from sdph.cli import main

EMBEDDED = "coupling.gas='embedded'"
OPENFOAM = ("--set", "coupling.gas='openfoam'")
BOX = ("tank.shape='box'", "tank.lower_m=[0,0,0]", "tank.upper_m=[1,1,1]")


@pytest.mark.parametrize(
    ("scene", "overrides", "told"),
    [
        (
            "disc_cluster",
            ("boundaries.walls.kind='velocity_inlet'", EMBEDDED),
            "boundaries.walls.velocity_m_s is missing",
        ),
        ("disc_cluster", ("boundaries.walls.side='left'", EMBEDDED), "no boundary covers all of the right side"),
        ("disc_cluster", ("boundaries.walls.side='front'",), "a case of 2 dimensions has left, right, bottom, top"),
        ("disc_cluster", ("boundaries.walls.span_m=[0.0,0.1]",), "without a side"),
        (
            "disc_cluster",
            ("boundaries.low.kind='wall'", "boundaries.low.side='bottom'", "boundaries.low.span_m=[]"),
            "give [low, high]",
        ),
        ("disc_cluster", ("domain.periodic=['x']",), "no gas solver has periodic sides"),
        (
            "disc_cluster",
            ("gas.equation_of_state='ideal'", EMBEDDED),
            "the embedded gas solver has constant and operating",
        ),
        ("disc_cluster", ("run.metrics=['nothing']",), "run.metrics = 'nothing'; known for grains"),
        ("disc_cluster", ("run.metrics=['jet']",), "the case has no nozzle"),
        ("disc_cluster", ("resolution.cell_mm=1e-4",), "GB are free here"),
        ("bubbling_bed", ("boundaries.jet.span_m=[0.123,0.3]", EMBEDDED), "no edge of a gas cell"),
        ("bubbling_bed", ("walls.mesh='none.stl'",), "walls.mesh = "),
        ("bubbling_bed", ("domain.size_m=[1e9,1e9]", "resolution.cell_mm=1e12"), "GB are free here"),
        ("evaporating_jet", ("nozzles.jet.rate_kg_s=1.0",), "either volume_fraction or rate_kg_s"),
        ("evaporating_jet", ("nozzles.jet.volume_fraction=0.9",), "above grains.packing_limit"),
        ("evaporating_jet", ("nozzles.jet.direction=[0,0]",), "it must point somewhere"),
        ("evaporating_jet", ("nozzles.jet.centre_m=[-0.1,1.5]",), "reaches out of the domain"),
        ("evaporating_jet", ("nozzles.jet.direction=[-1,0]",), "reaches out of the domain"),
        ("evaporating_jet", ("nozzles.jet.direction=[1,0.8]",), "of its 20 streams come in outside the gas"),
        ("evaporating_jet", ("nozzles.jet.width_m=9.0",), "streams come in outside the gas"),
        ("evaporating_jet", ("nozzles.jet.speed_m_s=1e8", "coupling.window_largest_s=1.0"), "GB are free here"),
        ("evaporating_jet", ("evaporation.saturation='antoine'",), "evaporation.antoine is missing"),
        ("spray_cone", ("nozzles.cone.across=[0,0,1]", "nozzles.cone.direction=[0,0,-2]"), "it must point aside"),
        ("sloshing_box", ("frame.table='none.csv'",), "frame.table = "),
        ("sloshing_box", ("frame.shake=[[0,[1.0],1.0,0.0]]",), "a row is [axis"),
        ("sloshing_box", ("run.metrics=['bubble']",), "for liquids: none"),
        ("sloshing_cassini", ("tank.outlet_radius_m=1.0",), "an outlet is narrower"),
        ("sloshing_cassini", ("tank.outlet_radius_m=5e-324",), "a pipe is a particle wide"),
        ("sloshing_cassini", (*BOX, "tank.outlet_centre_m=[0,0.5]"), "an outlet lies within the floor"),
        ("sloshing_cassini", ("drain.end_s=1.0", "drain.start_s=2.0"), "drain.end_s = 1 must come after"),
        ("sloshing_cassini", ("pools.propellant.fill=1e-9", "drain.fill=0.0"), "less than half a particle"),
        ("sloshing_cassini", ("tank.shape='mesh'", "tank.mesh='none.stl'", "tank.outlet_radius_m=0"), "tank.mesh = "),
        ("sloshing_cassini", ("tank.length_m=1e9",), "GB are free here"),
        ("sloshing_cassini", ("tank.outlet_length_m=1e9",), "GB are free here"),
        ("dam_break", ("tank.shape='mesh'",), "needs dimensions = 3"),
        ("sloshing_box", ("frame.start_s=5.0", "frame.end_s=1.0"), "frame.end_s = 1 must come after"),
        ("dam_break", ("tank.upper_m=[-1,1]",), "upper_m must lie above lower_m"),
        ("dam_break", ("tank.upper_m=[1e-6,1]",), "narrower than resolution.spacing_mm"),
        ("dam_break", ("pools.column.phase='gas'", "gas_phase.density_kg_m3=1.2"), "no particle of liquid"),
        ("oscillating_droplet", ("pools.drop.flow='rotation'",), "is that of a box"),
        ("drop_on_plate", ("pools.drop.velocity_m_s=[0,-30]",), "pools.drop begins at 30 m/s, faster than sound in it"),
        (
            "gel_droplet",
            ("bodies.shell.inner_radius_m=1e-4",),
            "no particle of the liquid is left of [pools.gel]",
        ),
        ("dam_break_3d", ("pools.column.flow='taylor_green'",), "is known in two dimensions"),
    ],
)
def test_explain_and_run_refuse_alike(refused, scene, overrides, told):  # noqa: F811
    options = [word for override in overrides for word in ("--set", override)]
    said = refused("explain", scene, *options)
    assert told in said
    free = re.compile(r"[\d.]+ GB are free")  # as others use memory meanwhile
    assert free.sub("", refused("run", scene, *options)) == free.sub("", said)


@pytest.mark.openfoam
@pytest.mark.parametrize(
    ("override", "told"),
    [
        ("boundaries.walls.kind='velocity_inlet'", "boundaries.walls.velocity_m_s is missing"),
        ("boundaries.walls.side='left'", "belongs to no boundary"),
        ("coupling.gas_ranks=1000", "has 100 cells"),
    ],
)
def test_explain_and_run_on_openfoam_refuse_alike(refused, override, told):  # noqa: F811
    options = ("disc_cluster", "--set", override, *OPENFOAM)
    said = refused("explain", *options)
    assert told in said
    assert refused("run", *options) == said


def test_openfoam_that_is_not_there_is_told_by_both(refused, monkeypatch):  # noqa: F811
    monkeypatch.setenv("SDPH_OPENFOAM", "/nowhere")
    said = refused("explain", "disc_cluster", *OPENFOAM)
    assert "OpenFOAM was not found" in said
    assert refused("run", "disc_cluster", *OPENFOAM) == said


@pytest.mark.openfoam
@pytest.mark.parametrize(
    ("override", "told"),
    [
        ("domain.size_m=[0.2,0.2,0.3]", "the mesh of the gas reaches from (0, 0, 0) to (0.2, 0.2, 0.4) m, and the"),
        ("domain.size_m=[0.2,0.2,0.5]", "leave domain.size_m and domain.lower_m out"),
        ("particles.bed.lower_m=[0.0,0.0,0.0]", "particles in no cell of the gas, the first at (0.005, 0.005, 0.005)"),
        ("nozzles.side.centre_m=[0.0,0.0,0.1]", "streams come in outside the gas"),
        ("boundaries.flue={kind='wall'}", "boundaries.flue is no patch of the mesh of the gas"),
    ],
)
def test_what_lies_beside_an_own_mesh_is_refused_by_both(tmp_path, monkeypatch, capsys, override, told):
    monkeypatch.chdir(tmp_path)
    mine = round_vessel(tmp_path / "mine", [])
    case = tomllib.loads((mine / "case.toml").read_text())
    mouth = {"centre_m": [0.1, 0.1, 0.2], "direction": [0, 0, -1], "radius_m": 0.02, "speed_m_s": 1.0}
    case["nozzles"] = {"side": mouth | {"shape": "disc", "volume_fraction": 0.1, "temperature_K": 300.0}}
    case["effects"] = [*case["effects"], "inflow"]
    (mine / "case.toml").write_text(tomli_w.dumps(case))
    capsys.readouterr()
    assert main(["explain", "mine", "--set", override, *OPENFOAM]) == 2
    said = capsys.readouterr().err.splitlines()
    assert told in said[0] and len(said) == 1
    assert main(["run", "mine", "--set", override, *OPENFOAM, "--out", "out"]) == 2
    assert capsys.readouterr().err.splitlines()[-1] == said[0] and not (tmp_path / "out").exists()


@pytest.mark.openfoam
def test_a_template_that_cannot_be_run_is_refused_by_both(refused, tmp_path):  # noqa: F811
    (tmp_path / "mine" / "gas" / "system").mkdir(parents=True)
    case = tmp_path / "mine" / "case.toml"

    case.write_text((scenes.HERE / "disc_cluster" / "case.toml").read_text())
    assert refused("explain", "mine", *OPENFOAM) == refused("run", "mine", *OPENFOAM)
    (tmp_path / "mine" / "gas" / "system" / "controlDict").write_text('libs ("mine.so");\n')
    said = refused("explain", "mine", *OPENFOAM)
    assert said == refused("run", "mine", *OPENFOAM) and "--allow-code" in said


@pytest.mark.parametrize(
    ("scene", "told"),
    [
        ("water_under_air", "[pools.air] before it takes all of its place; put [pools.water] before [pools.air]"),
        ("bubble_rise", "[pools.water] before it takes all of its place; put [pools.bubble] before [pools.water]"),
    ],
)
def test_pools_in_the_wrong_order_are_told_which_comes_first(refused, tmp_path, scene, told):  # noqa: F811
    table = cases.parsed(scenes.find(scene)[1])
    table["pools"] = dict(reversed(table["pools"].items()))
    (tmp_path / "case.toml").write_text(tomli_w.dumps(table))
    said = refused("explain", str(tmp_path))
    assert told in said and refused("run", str(tmp_path), "--out", "out") == said
