"""Meshes that a user brings: cylinder, sheared box and plane taper for blockMesh, tetrahedra as a polyMesh folder."""

import itertools
from math import cos, pi, sin

import numpy as np

HEAD = "FoamFile {{ version 2.0; format ascii; class {cls}; object {name}; }}\n"
TYPES = {"wall": "wall", "frontAndBack": "empty"}
# faces of a box, bit k of a corner: upper along axis k
BOX = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3))


def cylinder(radius: float, height: float, across: int, along: int) -> str:
    """blockMeshDict of a cylinder that stands along z on (radius, radius, 0): a square core of `across` x `across`
    cells and four blocks around it; patches inlet (below), outlet (above) and wall. 16 degrees off orthogonal."""
    ring = [(r * cos(a), r * sin(a)) for r in (0.55 * radius, radius) for a in pi * np.array([0.25, 0.75, 1.25, 1.75])]
    points = [(radius + x, radius + y, z) for z in (0.0, height) for x, y in ring]
    quads = [(0, 1, 2, 3), *((4 + k, 4 + (k + 1) % 4, (k + 1) % 4, k) for k in range(4))]
    around = max(2, across // 2)
    counts = [(across, across, along), *[(across, around, along)] * 4]
    hexes = "".join(_hex([*quad, *(8 + v for v in quad)], count) for quad, count in zip(quads, counts))
    arcs = "".join(_arc(z, k, radius) for z in (0, 1) for k in range(4))
    faces = {
        "inlet": [tuple(reversed(quad)) for quad in quads],
        "outlet": [tuple(8 + v for v in quad) for quad in quads],
        "wall": [(4 + k, 4 + (k + 1) % 4, 12 + (k + 1) % 4, 12 + k) for k in range(4)],
    }
    return _block_mesh(points, hexes, faces, arcs.replace("HEIGHT", repr(height)))


def _arc(upper: int, k: int, radius: float) -> str:
    angle = pi * (0.5 + 0.5 * k)
    middle = (radius * (1 + cos(angle)), radius * (1 + sin(angle)))
    start, end = 8 * upper + 4 + k, 8 * upper + 4 + (k + 1) % 4
    return f"    arc {start} {end} ({middle[0]!r} {middle[1]!r} {'HEIGHT' if upper else '0'})\n"


def sheared_box(size: float, cells: int) -> str:
    """blockMeshDict of a cube that is pushed over along x and y; one patch, `all`."""
    points = [
        (size * (x + 0.4 * y + 0.3 * z), size * (y + 0.2 * z), size * z) for z in (0, 1) for y in (0, 1) for x in (0, 1)
    ]
    hexes = _hex((0, 1, 3, 2, 4, 5, 7, 6), [cells] * 3)
    return _block_mesh(points, hexes, {"all": BOX}, "")


def taper(floor: float, lid: float, height: float, across: int, along: int) -> str:
    """blockMeshDict of a plane vessel, `floor` [m] wide below and `lid` above; patches inlet, outlet and wall."""
    widths = [0.5 * (lid - floor), 0.5 * (lid + floor), 0.0, lid]
    points = [(x, y, z) for z in (0.0, 1.0) for x, y in zip(widths, (0.0, 0.0, height, height))]
    hexes = _hex((0, 1, 3, 2, 4, 5, 7, 6), (across, along, 1))
    faces = {"frontAndBack": BOX[:2], "wall": BOX[2:4], "inlet": BOX[4:5], "outlet": BOX[5:]}
    return _block_mesh(points, hexes, faces, "")


def turned_box(width: float, height: float, across: int, along: int, angle: float) -> str:
    """blockMeshDict of a plane box, turned by `angle` [rad] about its lower left corner; patches as of `taper`."""
    corners = [(0.0, 0.0), (width, 0.0), (0.0, height), (width, height)]
    points = [
        (x * cos(angle) - y * sin(angle), x * sin(angle) + y * cos(angle), z) for z in (0.0, 1.0) for x, y in corners
    ]
    hexes = _hex((0, 1, 3, 2, 4, 5, 7, 6), (across, along, 1))
    faces = {"frontAndBack": BOX[:2], "wall": BOX[2:4], "inlet": BOX[4:5], "outlet": BOX[5:]}
    return _block_mesh(points, hexes, faces, "")


def _block_mesh(points, hexes: str, patches, edges: str) -> str:
    vertices = "".join(f"    ({_words(map(float, point))})\n" for point in points)
    boundary = "".join(
        f"    {name} {{ type {TYPES.get(name, 'patch')}; faces ({' '.join(f'({_words(f)})' for f in faces)}); }}\n"
        for name, faces in patches.items()
    )
    head = HEAD.format(cls="dictionary", name="blockMeshDict")
    return (
        f"{head}scale "
        f"1;\nvertices\n(\n{vertices});\nblocks\n(\n{hexes});\nedges\n(\n{edges});\nboundary\n(\n{boundary});\n"
    )


def _hex(corners, counts) -> str:
    return f"    hex ({_words(corners)}) ({_words(counts)}) simpleGrading (1 1 1)\n"


def _words(values) -> str:
    return " ".join(repr(value) if isinstance(value, float) else str(value) for value in values)


def write_tetrahedra(folder, size: float, cells: int) -> None:
    """constant/polyMesh of a cube of cells^3 cubes, each cut into six tetrahedra; points off the sides are moved at
    random. One patch, `all`."""
    grid = np.linspace(0.0, 1.0, cells + 1)
    points = np.stack(np.meshgrid(grid, grid, grid, indexing="ij"), axis=-1).reshape(-1, 3)
    inner = ((points > 0.0) & (points < 1.0)).all(axis=1)
    points[inner] += np.random.default_rng(1).uniform(-0.2, 0.2, (inner.sum(), 3)) / cells
    stride = np.array([(cells + 1) ** 2, cells + 1, 1])
    first = [int(stride @ place) for place in itertools.product(range(cells), repeat=3)]
    # from corner to corner
    paths = [np.cumsum([0, *stride[list(order)]]) for order in itertools.permutations(range(3))]
    tetrahedra = np.array([corner + path for corner in first for path in paths])
    faces, owner, neighbour = _faces(points, tetrahedra)
    inside = len(neighbour)
    boundary = f"1\n(\n    all {{ type patch; nFaces {len(faces) - inside}; startFace {inside}; }}\n)\n"
    lists = {
        "points": ("vectorField", [f"({_words((size * point).tolist())})" for point in points]),
        "faces": ("faceList", [f"3({_words(face)})" for face in faces]),
        "owner": ("labelList", owner),
        "neighbour": ("labelList", neighbour),
    }
    folder.mkdir(parents=True)
    for name, (cls, rows) in lists.items():
        text = "\n".join(map(str, rows))
        (folder / name).write_text(f"{HEAD.format(cls=cls, name=name)}{len(rows)}\n(\n{text}\n)\n")
    (folder / "boundary").write_text(HEAD.format(cls="polyBoundaryMesh", name="boundary") + boundary)


def _faces(points, tetrahedra):
    """Faces, seen from outside of their owner, their owner and neighbour: inner ones first, by owner and neighbour."""
    sides = {}
    for cell, tetrahedron in enumerate(tetrahedra.tolist()):
        for k in range(4):
            face = [v for v in tetrahedron if v != tetrahedron[k]]
            a, b, c, d = points[[*face, tetrahedron[k]]]
            if np.dot(np.cross(b - a, c - a), d - a) > 0.0:  # it looks into the cell
                face.reverse()
            sides.setdefault(tuple(sorted(face)), []).append((cell, face))
    rows = [(*[cell for cell, _ in pair], *[len(tetrahedra)] * (2 - len(pair)), pair[0][1]) for pair in sides.values()]
    rows.sort(key=lambda row: (row[1] == len(tetrahedra), row[0], row[1]))
    inside = sum(row[1] < len(tetrahedra) for row in rows)
    return [row[2] for row in rows], [row[0] for row in rows], [row[1] for row in rows[:inside]]
