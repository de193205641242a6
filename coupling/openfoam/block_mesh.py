"""system/blockMeshDict of a box: blocks split where a boundary begins or ends on a side, patches named as in the
case."""

from __future__ import annotations

import itertools

from sdph.case.gas_cells import cell_edges, nearest_edge
from sdph.engine.geometry import SIDES
from sdph.schema import CaseError

# vertices (of the eight of a block, bit k: upper along axis k) of the lower and upper face of each axis, seen from
# outside
FACES = {
    0: ((0, 4, 6, 2), (1, 3, 7, 5)),
    1: ((0, 1, 5, 4), (2, 6, 7, 3)),
    2: ((0, 2, 3, 1), (4, 5, 7, 6)),
}
BLOCK_ORDER = (0, 1, 3, 2, 4, 5, 7, 6)  # of the same eight, as blockMesh wants them
CLOSE = 1e-9  # of the size of the box: two edges are the same


def block_mesh(case, depth: float) -> str:
    """The dictionary, less its head; a two-dimensional case is one cell of `depth` [m] deep."""
    size = [*case.domain.size, *[depth] * (3 - case.dimensions)]
    edges = [_edges(case, axis, size[axis]) for axis in range(3)]
    cells = [_cells(case, axis, edges[axis]) for axis in range(3)]
    blocks = list(itertools.product(*(range(len(e) - 1) for e in edges)))
    vertices = "".join(f"    ({x!r} {y!r} {z!r})\n" for z, y, x in itertools.product(*reversed(edges)))
    lines = "".join(_block_line(block, edges, cells) for block in blocks)
    patches = "".join(_patch(name, kind, faces) for name, (kind, faces) in _patches(case, blocks, edges).items())
    head = f"scale 1;\nvertices\n(\n{vertices});\nblocks\n(\n{lines});\nedges ();\n"
    return f"{head}boundary\n(\n{patches});\nmergePatchPairs ();\n"


def _edges(case, axis: int, length: float) -> list[float]:
    """Places along an axis where blocks meet."""
    found = {0.0, length}
    for boundary in case.boundaries.values():
        for along, (low, high) in _spans(boundary, case.dimensions):
            if along == axis:
                found |= {low, high}
    edges = sorted(found)
    if edges[0] < 0.0 or edges[-1] > length:
        raise CaseError(
            f"a span_m goes from {edges[0]:g} to {edges[-1]:g} m; the box goes from 0 to {length:g} m there"
        )
    return [a for a, b in itertools.pairwise(edges) if b - a > CLOSE * length] + [length]


def _spans(boundary, dimensions: int) -> list[tuple[int, tuple[float, float]]]:
    """(axis, (low, high)) of a boundary that is a part of its side."""
    if boundary.side is None or boundary.span is None:
        return []
    axis, _ = SIDES[boundary.side]
    tangential = [a for a in range(dimensions) if a != axis]
    spans = boundary.span if isinstance(boundary.span[0], (tuple, list)) else (boundary.span,)
    if len(spans) != len(tangential) or any(len(s) != 2 or s[0] >= s[1] for s in spans):
        raise CaseError(
            f"span_m of the boundary on the {boundary.side} is {boundary.span}; give [low, high] per tangential axis"
        )
    return list(zip(tangential, spans))


def _cells(case, axis: int, edges: list[float]) -> list[tuple[int, float]]:
    """Number of cells and last width over first, of each block along an axis."""
    if axis >= case.dimensions:
        return [(1, 1.0)]
    if not case.resolution.stretch:
        return [(max(1, round((high - low) / case.resolution.cell)), 1.0) for low, high in itertools.pairwise(edges)]
    whole = cell_edges(case)[axis]
    ends = [nearest_edge(whole, end, "a span_m") for end in edges]
    growth = case.resolution.stretch[axis] ** (1.0 / max(len(whole) - 2, 1))
    return [(high - low, float(growth ** (high - low - 1))) for low, high in itertools.pairwise(ends)]


def _vertex(block: tuple[int, ...], corner: int, edges: list[list[float]]) -> int:
    i, j, k = (block[axis] + (corner >> axis & 1) for axis in range(3))
    return i + len(edges[0]) * (j + len(edges[1]) * k)


def _block_line(block, edges, cells) -> str:
    corners = " ".join(str(_vertex(block, corner, edges)) for corner in BLOCK_ORDER)
    counts, ratios = zip(*(cells[axis][block[axis]] for axis in range(3)))
    return (
        f"    hex ({corners}) ({' '.join(map(str, counts))}) simpleGrading ({' '.join(f'{r:.17g}' for r in ratios)})\n"
    )


def _patches(case, blocks, edges) -> dict[str, tuple[str, list[str]]]:
    """Patch name -> (type, faces)."""
    patches: dict[str, tuple[str, list[str]]] = {}
    for block in blocks:
        for axis, upper in itertools.product(range(3), (0, 1)):
            if block[axis] != (len(edges[axis]) - 2 if upper else 0):
                continue
            name, kind = _owner(case, block, axis, upper, edges)
            corners = " ".join(str(_vertex(block, corner, edges)) for corner in FACES[axis][upper])
            patches.setdefault(name, (kind, []))[1].append(f"({corners})")
    return patches


def _owner(case, block, axis: int, upper: int, edges) -> tuple[str, str]:
    """(name, type) of the patch that a block's outer face belongs to: of a span, else of a side, else of the rest."""
    if axis >= case.dimensions:
        return "frontAndBack", "empty"
    side = next(name for name, place in SIDES.items() if place == (axis, upper))
    centre = [0.5 * (e[i] + e[i + 1]) for e, i in zip(edges, block)]

    def reach(boundary) -> int | None:
        if boundary.side is None:
            return 0
        inside = all(low < centre[a] < high for a, (low, high) in _spans(boundary, case.dimensions))
        return (1 if boundary.span is None else 2) if boundary.side == side and inside else None

    claims = [(reach(boundary), name) for name, boundary in case.boundaries.items() if reach(boundary) is not None]
    best = [name for rank, name in claims if rank == max(claims)[0]]
    if len(best) != 1:
        says = f"belongs to {' and '.join(best)}" if best else "belongs to no boundary"
        raise CaseError(
            f"a part of the {side} side {says}; give `side` and `span_m`, or one boundary without a side for the rest"
        )
    return best[0], "wall" if case.boundaries[best[0]].kind == "wall" else "patch"  # no distance is that to a slip_wall


def _patch(name: str, kind: str, faces: list[str]) -> str:
    return f"    {name} {{ type {kind}; faces ({' '.join(faces)}); }}\n"
