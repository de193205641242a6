"""Reads what an OpenFOAM run wrote, ASCII or binary, serial or reconstructed: cell fields, the mesh's cells, probes.

Only what the comparisons need: internal fields of scalars, vectors and symmetric tensors, 64-bit floats, little-endian.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from coupling.gas import GasError

COMPONENTS = {"scalar": 1, "vector": 3, "symmTensor": 6}
_UNIFORM = re.compile(rb"internalField\s+uniform\s+([^;]+);")
_LIST = re.compile(rb"internalField\s+nonuniform\s+List<(\w+)>\s*(\d+)\s*\(")


class FieldError(GasError):
    """A field file that cannot be read: which, and why."""


def times(folder: Path) -> list[tuple[float, Path]]:
    """(time [s], folder) of every output of a run after its start, in order of time."""
    found = [(float(path.name), path) for path in Path(folder).iterdir() if path.is_dir() and _is_number(path.name)]
    return sorted((time, path) for time, path in found if time > 0.0)


def _is_number(name: str) -> bool:
    return re.fullmatch(r"\d+(\.\d+)?(e[-+]?\d+)?", name) is not None


def read(path: Path, cells: int) -> np.ndarray:
    """The internal field of a file: (C,) of a scalar, (C, 3) of a vector, (C, 6) of a symmTensor, as xx, xy, xz, yy,
    yz and zz; a uniform value is spread over the cells."""
    text = Path(path).read_bytes()
    uniform = _UNIFORM.search(text)
    if uniform:
        return _spread(_numbers(uniform.group(1)), cells)
    found = _LIST.search(text)
    if not found or found.group(1).decode() not in COMPONENTS:
        raise FieldError(f"{path} holds no internal field of scalars, vectors or symmetric tensors")
    components, count = COMPONENTS[found.group(1).decode()], int(found.group(2))
    if count != cells:
        raise FieldError(f"{path} holds {count} values for a mesh of {cells} cells")
    values = (
        _binary(text, found.end(), count * components)
        if _is_binary(text)
        else _ascii(text, found.end(), count, components)
    )
    return values.reshape(count, components) if components > 1 else values


def _is_binary(text: bytes) -> bool:
    head = text[: text.index(b"}")]
    if b"label=64" in head or b"scalar=32" in head or b"MSB" in head:
        raise FieldError(
            "a binary field of another OpenFOAM build (needs 64-bit floats, little-endian); write it as ascii"
        )
    return re.search(rb"format\s+binary;", head) is not None


def _binary(text: bytes, start: int, count: int) -> np.ndarray:
    return np.frombuffer(text, "<f8", count, start).copy()


def _ascii(text: bytes, start: int, count: int, components: int) -> np.ndarray:
    body = text[start : text.index(b";", start)]
    values = _numbers(body)
    if values.size != count * components:
        raise FieldError(f"a field of {count} values with {components} components holds {values.size} numbers")
    return values


def _numbers(text: bytes) -> np.ndarray:
    return np.array(text.replace(b"(", b" ").replace(b")", b" ").split(), dtype=np.float64)


def _spread(value: np.ndarray, cells: int) -> np.ndarray:
    return np.full(cells, value[0]) if value.size == 1 else np.tile(value, (cells, 1))


def read_parcels(path: Path) -> np.ndarray:
    """An ASCII list of parcels, from after the head: (P,) of a scalar, (P, n) of n numbers a line."""
    text = Path(path).read_bytes()
    found = re.search(rb"\}\s*(?://[^\n]*\n\s*)*(\d+)\s*([({])", text)
    if not found or _is_binary(text):
        raise FieldError(f"{path} holds no ASCII list of parcels")
    count = int(found.group(1))
    if found.group(2) == b"{":  # one value for all: 3{0.5}
        return _spread(_numbers(text[found.end() : text.index(b"}", found.end())]), count)
    values = _numbers(text[found.end() : text.rindex(b")")])
    return values if values.size == count else values.reshape(count, -1)


def cell_count(folder: Path) -> int:
    """Number of cells of the mesh, from the note in `constant/polyMesh/owner`."""
    head = (Path(folder) / "constant/polyMesh/owner").read_bytes()[:2000]
    found = re.search(rb"nCells:\s*(\d+)", head)
    if not found:
        raise FieldError(f"{folder}/constant/polyMesh/owner does not say how many cells there are")
    return int(found.group(1))


def read_probe(folder: Path, name: str, field: str) -> tuple[np.ndarray, np.ndarray]:
    """Times (N,) [s] and values (N, P) of the P points of the `probes` function object `name`, for a scalar field."""
    pieces = sorted(
        (Path(folder) / "postProcessing" / name).glob(f"*/{field}"), key=lambda path: float(path.parent.name)
    )
    if not pieces:
        raise FieldError(f"{folder} has no probes {name} of {field}")
    table = np.concatenate([np.loadtxt(piece, ndmin=2) for piece in pieces])
    return table[:, 0], table[:, 1:]
