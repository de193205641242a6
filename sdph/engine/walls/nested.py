"""Parts of a closed surface that lie in each other: a tank, a body in it, a hole in that."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

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
    numbered = surface.connectivity("all")
    number = np.asarray(numbered.cell_data["RegionId"])
    own = [numbered.extract_cells(number == n).extract_surface(algorithm=None) for n in range(number.max() + 1)]
    outwards = [_volume(part) > 0.0 for part in own]
    found = []
    for n, part in enumerate(own):
        around = sum(_holds(other, outwards[m], part) for m, other in enumerate(own) if m != n)
        within = around % 2 == 1
        found.append(Part(np.array(part.center), part.n_cells, within, outwards[n] == within))
    return found


def refuse_turned(surface, where: str) -> None:
    """CaseError where a part of the surface `where` is turned the wrong way."""
    for part in sorted(parts(surface), key=lambda part: part.within):
        if part.wrong and not part.within:
            raise CaseError(
                f"{where} is inside out: its normals point into it; they must point out of it, so flip them"
            )
        if part.wrong:
            place = ", ".join(f"{x:.4g}" for x in part.middle)
            raise CaseError(
                f"{where}: a part of {part.triangles} triangles about ({place}) m lies within another, and its normals "
                "point out of it: it is a body there, and they must point into it; flip those of that part"
            )


def _volume(part) -> float:
    """Six times the volume [m3] that a part encloses, below 0 where its normals point inwards."""
    a, b, c = np.moveaxis(np.asarray(part.points, float)[part.regular_faces], 1, 0)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)))


def _holds(part, outwards: bool, other) -> bool:
    """True where a part is around another one."""
    off = other.extract_points([0], include_cells=False).compute_implicit_distance(part)["implicit_distance"][0]
    return bool((off < 0.0) == outwards)
