"""Edges of cells, jumps from one to the next, and what a two-fluid solver that breaks down on them is told."""

import shutil
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from coupling.gas import GasError, Mesh
from coupling.openfoam import cell_sizes
from coupling.openfoam.case import HEAD
from coupling.openfoam.cell_sizes import edges, largest_jump, middles
from coupling.openfoam.comparators import remedies
from coupling.openfoam.comparators import run as comparators
from coupling.openfoam.solver import OpenFoamGas
from sdph import scenes
from sdph.case import read as cases
from sdph.scenes import paths
from tests.study.test_two_fluid_in_vessels import case

FPE = "twoPhaseEulerFoam was killed by SIGFPE at 0.01 s: Floating point exception (log: log)"


def row(widths, height=0.01, depth=0.3):
    """A row of boxes along x as a `PolyMesh` has them."""
    x, count = np.concatenate(([0.0], np.cumsum(widths))), len(widths)
    points = np.array([(at, y, z) for at in x for y in (0.0, height) for z in (0.0, depth)])
    planes = [[4 * k, 4 * k + 2, 4 * k + 3, 4 * k + 1] for k in range(count + 1)]  # normal along x
    sides = [
        [4 * k + a, 4 * k + b, 4 * k + 4 + b, 4 * k + 4 + a]
        for k in range(count) for a, b in ((1, 0), (0, 2), (2, 3), (3, 1))
    ]  # fmt: skip
    faces = np.array([*planes[1:-1], planes[0], planes[-1], *sides])
    a, b, c, d = points[faces].transpose(1, 0, 2)
    return SimpleNamespace(
        points=points, corners=faces.ravel(), first=np.arange(0, 4 * len(faces) + 1, 4),
        owner=np.array([*range(count - 1), 0, count - 1, *np.repeat(range(count), 4)]),
        neighbour=np.arange(1, count), areas=0.5 * np.cross(c - a, d - b), centres=(a + b + c + d) / 4.0,
    )  # fmt: skip


def test_edges_are_those_in_the_plane_of_a_plane_mesh():
    mesh = row([0.01, 0.02, 0.004])
    own = edges(mesh, 2)
    assert own.longest == pytest.approx([0.01, 0.02, 0.01]) and own.shortest == pytest.approx([0.01, 0.01, 0.004])
    assert own.middles == pytest.approx(np.array([[0.005, 0.005], [0.02, 0.005], [0.032, 0.005]]))
    assert edges(mesh, 3).longest == pytest.approx([0.3, 0.3, 0.3])
    assert middles(mesh)[:, 2] == pytest.approx(0.15)


def test_the_largest_jump_is_found_with_its_place():
    ratio, place = largest_jump(row([0.01, 0.011, 0.022, 0.02]))
    assert ratio == pytest.approx(2.0) and place == pytest.approx([0.021, 0.005, 0.15])
    assert largest_jump(row([0.01]))[0] == 1.0


@pytest.mark.parametrize(
    ("widths", "told"),
    [([0.01, 0.0119, 0.014], "step of 0.002 s"), ([0.01, 0.0122], "jump in width by 1.22 at (0.01,")],
)
def test_a_floating_point_error_is_told_with_what_to_change(widths, told):
    assert told in remedies.remedy(FPE, row(widths), 2e-3)
    assert told in remedies.remedy("mpirun ended with code 136", row(widths), 2e-3)
    assert remedies.remedy("twoPhaseEulerFoam was killed by SIGKILL at 0.01 s", row(widths), 2e-3) == ""
    assert "run.output_interval_s of 0.001 or less" in remedies.remedy(FPE, None, 2e-3)


@pytest.mark.parametrize(("end", "told"), [(FPE, True), ("blockMesh ended with code 1: no such patch", False)])
def test_who_compares_is_told_so(end, told, tmp_path, monkeypatch):
    def breaks(*_):
        raise GasError(end)

    monkeypatch.setattr(comparators, "_run", breaks)
    with pytest.raises(GasError) as error:
        comparators.run_two_fluid(case(0.0), tmp_path)
    line = str(error.value)
    assert line.startswith(end) and ("run.output_interval_s" in line) == told and "\n" not in line


@pytest.mark.openfoam
def test_places_spread_in_cells_are_of_these_cells_however_many_processes_tell_them(tmp_path):
    """Half way to the corners: twice as far out they are the cell itself, in a vessel whose cells widen upwards."""
    told, template = [], tmp_path / "template"
    shutil.copytree(paths.gas_template("tapered_bed"), template)
    cut = "numberOfSubdomains 2; method simple; simpleCoeffs { n (2 1 1); delta 0.001; }"  # across the order of cells
    (template / "system" / "decomposeParDict").write_text(HEAD.format(name="decomposeParDict") + cut)
    for ranks in (1, 2):
        known = cases.load(scenes.find("tapered_bed")[1], (f"coupling.gas_ranks={ranks}",))
        gas = OpenFoamGas(known, tmp_path / str(ranks), template)
        gas.close()
        mesh = gas.mesh
        places, cell = mesh.spread
        own = places[np.argsort(cell, kind="stable")].reshape(len(mesh.volumes), 8, 3)
        np.testing.assert_allclose(own.mean(axis=1), mesh.centres * (1.0, 1.0, 0.0), atol=1e-9)
        areas = [
            ConvexHull(mesh.centres[c, :2] + 2.0 * (own[c, :, :2] - mesh.centres[c, :2])).volume
            for c in range(len(own))
        ]
        np.testing.assert_allclose(areas, mesh.volumes / mesh.depth, rtol=1e-6)
        told.append(own[np.lexsort(np.round(mesh.centres[:, :2], 7).T)])
    np.testing.assert_allclose(told[1], told[0], atol=1e-9)
    box = Mesh(np.zeros((1, 3)), np.array([np.prod(known.domain.size)]), 2)
    assert cell_sizes.spread(box, known, tmp_path / "nowhere") is box
