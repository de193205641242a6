"""outflow.csv: a row for each particle of grains or droplets that left the domain, and the sizes of all of them."""

from __future__ import annotations

import functools
import math
from pathlib import Path

import numpy as np

from sdph.effects.around import outflow
from sdph.engine import state as particles
from sdph.engine.table import Table
from sdph.methods.grains.history import carried
from sdph.running import sizing

FILE = "outflow.csv"


class Outlet:
    """The record of what leaves: `note` it at the end of a window."""

    KEPT = ("table", "left", "sums", "volume", "mass", "stayed")  # see sdph.engine.kept

    def __init__(self, case, path: Path | None):
        self.case, self.table = case, Table(path)
        self.arrays, self.exits = carried(case), outflow.exits(case)
        self.left, self.nozzles = 0, ("", *case.nozzles)
        self.mass = np.zeros(len(self.exits))  # [kg] that left by each
        self.stayed = np.zeros(2)  # mass [kg] of what nozzles gave and has left, and that times its stay [kg s]
        self.sums, self.volume = (np.zeros((len(self.exits), count)) for count in (4, sizing.BINS))

    def start(self) -> None:
        """Name the columns, so that a table of none is a table."""
        empty = particles.empty(0, self.arrays, self.case.dimensions)
        self.table.name(tuple(self._columns(0.0, empty)))

    def note(self, time: float, gone, world) -> None:
        """Write what is found outside at `time` [s], the end of a window: where it is then. State `gone` is of each
        process of a world, None where nothing is."""
        if not world.any(gone is not None):
            return
        found = [own for own in world.gather(gone) or () if own is not None]
        if found:
            self._write(time, functools.reduce(particles.join, found))

    def _write(self, time: float, gone) -> None:
        columns = self._columns(time, gone)
        for row in zip(*columns.values()):
            self.table.write(dict(zip(columns, row)))
        self.left += len(gone.x)

    def _columns(self, time: float, gone) -> dict[str, list]:
        """Name -> a value a particle; sizes are counted."""
        way = outflow.through(self.case, gone)
        self.mass += np.bincount(way, gone.mass, len(self.exits))
        found = {"time_s": [time] * len(gone.x), "particle": gone.ident.tolist()}
        found["outlet"] = [self.exits[number] for number in way]
        if "nozzle" in self.arrays:
            found["nozzle"] = [self.nozzles[number] for number in gone.nozzle]
            found["residence_s"] = self._stayed(time, gone).tolist()
        axes = "xyz"[: self.case.dimensions]
        found |= {f"{a}_m": values.tolist() for a, values in zip(axes, (gone.x, gone.y, gone.z))}
        found |= {f"velocity_{a}_m_s": values.tolist() for a, values in zip(axes, (gone.u, gone.v, gone.w))}
        if "temperature" in self.arrays:
            found["temperature_K"] = gone.temperature.tolist()
        found["mass_kg"] = gone.mass.tolist()
        return found | (self._sizes(gone, way) if "diameter" in self.arrays else {})

    def _stayed(self, time: float, gone) -> np.ndarray:
        """Time (n,) [s] since each came in, or since the start; those of nozzles are counted."""
        stayed, mass = time - gone.entered, gone.mass * (gone.nozzle > 0)
        self.stayed += (mass.sum(), mass @ stayed)
        return stayed

    def _sizes(self, gone, way) -> dict[str, list]:
        for number in np.unique(way):
            part = sizing.census(self.case, particles.take(gone, way == number))
            self.sums[number] += sizing.sums_of(part)
            self.volume[number] += part.volume
        own = sizing.census(self.case, gone)
        deviation = [math.sqrt(max(0.0, square - mean**2)) for mean, square in zip(own.first, own.second)]
        return {"diameter_m": own.first.tolist(), "diameter_std_m": deviation, "count": own.number.tolist()}

    def summary(self) -> dict[str, float]:
        """Number of drops or grains that left, and their diameters; of each outlet too where they left by several."""
        found = {"outflow_particles": self.left}
        used = np.flatnonzero(self.mass)
        found |= {f"outflow_{self.exits[way]}_kg": float(self.mass[way]) for way in (used if len(used) > 1 else ())}
        if self.stayed[0]:
            found["outflow_residence_s"] = float(self.stayed[1] / self.stayed[0])
        if "diameter" not in self.arrays:
            return found
        found |= _told("outflow", self.sums.sum(axis=0), self.volume.sum(axis=0))
        used = np.flatnonzero(self.sums[:, 0])
        for number in used if len(used) > 1 else ():
            found |= _told(f"outflow_{self.exits[number]}", self.sums[number], self.volume[number])
        return found


def beside(case, table: Table) -> Outlet | None:
    """The record beside a ledger's `table`, where that is on disk, of a case whose particles leave."""
    if "outflow" not in case.effects or not table:
        return None
    return Outlet(case, Path(table.file.name).with_name(FILE) if table.lasts else None)


def _told(name: str, sums, volume) -> dict[str, float]:
    """Number and diameters of drops, each key with `name` before it."""
    return {f"{name}_count": float(sums[0])} | {
        f"{name}_{key}": value for key, value in sizing.diameters(sums, volume).items()
    }
