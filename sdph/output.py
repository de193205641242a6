"""The run folder: what a run leaves behind, each file whole or not there.

    case.toml summary.json ledger.csv history.csv run.pvd fields/particles_*.vtp fields/gas_*.vt? gas/ (case and log)
"""

from __future__ import annotations

import csv
import json
import os
import shutil
from pathlib import Path

import numpy as np

from sdph import particles
from sdph.schema import CaseError

MARK = "case.toml"  # a folder with this file holds a run


def create(folder: Path, inside: tuple[str, ...] = ("fields",)) -> Path:
    """A new folder with folders `inside`; one that holds anything is refused and left as it is."""
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        what = "holds another run or case" if (folder / MARK).exists() else "is not an empty folder"
        raise CaseError(f"{folder} {what}; give a new one")
    try:
        for name in ("", *inside):
            (folder / name).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise CaseError(f"{folder} cannot be made: {error.strerror}; give a folder that can be written") from None
    return folder


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


def write_summary(folder: Path, summary: dict) -> None:
    write_text(folder / "summary.json", json.dumps(summary, indent=1) + "\n")


def read_summary(folder: Path) -> dict:
    """The summary of a run; `CaseError` where there is none."""
    try:
        return json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise CaseError(f"{folder} holds no finished run (no summary.json); run it first with: sdph run ... --out {folder}") from None


def copy_template(source: Path, target: Path) -> None:
    """An OpenFOAM case template as a folder of the user's own; scenes without one have nothing to copy."""
    if source.is_dir():
        shutil.copytree(source, target)


class Table:
    """A CSV file that grows by rows of one set of keys."""

    def __init__(self, path: Path):
        self.file = open(path, "a", newline="", encoding="utf-8")
        self.writer = None

    def write(self, row: dict) -> None:
        if self.writer is None:
            self.writer = csv.DictWriter(self.file, row.keys())
            if self.file.tell() == 0:
                self.writer.writeheader()
        self.writer.writerow(row)

    def flush(self) -> None:
        self.file.flush()

    def close(self) -> None:
        self.file.close()


def read_table(path: Path) -> dict[str, np.ndarray]:
    """Columns of a CSV file; numbers where they are."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    columns = {key: [row[key] for row in rows] for key in (rows[0] if rows else ())}
    return {key: _numbers(values) for key, values in columns.items()}


def _numbers(values: list[str]) -> np.ndarray:
    try:
        return np.array(values, float)
    except ValueError:
        return np.array(values)


class Fields:
    """Particles and gas on one timeline: `run.pvd` opens in ParaView and pyvista."""

    def __init__(self, folder: Path, gas, grain_density: float):
        self.folder, self.gas, self.grid, self.grain_density = folder, gas, None, grain_density
        self.entries: list[str] = []

    def write(self, time: float, state, fields: dict) -> None:
        """Particles and gas fields (name -> (C,) or (C, 3)) at `time` [s], and the timeline up to there."""
        if self.grid is None:
            self.grid = gas_grid(self.gas)
        number = len(self.entries) // 2
        suffix = "vtr" if self.grid[0].GetClassName() == "vtkRectilinearGrid" else "vtu"
        names = f"fields/particles_{number:05d}.vtp", f"fields/gas_{number:05d}.{suffix}"
        particle_points(state, self.grain_density).save(self.folder / names[0])
        with_fields(*self.grid, fields).save(self.folder / names[1])
        for part, name in enumerate(names):
            self.entries.append(f'<DataSet timestep="{time:.9g}" part="{part}" file="{name}"/>')
        write_text(self.folder / "run.pvd", PVD.format("\n".join(self.entries)))


PVD = '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n<Collection>\n{}\n</Collection>\n</VTKFile>\n'


def particle_points(state, grain_density: float):
    """Particles as pyvista points with their arrays and alpha_p."""
    import pyvista

    points = pyvista.PolyData(particles.positions(state))
    points["velocity"] = particles.velocities(state)
    points["alpha_p"] = state.density / grain_density
    for name in ("ident", "kind", "mass", "density", "temperature", "diameter", "theta"):
        if len(getattr(state, name)):
            points[name] = getattr(state, name)
    return points


def gas_grid(gas):
    """(grid, order): pyvista cells of the gas mesh; cell i of the grid is cell order[i] of the gas."""
    import pyvista

    centres, axes = gas.mesh.centres, range(gas.mesh.dimensions)
    ticks = [np.unique(np.round(centres[:, a], 12)) for a in axes]
    if np.prod([len(t) for t in ticks]) == len(centres):
        edges = [_edges(t) for t in ticks] + [np.zeros(1)] * (3 - len(ticks))
        return pyvista.RectilinearGrid(*edges), np.lexsort(tuple(np.round(centres[:, a], 12) for a in axes))
    return _polyhedra(gas)


def _edges(ticks: np.ndarray) -> np.ndarray:
    """Cell faces from centres, counted up from the first face; exact where they are uniform."""
    if len(ticks) == 1:
        return np.array([0.0, 2.0 * ticks[0]])
    middle = 0.5 * (ticks[1:] + ticks[:-1])
    return np.concatenate(([2.0 * ticks[0] - middle[0]], middle, [2.0 * ticks[-1] - middle[-1]]))


def _polyhedra(gas):
    """Any OpenFOAM mesh, read from its case; cells matched by their centres."""
    import pyvista
    from scipy.spatial import cKDTree

    reader = pyvista.POpenFOAMReader(str(gas.case_folder / "case.foam"))
    reader.case_type = "decomposed" if gas.ranks > 1 else "reconstructed"
    grid = reader.read()["internalMesh"]
    distance, order = cKDTree(gas.mesh.centres).query(grid.cell_centers().points)
    if len(np.unique(order)) != len(gas.mesh.centres):
        raise RuntimeError(f"{len(grid.cell_centers().points)} cells were read for output, the solver has {len(gas.mesh.centres)}")
    return grid, order


def with_fields(grid, order, fields):
    """The grid with the gas's fields."""
    for name, values in fields.items():
        grid.cell_data[name] = values[order]
    return grid
