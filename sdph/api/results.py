"""`sdph.load`: a run folder in Python. Tables are pandas frames, fields pyvista meshes or numpy arrays.

Units stand in the names of columns; arrays of fields are in SI. docs/results.md says what the columns mean.
"""

from __future__ import annotations

import os
import warnings
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from sdph.api.case import Case
from sdph.running import output
from sdph.schema import CaseError
from sdph.show import timeline
from sdph.study import against as comparison
from sdph.study import sampling, steadiness

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pandas
    import xarray


class Run:
    """A run in its folder; one that has not ended, or failed, has no summary, and the rest as far as it went."""

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = Path(folder)
        for name in (output.MARK, "history.csv"):
            if not (self.folder / name).is_file():
                raise CaseError(f"{self.folder} holds no run (no {name}); give the folder of a run")

    @cached_property
    def case(self) -> Case:
        """The case that was run."""
        return Case.load(self.folder)

    @property
    def finished(self) -> bool:
        """True where it went to its end."""
        return (self.folder / "summary.json").is_file()

    @cached_property
    def summary(self) -> dict[str, Any]:
        """Numbers of the whole run, by name; `CaseError` where it has not ended."""
        return dict(output.read_summary(self.folder))

    @property
    def failure(self) -> dict[str, Any] | None:
        """Reason why it failed: `what`, `kind`, `time_s`; None where it did not."""
        path = self.folder / output.FAILURE
        return output.read_json(path) if path.is_file() else None

    @property
    def history(self) -> pandas.DataFrame:
        """Curves: a row a window, or an interval of the history (history.csv)."""
        return self.table("history")

    @property
    def metrics(self) -> pandas.DataFrame:
        """Metrics of the scene: a row an output (metrics.csv)."""
        return self.table("metrics")

    @property
    def ledger(self) -> pandas.DataFrame:
        """Balances: a row a window (ledger.csv)."""
        return self.table("ledger")

    @property
    def tables(self) -> list[str]:
        """Names of the tables that the folder holds, for `table`."""
        return sorted(path.stem for path in self.folder.glob("*.csv"))

    def table(self, name: str) -> pandas.DataFrame:
        """A table of the folder by its name without .csv, such as ledger_liquid or outflow."""
        if name not in self.tables:
            raise CaseError(f"{self.folder} has no table {name}; it has: {', '.join(self.tables)}")
        import pandas

        return pandas.DataFrame(dict(self.columns(name)))

    def columns(self, name: str) -> dict[str, np.ndarray]:
        """The same as arrays by column."""
        return output.read_table(self.folder / f"{name}.csv")

    @property
    def times(self) -> list[float]:
        """Times [s] at which there are fields."""
        return timeline.read(self.folder).time_values

    def fields(self, time: float | None = None) -> timeline.Instant:
        """(time, particles, gas) nearest to `time` [s], the last without one: pyvista meshes, gas None without one."""
        return timeline.state_at(timeline.read(self.folder), time)

    def particles(self, time: float | None = None) -> dict[str, np.ndarray]:
        """Arrays of the particles by name: `position` (N, 3) [m], `velocity` (N, 3) [m/s], `mass` [kg], ..."""
        return arrays(self.fields(time).particles)

    def gas(self, time: float | None = None) -> dict[str, np.ndarray]:
        """Arrays of the gas by name, a value a cell: `centre` (M, 3) [m], `temperature` [K], `velocity` [m/s], ..."""
        return cells(self.fields(time).gas, self.folder)

    def gas_on_axes(self, time: float | None = None) -> xarray.Dataset:
        """The same in a box of gas, over its axes x, y (and z) [m], vectors over `component` too, as xarray has it
        (`pip install 'sdph[xarray]'`); `CaseError` on a mesh that is no box."""
        instant = self.fields(time)
        return on_axes(cells(instant.gas, self.folder), instant.time, self.case["dimensions"], self.folder)

    def line(
        self, start: Sequence[float], end: Sequence[float], count: int = 100, time: float | None = None
    ) -> pandas.DataFrame:
        """Fields at `count` points from `start` to `end` [m] at `time` [s]: columns NAME of particles, gas_NAME of the
        gas, NAME_x, NAME_y, NAME_z of vectors, `distance` [m] from the start; `share` is 1 inside of the particles."""
        import pandas

        return pandas.DataFrame(sampling.line(self.folder, start, end, count, time))

    def plane(self, normal: str, place: float, step: float | None = None, time: float | None = None) -> Any:
        """The same on the plane at `place` [m] along the axis `normal`, points `step` [m] apart, as a pyvista grid."""
        return sampling.plane(self.folder, normal, place, step, time)

    def averages(
        self, start: float | None = None, end: float | None = None, step: float | None = None
    ) -> sampling.Averages:
        """Means and variances over the outputs from `start` to `end` [s]: (particles, gas, times), pyvista meshes with
        arrays NAME_mean and NAME_variance; particles at points `step` [m] apart (None: a spacing)."""
        return sampling.averages(self.folder, start, end, step)

    def steadiness(self) -> pandas.DataFrame:
        """Curves over the last quarter of the run and the one before: column, mean, doubt (95 %), a_quarter_before,
        change, steady; of those that are numbers there and change."""
        import pandas

        return pandas.DataFrame(steadiness.rows(self.columns("history")))

    def compare(self, against: str) -> pandas.DataFrame:
        """Checks against `tfm`, `dpm` or `exact`: name, value, reference, tolerance, ok; warns of times that lack."""
        import pandas

        return pandas.DataFrame(comparison.compare(self.folder, against, warnings.warn))

    def __repr__(self) -> str:
        return f"<sdph.Run {self.folder}: {'finished' if self.finished else 'not finished'}>"


def load(folder: str | os.PathLike[str]) -> Run:
    """The run in a folder."""
    return Run(folder)


def arrays(mesh: Any) -> dict[str, np.ndarray]:
    """Arrays of points by name, with their `position`."""
    own = {name: np.asarray(mesh.point_data[name]) for name in mesh.point_data}
    return {"position": np.asarray(mesh.points), **own}


def cells(mesh: Any, folder: Path) -> dict[str, np.ndarray]:
    """Arrays of cells by name, with their `centre`; `CaseError` where there is no gas."""
    if mesh is None:
        raise CaseError(f"{folder} is a run without a gas; its particles are all it has")
    own = {name: np.asarray(mesh.cell_data[name]) for name in mesh.cell_data}
    return {"centre": np.asarray(mesh.cell_centers().points), **own}


def on_axes(fields: dict[str, np.ndarray], time: float, dimensions: int, folder: Path) -> xarray.Dataset:
    """Fields (M,) or (M, 3) of cells that fill a box, over its axes; they are known by their `centre` (M, 3) [m]."""
    try:
        import xarray
    except ImportError:
        raise CaseError("gas_on_axes needs xarray: pip install 'sdph[xarray]', or take gas()") from None
    places = fields.pop("centre")[:, :dimensions]
    near = 1e-6 * np.ptp(places)  # what is nearer is one coordinate: files hold them in single precision
    axes, order = {}, np.zeros(len(places), int)
    for name, along in zip("xyz", places.T):
        ranked = np.argsort(along)
        new, number = np.diff(along[ranked], prepend=-np.inf) > near, np.empty(len(along), int)
        number[ranked] = np.cumsum(new) - 1
        axes[name], order = along[ranked][new], order * new.sum() + number
    if not np.array_equal(np.sort(order), np.arange(np.prod([len(axis) for axis in axes.values()]))):
        raise CaseError(f"the gas of {folder} has no box of cells, and so no axes; take gas(), line() or plane()")
    shape, sorted_ = tuple(len(axis) for axis in axes.values()), np.argsort(order)
    arrays = {
        name: ((*axes, *("component",) * (values.ndim - 1)), values[sorted_].reshape(*shape, *values.shape[1:]))
        for name, values in fields.items()
    }
    return xarray.Dataset(arrays, {**axes, "time": time})
