"""Patches of an OpenFOAM mesh as walls of the grains: areas, normals into the vessel, which of them hold grains."""

import numpy as np
import own_meshes
import pytest
from gas_boxes import template

from coupling.openfoam import patches
from coupling.openfoam.poly_mesh import PolyMesh
from coupling.openfoam.programs import install
from coupling.openfoam.programs import run as programs
from sdph.case.boundary import Boundary
from sdph.engine.walls import facets
from sdph.schema import CaseError

WALL, SLIP, OUTLET, INLET = (Boundary(kind=kind) for kind in ("wall", "slip_wall", "pressure_outlet", "velocity_inlet"))


def tetrahedra(tmp_path, **boundaries):
    own_meshes.write_tetrahedra(tmp_path / "constant" / "polyMesh", 0.1, 3)
    (tmp_path / "system").mkdir()
    (tmp_path / "system" / "controlDict").write_text(own_meshes.HEAD.format(cls="dictionary", name="controlDict"))
    (tmp_path / "case.foam").touch()
    return patches.facets(tmp_path, boundaries, 3)


def test_a_cube_of_tetrahedra_is_closed_and_faces_inwards(tmp_path):
    found = tetrahedra(tmp_path, all=WALL)
    surface = facets.Surface(found.corners)
    assert facets.sizes(found.corners).sum() == pytest.approx(6e-2) and surface.closed
    assert not found.slip.any() and not found.open.any() and not found.owner.any()  # the first boundary
    assert surface.distance(np.array([[0.05, 0.05, 0.03], [0.05, 0.05, -0.01]])) == pytest.approx([0.03, -0.01])


def test_kinds_of_the_case_decide_then_types_of_the_mesh(tmp_path):
    assert tetrahedra(tmp_path / "a", all=SLIP).slip.all()
    assert not tetrahedra(tmp_path / "b", all=INLET).open.any()
    assert tetrahedra(tmp_path / "c", all=OUTLET).open.all()
    assert not len(tetrahedra(tmp_path / "d").corners)  # its type is patch
    assert tetrahedra(tmp_path / "e", all=Boundary(kind="wall", catches=True)).open.all()


def test_what_is_kept_is_read_again(tmp_path):
    corners = tetrahedra(tmp_path, all=WALL).corners
    number = np.arange(len(corners))
    kept = facets.Facets(corners, number % 2 == 0, number % 5 == 0, number % 3 - 1)
    facets.save(tmp_path / "a.vtk", kept)
    for own, read in zip(kept, facets.every(str(tmp_path / "a.vtk"), 3)):
        np.testing.assert_array_equal(own, read)
    np.testing.assert_array_equal(facets.read(str(tmp_path / "a.vtk"), 3), corners[number % 5 != 0])
    assert facets.drawn(str(tmp_path / "a.vtk"), 3).n_cells == np.count_nonzero(number % 5)


def blocks(tmp_path, text):
    """A case with the mesh of a blockMeshDict."""
    own = template(tmp_path)
    (own / "system" / "blockMeshDict").write_text(text)
    (own / "case.foam").touch()
    programs.run(["blockMesh"], own, tmp_path / "log", install.environment())
    return own


@pytest.mark.openfoam
def test_a_plane_vessel_has_lines_with_itself_to_their_left(tmp_path):
    own = blocks(tmp_path, own_meshes.taper(0.2, 0.4, 0.3, 4, 6))
    every = patches.facets(own, {"inlet": INLET, "outlet": OUTLET, "wall": WALL}, 2)
    assert every.those(every.open).owner.tolist() == [1] * 4  # the outlet, four cells wide
    corners, _, _, owners = every.those(~every.open)
    assert facets.sizes(corners[owners == 0]).sum() == pytest.approx(0.2) and set(owners) == {0, 2}
    assert facets.sizes(corners).sum() == pytest.approx(0.2 + 2.0 * np.hypot(0.1, 0.3))
    inside = facets.Surface(corners).distance(np.array([[0.2, 0.02], [0.08, 0.15], [0.02, 0.1]]))
    assert inside[0] == pytest.approx(0.02) and inside[1] > 0.0 > inside[2]


@pytest.mark.openfoam
@pytest.mark.parametrize("dimensions, text", [(2, own_meshes.taper(0.2, 0.4, 0.3, 4, 6)),
                                              (3, own_meshes.cylinder(0.1, 0.4, 4, 8))])  # fmt: skip
def test_walls_are_foreseen_as_they_will_be(tmp_path, dimensions, text):
    own = blocks(tmp_path, text)
    kinds = {"inlet": INLET, "outlet": OUTLET, "wall": SLIP}
    made, foreseen = patches.facets(own, kinds, dimensions), patches.of_mesh(PolyMesh(own), kinds, dimensions)
    assert facets.sizes(foreseen.corners).sum() == pytest.approx(facets.sizes(made.corners).sum(), rel=1e-6)
    assert foreseen.slip.sum() == made.slip.sum() > 0 and foreseen.open.sum() == made.open.sum() > 0
    assert set(foreseen.owner) == set(made.owner) == {0, 1, 2}
    places = np.array([[0.15, 0.02, 0.1], [0.1, 0.18, 0.2], [0.02, 0.1, 0.3]])[:, :dimensions]
    off = [facets.Surface(corners).distance(places) for corners, *_ in (made, foreseen)]
    np.testing.assert_allclose(*off, atol=1e-7)


@pytest.mark.openfoam
def test_front_and_back_of_a_plane_mesh_that_are_walls_are_refused_in_one_line(tmp_path):
    own = blocks(tmp_path, own_meshes.taper(0.2, 0.4, 0.3, 4, 6).replace("type empty", "type wall"))
    with pytest.raises(CaseError, match="lies in the plane of a case in two dimensions; give front and back"):
        patches.of_mesh(PolyMesh(own), {"inlet": INLET, "outlet": OUTLET, "wall": WALL}, 2)


@pytest.mark.openfoam
def test_fields_that_leave_the_sides_of_a_plane_mesh_out_flood_no_terminal(tmp_path, capfd):
    """OpenFOAM needs no entry for them; VTK would warn of each field."""
    own = blocks(tmp_path, own_meshes.taper(0.2, 0.4, 0.3, 4, 6))
    (own / "1").mkdir()
    head = own_meshes.HEAD.format(cls="volScalarField", name="T") + "dimensions [0 0 0 1 0 0 0];\n"
    inside = 'internalField uniform 300;\nboundaryField { inlet { type zeroGradient; } "(o|w).*" { $inlet; } }\n'
    (own / "1" / "T").write_text(head + inside)
    patches.facets(own, {"inlet": INLET, "outlet": OUTLET, "wall": WALL}, 2)
    told = capfd.readouterr()
    assert "not found" not in told.out + told.err


@pytest.mark.openfoam
def test_a_round_vessel_has_its_area(tmp_path):
    own = blocks(tmp_path, own_meshes.cylinder(0.1, 0.4, 4, 8))
    corners, *_ = patches.facets(own, {}, 3)  # its type alone: wall
    assert facets.sizes(corners).sum() == pytest.approx(2.0 * np.pi * 0.1 * 0.4, rel=0.03)  # chords for arcs
    assert facets.Surface(corners).distance(np.array([[0.1, 0.1, 0.2]])) == pytest.approx([0.1], rel=0.05)
