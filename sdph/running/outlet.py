"""outflow.csv: a row for each particle of grains or droplets that left the domain, and the sizes of all of them."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from sdph.engine import state as particles
from sdph.engine.table import Table
from sdph.methods.grains.history import carried
from sdph.running import sizing

FILE = "outflow.csv"


class Outlet:
    """The record of what leaves: `note` it at the end of a window."""

    KEPT = ("table", "left", "sums", "volume")  # see sdph.engine.kept

    def __init__(self, case, path: Path):
        self.case, self.table = case, Table(path)
        self.arrays = carried(case)
        self.left, self.sums, self.volume = 0, np.zeros(4), np.zeros(sizing.BINS)

    def start(self) -> None:
        """Name the columns, so that a table of none is a table."""
        empty = particles.empty(0, self.arrays, self.case.dimensions)
        self.table.name(tuple(self._columns(0.0, empty)))

    def note(self, time: float, gone) -> None:
        """Write what is found outside at `time` [s], the end of a window: where it is then, State `gone`."""
        columns = self._columns(time, gone)
        for row in zip(*columns.values()):
            self.table.write(dict(zip(columns, row)))
        self.left += len(gone.x)

    def _columns(self, time: float, gone) -> dict[str, list]:
        """Name -> a value a particle; sizes are counted."""
        found = {"time_s": [time] * len(gone.x), "particle": gone.ident.tolist()}
        axes = "xyz"[: self.case.dimensions]
        found |= {f"{a}_m": values.tolist() for a, values in zip(axes, (gone.x, gone.y, gone.z))}
        found |= {f"velocity_{a}_m_s": values.tolist() for a, values in zip(axes, (gone.u, gone.v, gone.w))}
        if "temperature" in self.arrays:
            found["temperature_K"] = gone.temperature.tolist()
        found["mass_kg"] = gone.mass.tolist()
        return found | (self._sizes(gone) if "diameter" in self.arrays else {})

    def _sizes(self, gone) -> dict[str, list]:
        own = sizing.census(self.case, gone)
        self.sums += sizing.sums_of(own)
        self.volume += own.volume
        deviation = [math.sqrt(max(0.0, square - mean**2)) for mean, square in zip(own.first, own.second)]
        return {"diameter_m": own.first.tolist(), "diameter_std_m": deviation, "count": own.number.tolist()}

    def summary(self) -> dict[str, float]:
        """Number of drops or grains that left, and their diameters."""
        found = {"outflow_particles": self.left}
        if "diameter" not in self.arrays:
            return found
        own = sizing.diameters(self.sums, self.volume)
        return found | {"outflow_count": float(self.sums[0])} | {f"outflow_{key}": own[key] for key in own}
