"""Gas alone on a mesh with cyclic patches: it goes round, keeps its momentum, and what does not go round is refused."""

import dataclasses

import numpy as np
import own_meshes
import pytest
from gas_boxes import box_case, template, total

from coupling.openfoam import case as case_files
from coupling.openfoam.solver import OpenFoamGas
from sdph.schema import CaseError

WALLS = {"floor": {"kind": "wall"}, "lid": {"kind": "wall"}}
# sides of a box: numbers of BOX, and the patch on the other side where that is cyclic
SIDES = {"front": (0, "back"), "back": (1, "front"), "left": (2, "right"), "right": (3, "left"), "floor": (4, None),
         "lid": (5, None)}  # fmt: skip
SIZE, CELLS = 0.08, 8  # m, along each axis


def kind_of(other: str | None) -> str:
    return f"type cyclic; neighbourPatch {other};" if other else "type wall;"


def round_box() -> str:
    """blockMeshDict of a cube that is cyclic along x and z."""
    points = [(x, y, z) for z in (0.0, SIZE) for y in (0.0, SIZE) for x in (0.0, SIZE)]
    vertices = "".join(f"({x} {y} {z})\n" for x, y, z in points)
    faces = {name: " ".join(map(str, own_meshes.BOX[number])) for name, (number, _) in SIDES.items()}
    rows = "".join(f"{name} {{ {kind_of(SIDES[name][1])} faces (({face})); }}\n" for name, face in faces.items())
    head = own_meshes.HEAD.format(cls="dictionary", name="blockMeshDict")
    block = f"hex (0 1 3 2 4 5 7 6) ({CELLS} {CELLS} {CELLS}) simpleGrading (1 1 1)"
    return f"{head}scale 1;\nvertices\n(\n{vertices});\nblocks ( {block} );\nedges ();\nboundary\n(\n{rows});\n"


def pushed(folder, along: int, ranks: int = 1):
    """Velocity (z, y, x, 3) [m/s] of gas that a force pushes for 20 ms, `along` cells further along x and z, its
    momentum (3,) [kg m/s], and what the budget says that this is of. Rolled so that all lie alike."""
    own = template(folder)
    (own / "system/blockMeshDict").write_text(round_box())
    numbers = own / "system/fvSolution"
    numbers.write_text(numbers.read_text().replace("1e-7;", "1e-13;").replace("1e-9;", "1e-14;"))
    case = box_case([SIZE] * 3, SIZE / CELLS, boundaries=WALLS, ranks=ranks)
    gas = OpenFoamGas(case, folder / "gas", own)
    try:
        x, y, z = (2.0 * np.pi * gas.mesh.centres / SIZE).T
        shift = 2.0 * np.pi * along / CELLS
        force = 20.0 * np.stack([2.0 + np.cos(z - shift), np.sin(x - shift), np.cos(x - shift + y)], axis=1)
        gas.start(None, ("momentum",))
        for _ in range(10):
            state = gas.advance(2e-3, {"momentum": force})
        momentum = total(gas, state.fields["density"][:, None] * state.fields["velocity"])
        place = np.lexsort(np.floor(gas.mesh.centres / SIZE * CELLS).T)
    finally:
        gas.close()
    velocity = state.fields["velocity"][place].reshape(CELLS, CELLS, CELLS, 3)
    given = np.sum([getattr(state.budget, f"impulse_{of}") for of in ("exchange", "walls", "pressure")], axis=0)
    return np.roll(velocity, (-along, -along), axis=(0, 2)), momentum, given


@pytest.mark.openfoam
def test_gas_goes_round_through_cyclic_sides(tmp_path):
    """Nothing tells where a box that goes round is cut: what is three cells further on flows the same."""
    here, momentum, given = pushed(tmp_path / "here", 0)
    there, _, _ = pushed(tmp_path / "there", 3)
    size = np.abs(here).max()
    through = np.abs(here[:, :, 0] - here[:, :, -1]).max()
    print(f"largest {size:.3f} m/s, off {np.abs(here - there).max() / size:.1e}, beside the cut {through:.3f} m/s")
    assert np.abs(here - there).max() < 1e-9 * size
    assert momentum[0] > 0.0 and momentum == pytest.approx(given, abs=1e-4 * momentum[0])  # numerical, 9e-6


@pytest.mark.openfoam
def test_processes_share_a_mesh_that_goes_round(tmp_path):
    alone, _, _ = pushed(tmp_path / "one", 0)
    both, _, _ = pushed(tmp_path / "two", 0, ranks=2)
    assert np.abs(alone - both).max() < 1e-9 * np.abs(alone).max()


def one_cell(folder, right=(1.0, 1.0), sides=SIDES, around=("left", "right")):
    """constant/polyMesh of one cell whose sides `around` are cyclic; its right side is at x = `right` [m] below and
    above."""
    points = [(x * right[y], y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    place = folder / "constant/polyMesh"
    place.mkdir(parents=True)
    lists = {
        "points": [f"({x} {y} {z})" for x, y, z in points],
        "faces": [f"4({' '.join(map(str, face))})" for face in own_meshes.BOX],
        "owner": ["0"] * 6,
        "neighbour": [],
    }
    rows = [f"{name} {{ {kind_of(other if name in around else None)} nFaces 1; startFace {number}; }}"
            for name, (number, other) in sides.items()]  # fmt: skip
    rows.append("none { type cyclic; neighbourPatch left; nFaces 0; startFace 6; }")
    for name, own in (lists | {"boundary": rows}).items():
        head = own_meshes.HEAD.format(cls="list", name=name)
        (place / name).write_text(f"{head}{len(own)}\n(\n{chr(10).join(own)}\n)\n")
    return folder


def test_cyclic_patches_need_no_boundary_of_the_case(tmp_path):
    found = case_files.others(box_case([1.0] * 3, 1.0, boundaries=WALLS, gravity=(0.0, -9.81, 0.0)), one_cell(tmp_path))
    assert found == {"front": "wall", "back": "wall", "left": "cyclic", "right": "cyclic", "none": "cyclic"}
    made = case_files.start_fields(box_case([1.0] * 3, 1.0, boundaries=WALLS), found)
    assert all("left { type cyclic; }" in text for text in made.values())


@pytest.mark.parametrize(("given", "right", "says"), [
    ({"gravity": (9.81, 0.0, 0.0)}, (1.0, 1.0), "domain.gravity_m_s2 is along them"),
    ({"boundaries": WALLS | {"left": {"kind": "wall"}}}, (1.0, 1.0), "left .* is cyclic: leave boundaries.left out"),
    ({}, (1.0, 2.0), "not opposite each other"),
])  # fmt: skip
def test_what_does_not_go_round_is_refused(tmp_path, given, right, says):
    with pytest.raises(CaseError, match=says) as told:
        case_files.others(box_case([1.0] * 3, 1.0, **({"boundaries": WALLS} | given)), one_cell(tmp_path, right))
    assert "\n" not in str(told.value)


def test_sides_that_turn_the_gas_are_refused(tmp_path):
    """Left to the floor and right to the lid: areas of all four together are nothing, as those of two pairs ahead."""
    pairs = ("left", "floor", "right", "lid")
    turned = SIDES | {name: (SIDES[name][0], pairs[k ^ 1]) for k, name in enumerate(pairs)}
    with pytest.raises(CaseError, match="left and floor not opposite each other"):
        case_files.others(box_case([1.0] * 3, 1.0, boundaries={}), one_cell(tmp_path, sides=turned, around=pairs))


@pytest.mark.parametrize("group", ["particles", "nozzles"])
def test_particles_do_not_go_round(tmp_path, group):
    case = dataclasses.replace(box_case([1.0] * 3, 1.0, boundaries=WALLS), **{group: {"some": None}})
    with pytest.raises(CaseError, match="left, right.* particles do not go round with the gas"):
        case_files.others(case, one_cell(tmp_path))
