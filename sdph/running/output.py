"""The run folder: what a run leaves behind, each file whole or not there.

case.toml inputs/ (files that the case names: sdph.running.inputs) origin.json ledger.csv history.csv metrics.csv
run.pvd fields/particles_*.vtp fields/gas_*.vt? fields/walls.vtp (of a tank or of a surface mesh) checkpoints/
fields/particles_*.pvtu fields/pieces/*.vtu (of particles that several processes share: sdph.running.pieces)
gas/ (case and log); at the end summary.json, or failure.json
"""

from __future__ import annotations

import csv
import fcntl
import importlib.metadata
import io
import json
import math
import os
import platform
import shlex
import shutil
import sys
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from coupling.openfoam import patches
from sdph.case.gas_cells import SAME, by_axis
from sdph.engine.table import Found, TooLarge, column, read_cells
from sdph.schema import CaseError
from sdph.version import __version__

MARK, ORIGIN = "case.toml", "origin.json"  # a folder with these files holds a run
FAILURE = "failure.json"
WALLS = "fields/walls.vtp"
PIECES = "pieces"  # in the folder of fields, with the particles of each process
ENDED = ("summary.json", "compare_*.json")
LEFT = (  # by a run, as patterns; what else is in its folder is the user's
    "ledger.csv", "ledger_liquid.csv", "ledger_solid.csv", "droplets.csv", "outflow.csv", "history.csv", "metrics.csv",
    "profile_*.csv", "run.pvd", FAILURE, *ENDED, "last_good.*", "checkpoints", "gas", WALLS,
    "fields/particles_*.vt?", "fields/gas_*.vt?", "fields/liquid_*.vt?", "fields/solid_*.vt?", "fields/part-*.vt?",
    "fields/particles_*.pvtu", f"fields/{PIECES}/particles_*.vtu", f"fields/{PIECES}/part-*.vtu",
)  # fmt: skip
TEXTS = ("limit",)  # columns of the tables of a run that hold no numbers
NAMED = ("numpy", "numba", "scipy", "pyvista")  # packages whose versions a run notes


class CannotWrite(RuntimeError):
    """The run folder does not take what is written: why."""


def create(folder: Path, inside: tuple[str, ...] = ("fields",)) -> Path:
    """A new folder with folders `inside`; one that holds anything is refused and left as it is."""
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        what = "holds another run or case" if (folder / MARK).exists() else "is not an empty folder"
        more = ""
        if (folder / MARK).is_file() and (folder / ORIGIN).is_file():
            more = f", or go on with that run: sdph run --resume {shlex.quote(str(folder))}, with --until T for longer"
        raise CaseError(f"{folder} {what}; give a new one{more}")
    try:
        for name in ("", *inside):
            (folder / name).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise CannotWrite(f"{folder} cannot be made: {error.strerror}; give a folder that can be written") from None
    return folder


@contextmanager
def claimed(folder: Path):
    """Keeps other runs out of a folder. The lock is the system's own and goes with the process, however that ends."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        yield
    except BlockingIOError:
        raise CaseError(f"{folder} is in use by a run that is going on; wait for it, or give another folder") from None
    finally:
        os.close(descriptor)


def clear(folder: Path) -> None:
    """Remove what a run that has no checkpoint has left, all but what says what it was, and nothing of the user's."""
    for path in (path for pattern in LEFT for path in folder.glob(pattern)):
        shutil.rmtree(path) if path.is_dir() and not path.is_symlink() else path.unlink()
    (folder / "fields").mkdir(exist_ok=True)


def forget(folder: Path, over: bool) -> None:
    """Remove what tells how a run ended before it goes on; where it is `over` only that it failed."""
    for pattern in (FAILURE,) if over else (FAILURE, *ENDED):
        for path in folder.glob(pattern):
            path.unlink()


def free_name(base: Path) -> Path:
    """`base`, or `base-2`, `base-3` ...: the first that does not exist."""
    candidates = (base if n == 1 else base.with_name(f"{base.name}-{n}") for n in range(1, 10**6))
    return next(c for c in candidates if not c.exists())


def write_text(path: Path, text: str) -> None:
    """A text file, whole or not at all: temporary name, flushed to disk, renamed."""
    temporary = path.with_name(f".{path.name}.part")
    with open(temporary, "w", encoding="utf-8") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())
    os.replace(temporary, path)


def write_rows(path: Path, rows: list[dict]) -> None:
    """A CSV file of rows of one set of keys, whole or not at all."""
    text = io.StringIO(newline="")
    writer = csv.DictWriter(text, rows[0], lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    write_text(path, text.getvalue())


def write_json(path: Path, table: dict) -> None:
    write_text(path, strict_json(table, indent=1) + "\n")


def strict_json(value, **layout) -> str:
    """JSON as its standard has it: null for numbers that are none or infinite."""
    return json.dumps(_finite(value), allow_nan=False, **layout)


def _finite(value):
    if isinstance(value, dict):
        return {key: _finite(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(entry) for entry in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def write_summary(folder: Path, summary: dict) -> None:
    write_json(folder / "summary.json", summary)


def write_origin(folder: Path) -> None:
    """Write the origin of a run: the command, versions, machine. Nothing is taken from it: a folder may come from
    anywhere."""
    versions = {"sdph": __version__, "python": platform.python_version()} | {
        name: importlib.metadata.version(name) for name in NAMED
    }
    origin = {"command": sys.argv, "versions": versions, "machine": platform.platform(), "cores": os.cpu_count()}
    write_json(folder / ORIGIN, origin)


def read_json(path: Path) -> dict:
    """A JSON table; `CaseError` where it is damaged."""
    try:
        table = json.loads(path.read_text(encoding="utf-8"))
    except (ValueError, RecursionError) as error:
        raise CaseError(f"{path} is damaged (no JSON: {error}); run it again") from None
    if not isinstance(table, dict):
        raise CaseError(f"{path} is damaged (it holds no table); run it again")
    return table


def read_summary(folder: Path) -> dict:
    """The summary of a run; `CaseError` where there is none."""
    path = folder / "summary.json"
    try:
        found = read_json(path)
    except (FileNotFoundError, NotADirectoryError):
        raise CaseError(
            f"{folder} holds no finished run (no summary.json); run it first with: sdph run ... --out {folder}"
        ) from None
    for key, value in found.items():
        if key != "title" and not _short_number(value):
            raise CaseError(f"{path} is damaged ({key} = {str(value)[:40]!r} is no number); run it again")
    return Found(path, {key: math.nan if value is None else value for key, value in found.items()})


def _short_number(value) -> bool:
    """True where a value of JSON is a number that a float can hold, or none at all."""
    return value is None or isinstance(value, float) or (isinstance(value, int) and abs(value) <= sys.float_info.max)


def copy_template(source: Path, target: Path) -> None:
    """An OpenFOAM case template as a folder of the user's own; scenes without one have nothing to copy."""
    if source.is_dir():
        shutil.copytree(source, target)


def read_table(path: Path, texts: tuple[str, ...] | None = None, mend: str = "run it again") -> Found:
    """Columns of a CSV file that a run has left, or is still writing: a last line that is not ended is not there yet.

    All columns but `texts` must hold numbers; with None those do that can. `mend` is what helps where it is damaged.
    """
    try:
        cells = read_cells(path)
        if not cells.ended and cells.rows:
            cells.rows.pop()
        cells.whole()
        return Found(path, {name: column(cells, name, texts) for name in cells.head})
    except TooLarge as error:
        raise CaseError(
            f"{path} is too long a table ({error}); give one of a shorter run, or of longer windows"
        ) from None
    except ValueError as error:
        raise CaseError(f"{path} is damaged ({error}); {mend}") from None


def gas_grid(gas):
    """(grid, order): pyvista cells of the gas mesh; cell i of the grid is cell order[i] of the gas."""
    import pyvista

    centres = gas.mesh.centres[:, : gas.mesh.dimensions]
    places = by_axis(centres)
    if np.prod([p.max() + 1 for p in places]) == len(centres):
        edges = _edges(centres, places, gas.mesh)
        return pyvista.RectilinearGrid(*edges, *[np.zeros(1)] * (3 - len(edges))), np.lexsort(places)
    return _polyhedra(gas)


def _edges(centres, places, mesh) -> list[np.ndarray]:
    """Cell faces along each axis, from the centres (C, d) [m] of the cells, the layers that they lie in, and their
    volumes; axes that the mesh is one cell deep along share what volume the others leave, evenly."""
    layer = [np.bincount(p, mesh.volumes) for p in places]
    ticks = [np.bincount(p, along) / np.bincount(p) for p, along in zip(places, centres.T)]
    widths = [_widths(*pair) if len(pair[0]) > 1 else None for pair in zip(ticks, layer)]
    known = math.prod(own.sum() for own in widths if own is not None) * mesh.depth
    deep = (mesh.volumes.sum() / known) ** (1.0 / max(sum(own is None for own in widths), 1))
    return [_from(tick[0], np.array([deep]) if own is None else own) for tick, own in zip(ticks, widths)]


def _widths(ticks, layers) -> np.ndarray:
    """Widths of layers of cells with their middles at `ticks`, by their volumes."""
    return layers * ((ticks[-1] - ticks[0]) / (layers.sum() - 0.5 * (layers[0] + layers[-1])))


def _from(middle: float, widths) -> np.ndarray:
    """Faces of layers of cells, the first with its middle there; round-off of 0 is 0."""
    first = middle - 0.5 * widths[0]
    return np.concatenate(([0.0], np.cumsum(widths))) + (first if abs(first) > SAME * widths[0] else 0.0)


def _polyhedra(gas):
    """Any OpenFOAM mesh, read from its case, a plane one as a cut through its middle; cells matched by their
    centres."""
    from scipy.spatial import cKDTree

    d = gas.mesh.dimensions
    grid = patches.cells(gas.case_folder, d, gas.ranks)
    _, order = cKDTree(gas.mesh.centres[:, :d]).query(grid.cell_centers().points[:, :d])
    if len(order) != len(gas.mesh.centres) or len(np.unique(order)) != len(order):
        raise RuntimeError(f"{len(order)} cells were read for output, the solver has {len(gas.mesh.centres)}")
    return grid, order


def with_fields(grid, order, fields):
    """The grid with the gas's fields."""
    for name, values in fields.items():
        grid.cell_data[name] = values[order]
    return grid
