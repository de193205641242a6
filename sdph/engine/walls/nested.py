"""Parts of a closed surface that lie in each other: a tank, a body in it, a hole in that."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from sdph.engine.walls import facets
from sdph.schema import CaseError


class Part(NamedTuple):
    """Middle of a part (3,) [m], how many triangles it has, whether it lies within a room of another part, and whether
    its normals point the wrong way: out of the outermost, into what lies in one, and so on."""

    middle: np.ndarray
    triangles: int
    within: bool
    wrong: bool


def parts(surface) -> list[Part]:
    """Parts of a surface (pyvista) of triangles without open edges."""
    points, triangles = np.asarray(surface.points, float), surface.faces.reshape(-1, 4)[:, 1:]
    number = facets.hanging_together(triangles)
    own = [points[triangles[number == n]] for n in np.unique(number)]  # (F, 3, 3) each
    outwards = [facets.enclosed(part) < 0.0 for part in own]
    around = np.zeros(len(own), int)  # rooms that each lies in
    for part, out in zip(own, outwards):
        others = [n for n, other in enumerate(own) if other is not part and _may_hold(part, other)]
        around[others] += _holds(part, out, [own[n] for n in others]) if others else 0
    middles = [0.5 * (part.min(axis=(0, 1)) + part.max(axis=(0, 1))) for part in own]
    within = around % 2 == 1
    return [Part(*row) for row in zip(middles, map(len, own), within.tolist(), (np.array(outwards) == within).tolist())]


def refuse_mixed(corners: np.ndarray, where: str) -> None:
    """CaseError where facets (F, d, d) [m] of the surface `where` that share a side, and no other has it, look to
    different sides of the surface: they go along that side the same way. Of lines the side is a point."""
    point, d = facets.numbered(corners), corners.shape[2]
    own, after = point.ravel(), np.roll(point, -1, axis=1).ravel()
    if d == 2:
        side, way, place = own, np.tile([1, -1], len(point)), corners.reshape(-1, 2)
    else:
        way, place = np.where(own < after, 1, -1), 0.5 * (corners + np.roll(corners, -1, axis=1)).reshape(-1, 3)
        side = np.minimum(own, after) * (point.max() + 1) + np.maximum(own, after)
    _, first, number, times = np.unique(side, return_index=True, return_inverse=True, return_counts=True)
    mixed = np.flatnonzero((times == 2) & (np.bincount(number, way) != 0))
    if len(mixed):
        middle = ", ".join(f"{x:.4g}" for x in place[first[mixed[0]]])
        raise CaseError(
            f"{where}: normals of facets beside each other look to different sides of the surface, at {len(mixed)} "
            f"{'points' if d == 2 else 'edges'}, the first about ({middle}) m; turn them all to one side (a mesh "
            "program calls that coherent or consistent orientation)"
        )


def refuse_turned(surface, where: str) -> None:
    """CaseError where a part of the surface `where` is turned the wrong way, or some of its facets."""
    refuse_mixed(surface.points[surface.faces.reshape(-1, 4)[:, 1:]], where)
    found = sorted(parts(surface), key=lambda part: part.within)
    for part in found:
        place = ", ".join(f"{x:.4g}" for x in part.middle)
        named = f"{where}: a part of {part.triangles} triangles about ({place}) m"
        if part.wrong and not part.within:
            raise CaseError(
                f"{where if len(found) == 1 else named} is inside out: its normals point into it; they must point out "
                "of it, so flip them"
            )
        if part.wrong:
            raise CaseError(
                f"{named} lies within another, and its normals point out of it: it is a body there, and they must "
                "point into it; flip those of that part"
            )


def _may_hold(part, other) -> bool:
    """True where the middle of a triangle of the other lies in the box around a part."""
    places = other.mean(axis=1)
    return bool(((places > part.min(axis=(0, 1))) & (places < part.max(axis=(0, 1)))).all(axis=1).any())


def _holds(part, outwards: bool, others) -> list[bool]:
    """True for each of the others that a part is around; where they touch, by the place furthest from its surface."""
    import pyvista

    surface = pyvista.PolyData.from_regular_faces(part.reshape(-1, 3), np.arange(3 * len(part)).reshape(-1, 3)).clean()
    places = [other.mean(axis=1) for other in others]
    off = pyvista.PolyData(np.concatenate(places)).compute_implicit_distance(surface)["implicit_distance"]
    split = np.split(np.asarray(off), np.cumsum([len(own) for own in places])[:-1])
    return [bool((own[np.abs(own).argmax()] < 0.0) == outwards) for own in split]
