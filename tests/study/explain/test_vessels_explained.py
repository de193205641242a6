"""What `sdph explain` says of vessels: gas with no way out, and the mesh that a case brings."""

import itertools
import json
import shutil
import tomllib

import foam_cases
import numpy as np
import own_meshes
import pytest

import sdph
from coupling.openfoam import poly_mesh
from sdph import scenes
from sdph.case import read as cases
from sdph.cli import main
from sdph.scenes import paths
from sdph.schema import CaseError
from sdph.study import closed_vessels, inlets, rehearsal
from sdph.study.explain import estimate, prices, tables
from tests.coupling.openfoam.test_cell_sizes import row

BED = scenes.HERE / "bubbling_bed" / "case.toml"


def judged(*overrides: str) -> None:
    closed_vessels.refuse_filling(cases.load(BED, overrides), paths.gas_template("bubbling_bed"))


def test_gas_that_finds_no_way_out_is_refused_in_one_line(capsys):
    closed = "boundaries.outlet.kind='wall'"
    with pytest.raises(CaseError, match=r"boundaries.jet is a velocity_inlet, and 0.188 m2/s"):  # 0.02 7.5 + 0.48 0.08
        judged(closed)
    judged()
    judged(closed, "gas.equation_of_state='ideal'")  # it fills up
    judged("boundaries.outlet.kind='velocity_inlet'", "boundaries.outlet.velocity_m_s=[0.0, 0.3768]")  # 0.1884/0.5
    with pytest.raises(CaseError, match="find no way out"):
        judged("boundaries.outlet.kind='velocity_inlet'", "boundaries.outlet.velocity_m_s=[0.0, 0.3]")
    assert main(["explain", "bubbling_bed", "--set", closed]) == 2
    assert capsys.readouterr().err.count("\n") == 1


def made(tmp_path):
    """A round vessel from an OpenFOAM case, as `sdph init` makes it."""
    source = foam_cases.fluidised_bed(
        tmp_path / "foam", own_meshes.cylinder(0.05, 0.2, 4, 10), "(0 0 0.25)", "(0 0 -9.81)"
    )
    assert main(["init", "--from-openfoam", str(source), str(tmp_path / "mine")]) == 0
    return tmp_path / "mine"


@pytest.mark.openfoam
def test_an_own_mesh_is_counted_and_priced_as_openfoams(tmp_path, capsys):
    """Cells and particles are those that a run has, not those of the box around the mesh."""
    mine = made(tmp_path)
    capsys.readouterr()
    assert main(["explain", str(mine), "--json"]) == 0
    rows = {row["what"]: row for row in json.loads(capsys.readouterr().out)["expected"]}
    assert rows["gas cells"]["value"] == len(poly_mesh.PolyMesh(mine / "gas").volumes) == 480
    assert rows["particles"]["value"] == pytest.approx(3483, abs=5)  # the box would hold 5292
    assert "OpenFOAM gas" in rows["wall time"]["how"]
    key = "resolution.cell_mm=25"
    ratios = {row["ratio"]: row["value"] for row in explained(capsys, mine, "--set", key)["ratios"]}
    spacing = 1e-3 * tomllib.loads((mine / "case.toml").read_text())["resolution"]["spacing_mm"]
    assert ratios["cell / h"] == pytest.approx(0.02 / ratios["h / spacing"] / spacing)  # they are 20 mm high


@pytest.mark.openfoam
def test_a_closed_vessel_of_ones_own_is_refused(tmp_path, capsys):
    mine = made(tmp_path)
    shut = ("--set", "boundaries.outlet.kind='wall'", "--set", "gas.equation_of_state='constant'")
    capsys.readouterr()
    assert main(["explain", str(mine), *shut]) == 2
    assert "boundaries.inlet is a velocity_inlet" in capsys.readouterr().err


@pytest.mark.parametrize("edges, told", [
    ((0.008, 0.02), ""), ((0.02, 0.02), ""), ((0.012, 0.012), "are 12 mm"), ((0.031, 0.05), "are 31 to 50 mm"),
    (None, ""),
])  # fmt: skip
def test_cells_that_are_not_those_of_the_mesh_are_told(edges, told):
    """Windows are chosen by resolution.cell_mm, 20 mm here."""
    case = cases.load(BED, ("resolution.cell_mm=20",))
    found = [text for text in estimate.warnings(case, edges) if text.startswith("resolution.cell_mm")]
    assert len(found) == bool(told) and told in "".join(found)


def test_cells_of_an_own_mesh_are_judged_where_grains_stand():
    """Not by resolution.cell_mm, and by the largest: one of 20 mm among grains, one of 90 mm far above them."""
    mesh = row([0.01, 0.02, 0.01, 0.09])
    box = {"shape": "box", "lower_m": [0.0, 0.0], "upper_m": [0.035, 0.01], "volume_fraction": 0.5}
    own = {
        "resolution": {"spacing_mm": 4.0, "cell_mm": 5.0},
        "domain": {"size_m": [0.13, 0.01], "gravity_m_s2": [0, -9.81]},
    }
    table = (
        cases.parsed(BED)
        | {"particles": {"bed": box | {"temperature_K": 300.0}}}
        | own
        | {"boundaries": {}, "probes": {}}
    )
    case = cases.from_table(table)
    edges = rehearsal._edges(case, mesh)
    assert edges[:2] == pytest.approx((0.01, 0.02)) and edges[2] == pytest.approx([0.01] * 3)
    told = {own["ratio"]: own["value"] for own in estimate.ratios(case, edges)}
    assert told["cell / h"] == pytest.approx(0.02 / case.smoothing_length)
    assert told["cell / grain"] == pytest.approx(0.01 / case.grains.sauter_diameter)
    far = cases.from_table(table | {"resolution": {"spacing_mm": 2.0, "cell_mm": 5.0}})
    assert not [line for line in estimate.warnings(far) if line.startswith("cell / h")]
    priced = prices.by_openfoam(4)._replace(edges=edges)
    assert [line for line in tables.warnings(far, None, priced) if line.startswith("cell / h = 6.67")]


def test_one_sliver_among_many_cells_is_told_as_such():
    """Of 250 cells one is smaller than three grains: it is judged, and how many there are is said."""
    case = cases.from_table(cases.parsed(BED))
    d = case.grains.sauter_diameter
    each = np.full(250, 4.0 * d)
    each[7] = 0.194 * d
    (row_,) = (own for own in estimate.ratios(case, (0.194 * d, 4.0 * d, each)) if own["ratio"] == "cell / grain")
    assert row_["safe"] == "NO" and row_["why"].startswith("that is the smallest cell, 0.4 % of cells are below; drag")
    each[7] = 3.5 * d
    (row_,) = (own for own in estimate.ratios(case, (3.5 * d, 4.0 * d, each)) if own["ratio"] == "cell / grain")
    assert row_["safe"] == "yes" and row_["why"] == estimate.GRAINS_WHY


def test_where_no_grains_stand_the_cells_in_the_middle_are_judged():
    case = cases.from_table(cases.parsed(BED) | {"particles": {}})
    assert rehearsal._edges(case, row([0.01, 0.02, 0.01, 0.09, 0.008]))[:2] == pytest.approx((0.01, 0.01))


def explained(capsys, *words):
    capsys.readouterr()
    assert main(["explain", *map(str, words), "--json"]) == 0
    return json.loads(capsys.readouterr().out)


@pytest.mark.openfoam
def test_a_mesh_that_is_still_to_be_made_is_counted_as_one_that_is(tmp_path, capsys):
    """The same vessel by its blockMeshDict alone: rows of explain are those of its polyMesh, and nothing is left."""
    mine = made(tmp_path)
    by_mesh = explained(capsys, mine)
    shutil.rmtree(mine / "gas" / poly_mesh.FOLDER)
    (mine / "gas" / poly_mesh.BLOCKS).write_text(own_meshes.cylinder(0.05, 0.2, 4, 10))
    before = sorted(mine.rglob("*"))
    by_blocks = explained(capsys, mine)
    assert by_blocks == by_mesh and sorted(mine.rglob("*")) == before
    assert sdph.explain(mine) == sdph.explain(str(mine))
    rows = {row["what"]: row["value"] for row in sdph.explain(mine)["expected"]}
    assert rows["gas cells"] == 480 and rows["particles"] == pytest.approx(3483, abs=5)
    shut = ("--set", "boundaries.outlet.kind='wall'", "--set", "gas.equation_of_state='constant'")
    assert main(["explain", str(mine), *shut]) == 2
    assert "boundaries.inlet is a velocity_inlet" in capsys.readouterr().err


@pytest.mark.openfoam
def test_grains_that_reach_an_outlet_of_ones_own_mesh_call_for_outflow(tmp_path, capsys):
    """Of a vessel whose mouth is below: without sides its patches were known to no judgement."""
    mine = made(tmp_path)
    text = (mine / "case.toml").read_text()
    table = tomllib.loads(text)
    assert not any("side" in own for own in table["boundaries"].values())
    below = ("--set", "boundaries.inlet={kind='pressure_outlet'}", "--set", "run.end_time_s=1.0")
    row = next(row for row in explained(capsys, mine, *below)["effects"] if row["effect"] == "outflow")
    assert row["called for"] == "yes" and row["error if off"] == 1.0


def test_a_patch_is_all_of_its_side_or_a_span_of_it(tmp_path):
    """A plate and a hole in it lie in one side, each over its span; the wall of a round vessel lies in none."""
    source = tmp_path / "ring"
    own_meshes.write_tetrahedra(source / "constant" / "polyMesh", 0.1, 4)
    mesh = poly_mesh.PolyMesh(source)
    faces = mesh.patches["all"].faces
    middles = mesh.centres[faces]
    assert mesh.spans((0.0, 0.0, 0.0), (0.1, 0.1, 0.1)) == {}
    order = np.argsort(~(middles[:, 2] < 1e-9), kind="stable") + faces.start  # those of the lower side first
    below, hole = int((middles[:, 2] < 1e-9).sum()), 1
    assert below > 2
    mesh.centres[faces], corners = mesh.centres[order], [mesh.corners[mesh.first[k] : mesh.first[k + 1]] for k in order]
    mesh.corners[mesh.first[faces.start] :] = np.concatenate(corners)
    ends = faces.start, faces.start + hole, faces.start + below, faces.stop
    mesh.patches = {name: poly_mesh.Patch("patch", slice(*pair)) for name, pair in zip("abc", itertools.pairwise(ends))}
    found = mesh.spans((0.0, 0.0, 0.0), (0.1, 0.1, 0.1))
    assert set(found) == {"a", "b"} and found["a"][0] == found["b"][0] == "back"
    assert all(0.0 <= low < high <= 0.051 for low, high in found["a"][1])
    mesh.patches = {"floor": poly_mesh.Patch("patch", slice(ends[0], ends[2])), "c": mesh.patches["c"]}
    assert mesh.spans((0.0, 0.0, 0.0), (0.1, 0.1, 0.1)) == {"floor": ("back", None)}


@pytest.mark.openfoam
@pytest.mark.parametrize("blocks", [False, True])
def test_an_inlet_that_sucks_is_warned_of(tmp_path, capsys, blocks):
    mine = made(tmp_path)
    if blocks:
        shutil.rmtree(mine / "gas" / poly_mesh.FOLDER)
        (mine / "gas" / poly_mesh.BLOCKS).write_text(own_meshes.cylinder(0.05, 0.2, 4, 10))
    out = ("--set", "boundaries.inlet.velocity_m_s=[0.0, 0.0, -0.25]")
    told = [row["warning"] for row in explained(capsys, mine, *out)["warnings"]]
    assert (
        sum("boundaries.inlet is a velocity_inlet" in text and "points out of the domain" in text for text in told) == 1
    )
    assert not any("points out" in row["warning"] for row in explained(capsys, mine)["warnings"])


def test_an_inlet_that_sucks_is_warned_of_by_a_run_of_a_box(tmp_path, capsys):
    """By its side; one that runs along it lets nothing in, through no side in particular there is nothing to say."""
    case = cases.load(BED, ("boundaries.distributor.velocity_m_s=[0.0, -0.1]",))
    assert ["boundaries.distributor" in text for text in inlets.warnings(case, tmp_path)] == [True]
    along = cases.load(BED, ("boundaries.distributor.velocity_m_s=[0.3, 0.0]",))
    assert ["lets no gas in" in text for text in inlets.warnings(along, tmp_path)] == [True]
    assert inlets.warnings(cases.load(BED), tmp_path) == []
    words = ("resolution.spacing_mm=20", "resolution.cell_mm=20", "run.end_time_s=1e-4", "run.output_interval_s=1e-4")
    words += ("boundaries.distributor.velocity_m_s=[0.0, -0.1]",)
    options = [word for text in words for word in ("--set", text)]
    assert main(["run", "bubbling_bed", "--gas", "embedded", *options, "--out", str(tmp_path / "out")]) == 0
    assert "warning: boundaries.distributor is a velocity_inlet" in capsys.readouterr().err


def test_heat_is_left_out_of_the_numbers_of_a_case_without_any():
    table = cases.to_table(cases.load(BED))
    for warm in (True, False):
        names = [row["number"] for row in tables.explain(cases.from_table(table))["numbers"]]
        assert ("Biot" in names) is warm and ("run / heat time" in names) is warm and "alpha_p" in names
        table["effects"] = [name for name in table["effects"] if name not in ("heat", "conduction")]
        for name in ("heat", "conduction"):
            table.pop(name, None)
        for own in (table["gas"], *table["particles"].values(), *table["boundaries"].values()):
            if "temperature_K" in own:
                own["temperature_K"] = 300.0


def test_a_nozzle_at_a_side_but_for_the_digits_of_a_mesh_is_let_be():
    """Text files of six digits leave a tenth of a micrometre; a millimetre is an error still."""
    jet = scenes.HERE / "evaporating_jet" / "case.toml"
    size = cases.load(jet).domain.size
    cases.load(jet, ("domain.lower_m=[1e-7, 0.0]", f"domain.size_m=[{size[0] - 1e-7!r}, {size[1]!r}]"))
    with pytest.raises(CaseError, match="nozzles.jet.centre_m = .* reaches out of the domain"):
        cases.load(jet, ("domain.lower_m=[1e-3, 0.0]",))
