"""The mesh of an OpenFOAM case, `constant/polyMesh`, as arrays: text or binary, compressed or not."""

from __future__ import annotations

import functools
import itertools
import re
from pathlib import Path
from typing import NamedTuple

import numpy as np

from coupling.openfoam import dictionary
from sdph.engine.geometry import SIDES
from sdph.laws.constants import ROUND_OFF, TINY
from sdph.schema import CaseError

FOLDER, BLOCKS = "constant/polyMesh", "system/blockMeshDict"
IN_SIDE = 1e-6  # of a mesh's size: OpenFOAM writes six digits or more
HEADER = re.compile(rb"FoamFile\s*\{.*?\}", re.DOTALL)
COMMENT = re.compile(rb"//[^\n]*|/\*.*?\*/", re.DOTALL)
START = re.compile(rb"\s*(\d+)\s*\(")
ALIKE = re.compile(rb"\s*(\d+)\s*\{\s*(\d+)\s*\}")  # a list of one value


class Patch(NamedTuple):
    """A patch: its type, the faces that it has, and the patch on the other side of one that is cyclic."""

    kind: str
    faces: slice
    other: str = ""


class PolyMesh:
    """Points (P, 3) [m], faces as `corners`[`first`[k] : `first`[k + 1]], owner (F,), neighbour (inner faces,) and
    patches by name. Areas (F, 3) [m2] point out of the owner; volumes (C,) [m3]."""

    def __init__(self, case: Path):
        folder = case / FOLDER
        self.points = points(case)
        self.first, self.corners = _faces(folder / "faces")
        self.owner, self.neighbour = (_labels(folder / name) for name in ("owner", "neighbour"))
        self.patches = patches(case)
        self.areas, self.centres = self._areas()

    def _areas(self) -> tuple[np.ndarray, np.ndarray]:
        """Area vectors (F, 3) [m2] and middles (F, 3) [m] of the faces, by a fan from the mean of their corners."""
        face, after = around(self.first)
        middle = np.add.reduceat(self.points[self.corners], self.first[:-1]) / np.diff(self.first)[:, None]
        a, b, m = self.points[self.corners], self.points[self.corners[after]], middle[face]
        triangles = 0.5 * np.cross(a - m, b - m)
        size = np.linalg.norm(triangles, axis=1)
        moments = np.add.reduceat(size[:, None] * (a + b + m) / 3.0, self.first[:-1])
        return np.add.reduceat(triangles, self.first[:-1]), moments / np.add.reduceat(size, self.first[:-1])[:, None]

    @property
    def volumes(self) -> np.ndarray:
        """(C,) [m3], by Gauss: x.n/3 over the faces."""
        flux = (self.areas * (self.centres - self.points.mean(axis=0))).sum(axis=1) / 3.0
        cells = int(self.owner.max()) + 1
        inner = len(self.neighbour)
        return np.bincount(self.owner, flux, cells) - np.bincount(self.neighbour, flux[:inner], cells)

    def outwards(self, patch: str) -> tuple[float, np.ndarray]:
        """Area [m2] of a patch, and its mean unit normal (3,) out of the mesh; 0 where it is closed in itself."""
        own = self.areas[self.patches[patch].faces]
        total = own.sum(axis=0)
        return float(np.linalg.norm(own, axis=1).sum()), total / max(float(np.linalg.norm(total)), TINY)

    def spans(self, lower, upper) -> dict[str, tuple[str, tuple | None]]:
        """Patch -> side of the box from `lower` to `upper` (d,) [m] that it lies in, with its (low, high) on each axis
        along that, None where it is all that lies there. Patches that lie in no side are left out."""
        on_side: dict[str, list[str]] = {}
        near = IN_SIDE * float(max(np.subtract(upper, lower)))
        for name, patch in self.patches.items():
            middles = self.centres[patch.faces]
            for side, (axis, end) in itertools.islice(SIDES.items(), 2 * len(lower)) if len(middles) else ():
                if (np.abs(middles[:, axis] - (upper if end else lower)[axis]) < near).all():
                    on_side.setdefault(side, []).append(name)
        found = {}
        for side, names in on_side.items():
            tangential = [a for a in range(len(lower)) if a != SIDES[side][0]]
            for name in names:
                faces = self.patches[name].faces
                own = self.points[self.corners[self.first[faces.start] : self.first[faces.stop]]][:, tangential]
                span = tuple(zip(own.min(axis=0).tolist(), own.max(axis=0).tolist()))
                found[name] = side, None if len(names) == 1 else span if len(span) > 1 else span[0]
        return found


def around(first: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Face of each corner of all faces, and number of the corner that comes next around it, (K,) both; `first` as of a
    PolyMesh."""
    after = np.arange(first[-1]) + 1
    after[first[1:] - 1] = first[:-1]
    return np.repeat(np.arange(len(first) - 1), np.diff(first)), after


def read(case: Path) -> PolyMesh:
    """The mesh of a case, read once as long as it is as it was."""
    return _read(case, (case / FOLDER / "boundary").stat().st_mtime_ns)


@functools.lru_cache(maxsize=1)
def _read(case: Path, changed: int) -> PolyMesh:
    return PolyMesh(case)


def box(case: Path) -> tuple[np.ndarray, np.ndarray] | None:
    """Lower and upper corner (3,) [m] around the mesh that a case brings, or around the vertices of its blockMeshDict;
    None where it brings none."""
    if (case / FOLDER).is_dir():
        found = points(case)
    elif (case / BLOCKS).is_file():
        found = _vertices(case / BLOCKS)
    else:
        return None
    low, high = found.min(axis=0), found.max(axis=0)
    slack = ROUND_OFF * (high - low).max()
    return np.where(np.abs(low) < slack, 0.0, low), np.where(np.abs(high) < slack, 0.0, high)


def _vertices(path: Path) -> np.ndarray:
    """(V, 3) [m] of the vertices of a blockMeshDict, and of the points that its edges go through."""
    own = dictionary.read(path)
    scale = dictionary.number(own.get("scale") or own.get("convertToMeters")) or 1.0
    found = list(_places([own.get("vertices"), own.get("edges")]))
    if not found or dictionary.UNKNOWN in str(own.get("vertices")):
        raise CaseError(f"{path} counts its vertices out, which is not read; give domain.size_m and domain.lower_m")
    return scale * np.array(found)


def _places(entry):
    """Lists of three numbers in lists of lists."""
    if isinstance(entry, list):
        if len(entry) == 3 and all(isinstance(value, float) for value in entry):
            yield entry
        for value in entry:
            yield from _places(value)


def points(case: Path) -> np.ndarray:
    """(P, 3) [m] of a mesh."""
    data, binary = _content(case / FOLDER / "points")
    count, place = _start(case / FOLDER / "points", data, 0)
    if binary:
        return np.frombuffer(data, np.float64, 3 * count, place).reshape(-1, 3)
    numbers = np.array(data[place : data.rindex(b")")].replace(b"(", b" ").replace(b")", b" ").split(), float)
    if len(numbers) != 3 * count:
        raise _damaged(case / FOLDER / "points")
    return numbers.reshape(-1, 3)


def numbers_by_rank(case: Path, ranks: int) -> np.ndarray:
    """(C,) numbers of a mesh's cells in the order in which the processes of a case that is decomposed have them."""
    return np.concatenate([_labels(case / f"processor{k}" / FOLDER / "cellProcAddressing") for k in range(ranks)])


def patches(case: Path) -> dict[str, Patch]:
    """Patches of a mesh by name."""
    data = dictionary.content(case / FOLDER / "boundary")
    text = COMMENT.sub(b"", HEADER.sub(b"", data or b"")).decode("utf-8", "replace")
    found = {}
    for name, body in re.findall(r"([^\s(){};]+)\s*\{([^{}]*)\}", text):
        entries = dict(re.findall(r"(\w+)\s+([^\s;]+)[^;]*;", body))
        try:
            start, count = int(entries["startFace"]), int(entries["nFaces"])
            found[name] = Patch(entries["type"], slice(start, start + count), entries.get("neighbourPatch", ""))
        except (KeyError, ValueError):
            raise _damaged(case / FOLDER / "boundary") from None
    return found


def _content(path: Path) -> tuple[bytes, bool]:
    """Bytes of a file behind its header, and True where they are binary."""
    data = dictionary.content(path)
    if data is None:
        raise _damaged(path)
    header = HEADER.search(data)
    head = header.group() if header else b""
    if b"label=64" in head or b"scalar=32" in head:
        raise CaseError(f"{path} is of an OpenFOAM of other numbers (label=64 or scalar=32); write it as text there")
    rest, binary = data[header.end() if header else 0 :], bool(re.search(rb"format\s+binary", head))
    if not binary:
        return COMMENT.sub(b"", rest), False
    return rest[START_OF_LIST.search(rest).start() :] if START_OF_LIST.search(rest) else rest, True


START_OF_LIST = re.compile(rb"\n\s*\d+\s*\(")


def _start(path: Path, data: bytes, place: int) -> tuple[int, int]:
    """Number of the entries of a list, and the place where they begin."""
    found = START.match(data, place)
    if not found:
        raise _damaged(path)
    return int(found.group(1)), found.end()


def _labels(path: Path) -> np.ndarray:
    data, binary = _content(path)
    if alike := ALIKE.match(data):  # of a mesh of one cell
        return np.full(int(alike.group(1)), int(alike.group(2)), np.int64)
    count, place = _start(path, data, 0)
    text = b"" if binary else data[place : data.rindex(b")")]
    own = np.frombuffer(data, np.int32, count, place) if binary else np.array(text.split(), np.int64)
    if len(own) != count:
        raise _damaged(path)
    return own.astype(np.int64)


def _faces(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """First entry of each face, and one past the last, in the corners of all."""
    data, binary = _content(path)
    count, place = _start(path, data, 0)
    if binary:  # a compact list: of the first entries, then of all
        first = np.frombuffer(data, np.int32, count, place).astype(np.int64)
        total, place = _start(path, data, place + 4 * count + 1)
        return first, np.frombuffer(data, np.int32, total, place).astype(np.int64)
    rows = re.findall(rb"\d+\s*\(([^()]*)\)", data[place:])
    if len(rows) != count:
        raise _damaged(path)
    sizes = [len(row.split()) for row in rows]
    return np.concatenate(([0], np.cumsum(sizes))), np.array(b" ".join(rows).split(), np.int64)


def _damaged(path: Path) -> CaseError:
    return CaseError(f"{path} is missing or damaged; make the mesh anew (blockMesh, snappyHexMesh, ...)")
