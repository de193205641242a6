"""Fields of a run by time: run.pvd and the files that it names."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

import numpy as np

from sdph.running import fields
from sdph.schema import CaseError

PAST = 1e-6  # of the last time: how far past it a time may lie, by the digits it was written with
PARTICLES = ("velocity", "ident", "kind", "mass", "density")  # arrays that all particles have, of grains and of liquids
GAS_CELLS = ("velocity", "pressure", "temperature", "density", "alpha_p")


class Instant(NamedTuple):
    """Particles and gas (None where there is none) at a time [s], as pyvista meshes."""

    time: float
    particles: object
    gas: object


@dataclass(frozen=True)
class Timeline:
    """Instant [s] -> number of the part -> file: particles are part 0, gas is part 1 where there is any, then those of
    other methods."""

    files: dict[float, dict[int, Path]]

    @property
    def time_values(self) -> list[float]:
        return sorted(self.files)


def read(folder: Path) -> Timeline:
    """The timeline of a run."""
    file, files = folder / "run.pvd", {}
    if not file.is_file():
        raise CaseError(f"{folder} holds no fields (no run.pvd); give the folder of a run")
    try:
        for row in ElementTree.parse(file).getroot().iter("DataSet"):
            files.setdefault(_instant(row.attrib), {})[int(row.attrib["part"])] = folder / _inside(row.attrib["file"])
        if not files or not all(0 in parts for parts in files.values()):
            raise ValueError("it names no particles")
    except (SyntaxError, ValueError, KeyError) as error:  # no XML, or none of a timeline
        raise CaseError(f"{file} is damaged ({error}); run it again") from None
    return Timeline(files)


def _instant(row: dict) -> float:
    if not math.isfinite(time := float(row["timestep"])):
        raise ValueError(f"timestep = {time}")
    return time


def _inside(name: str) -> str:
    """The name of a file of fields in the run folder."""
    path = Path(name)
    if path.is_absolute() or ".." in path.parts or path.suffix not in fields.KNOWN:
        raise ValueError(f"{name[:80]!r} is no file of fields in this folder")
    return name


def state_at(timeline: Timeline, time: float | None = None) -> Instant:
    """(time, particles, gas) nearest to `time` [s]; the last without one."""
    times = timeline.time_values
    chosen = times[-1] if time is None else min(times, key=lambda t: abs(t - time))
    if time is not None and not times[0] <= time <= times[-1] and not abs(time - chosen) <= PAST * times[-1]:
        raise CaseError(f"no fields at {time:g} s: this run has fields from {times[0]:g} to {times[-1]:g} s")
    parts = timeline.files[chosen]
    gas = fields.load(parts[1], GAS_CELLS) if 1 in parts else None  # a liquid has none
    clouds = [fields.load(file, PARTICLES) for part, file in sorted(parts.items()) if part != 1]
    return Instant(chosen, together(clouds), gas)


def together(clouds: list):
    """Particles of all methods as one; nan where a method has no such field."""
    names = {name: cloud[name] for cloud in clouds for name in cloud.array_names}
    for cloud in clouds if len(clouds) > 1 else ():
        for name, like in names.items():
            if name not in cloud.array_names and cloud.n_points:
                cloud[name] = np.full((cloud.n_points, *like.shape[1:]), np.nan)
    return clouds[0].append_polydata(*clouds[1:]) if len(clouds) > 1 else clouds[0]
