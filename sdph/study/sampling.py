"""Lines, planes and time averages of a finished run, of any field of particles and gas, from the fields it wrote.

Particles are taken by the sum of SPH, sum V f W / sum V W; `share` is sum V W, 1 inside and 1/2 at a surface. Gas is
that of the cell at the point. Units are SI.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from sdph.schema import CaseError
from sdph.show import sampled, shot, timeline
from sdph.show.shot import Shot

NOT_SAMPLED = ("ident", "kind", "sealed", "piece", "body", "free")  # numbers and marks, of which no mean means anything
INSIDE = 0.25  # share below which there are no particles: half of that at a surface; our choice


class Averages(NamedTuple):
    """Means and variances over time: pyvista meshes with arrays NAME_mean and NAME_variance, and `share_mean` of the
    particles; gas None where there is none. `times` [s] are the instants that they are of."""

    particles: Any
    gas: Any
    times: list[float]


def at(own: Shot, places: np.ndarray) -> dict[str, np.ndarray]:
    """All fields of a shot at `places` (P, 3) [m]: those of the gas as gas_NAME; nan where there is none."""
    import pyvista

    found = {}
    if own.gas is not None:
        found = {f"gas_{name}": sampled.of_cells(own.gas, places, name) for name in own.gas.cell_data}
    data = own.particles.point_data
    arrays = {name: np.asarray(data[name]) for name in data if name not in NOT_SAMPLED}
    values, share = sampled.of_particles(
        pyvista.PolyData(np.ascontiguousarray(places, float)), np.asarray(own.particles.points),
        own.sizes() ** own.dimensions, arrays, sampled.REACH * own.spacing, own.dimensions,
    )  # fmt: skip
    for values_of in values.values():
        values_of[share < INSIDE] = np.nan
    return found | values | {"share": share}


def line(folder: Path, start, end, count: int, time: float | None) -> dict[str, np.ndarray]:
    """Fields at `count` points from `start` to `end` (d,) [m]: columns, of vectors one for each axis."""
    own, ends = shot.of_folder(folder, time), np.array([[*map(float, point), 0.0][:3] for point in (start, end)])
    ends[:, own.dimensions :] = 0.0  # where a plane run lies, however deep its mesh is
    if count < 2 or not np.isfinite(ends).all() or (ends[0] == ends[1]).all():
        raise CaseError(f"a line from {list(start)} to {list(end)} of {count} points; give two places and 2 or more")
    share = np.linspace(0.0, 1.0, count)
    places = ends[0] + share[:, None] * (ends[1] - ends[0])
    columns = {"distance": share * np.linalg.norm(ends[1] - ends[0]), "position": places}
    return _flat(columns | at(own, places))


def _flat(columns: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Columns (P,), those of vectors (P, 3) as NAME_x, NAME_y, NAME_z."""
    found = {}
    for name, values in columns.items():
        parts = {f"{name}_{a}": values[:, k] for k, a in enumerate("xyz")} if values.ndim == 2 else {name: values}
        found |= parts
    return found


def plane(folder: Path, normal: str, place: float, step: float | None, time: float | None):
    """Fields on the plane at `place` [m] along an axis, at points `step` [m] apart (None: half a spacing), as a pyvista
    grid."""
    if normal not in ("x", "y", "z"):
        raise CaseError(f"a plane normal to {normal!r}; known: x, y, z")
    own, axis = shot.of_folder(folder, time), "xyz".index(normal)
    box = own.box.copy()
    if not box[2 * axis] <= place <= box[2 * axis + 1]:
        raise CaseError(
            f"a plane at {normal} = {place:g} m; the run lies from {box[2 * axis]:g} to {box[2 * axis + 1]:g} m"
        )
    box[2 * axis : 2 * axis + 2] = place
    grid = sampled.grid(box, step or 0.5 * own.spacing)
    for name, values in at(own, np.asarray(grid.points)).items():
        grid[name] = values
    return grid


def averages(folder: Path, start: float | None, end: float | None, step: float | None) -> Averages:
    """Means and variances over the instants from `start` to `end` [s] (None: all): of the gas by cells; of particles at
    points `step` [m] apart (None: a spacing), where each instant counts by its share."""
    times = timeline.read(folder).time_values
    chosen = [t for t in times if (start is None or t >= start) and (end is None or t <= end)]
    if not chosen:
        raise CaseError(f"no fields from {start} to {end} s: this run has fields from {times[0]:g} to {times[-1]:g} s")
    last = shot.of_folder(folder, chosen[-1])
    grid, gas = sampled.grid(last.box, step or last.spacing), last.gas
    sums, cells = Sums(), Sums()
    for time in chosen:
        own = shot.of_folder(folder, time)
        found = at(own, np.asarray(grid.points))
        share = found.pop("share")
        sums.add({name: values for name, values in found.items() if not name.startswith("gas_")}, share)
        if own.gas is not None:
            cells.add(
                {name: np.asarray(own.gas.cell_data[name]) for name in own.gas.cell_data}, np.ones(own.gas.n_cells)
            )
    grid["share_mean"] = sums.weight / len(chosen)
    grid.point_data.update(sums.told())
    if gas is not None:
        gas.clear_data()
        gas.cell_data.update(cells.told())
    return Averages(grid, gas, chosen)


class Sums:
    """Weighted means and variances that are added to instant by instant: West 1979, Comm. ACM 22, 532."""

    def __init__(self) -> None:
        self.weight: Any = 0.0
        self.means: dict[str, np.ndarray] = {}
        self.weights: dict[str, np.ndarray] = {}
        self.squares: dict[str, np.ndarray] = {}

    def add(self, fields: dict[str, np.ndarray], weight: np.ndarray) -> None:
        """Add fields (P,) or (P, k) of an instant, nan where there are none, each with its weight (P,)."""
        self.weight = self.weight + weight
        for name, given in fields.items():
            values = np.asarray(given, float)
            known = np.isfinite(values).all(axis=1) if values.ndim == 2 else np.isfinite(values)
            own = np.where(known, weight, 0.0)
            total = self.weights.get(name, 0.0) + own
            share = np.divide(own, total, out=np.zeros_like(own), where=total > 0.0)
            along = share[:, None] if values.ndim == 2 else share
            mean = self.means.get(name, np.zeros_like(values))
            off = np.where(known[:, None] if values.ndim == 2 else known, values - mean, 0.0)
            self.means[name] = mean + along * off
            spread = (own[:, None] if values.ndim == 2 else own) * off * (off - along * off)
            self.squares[name] = self.squares.get(name, 0.0) + spread
            self.weights[name] = total

    def told(self) -> dict[str, np.ndarray]:
        """NAME_mean and NAME_variance; nan where there was nothing."""
        found = {}
        for name, mean in self.means.items():
            weight = self.weights[name][:, None] if mean.ndim == 2 else self.weights[name]
            none = weight <= 0.0
            variance = np.divide(self.squares[name], weight, out=np.zeros_like(mean), where=~none)
            found[f"{name}_mean"] = np.where(none, np.nan, mean)
            found[f"{name}_variance"] = np.where(none, np.nan, variance)
        return found
