"""Fields of a run as data of the viewer in a report: some instants, some particles, numbers as base64."""

from __future__ import annotations

import base64
import json
from pathlib import Path

import numpy as np

from sdph.scenes import paths
from sdph.show import style, timeline

INSTANTS, POINTS = 16, 20000  # at most in one report; more make no better picture and a large file
MAP = (  # arrays that are shown, by their name in the output
    "temperature", "velocity", "alpha_p", "pressure", "density", "vapour_mass_fraction", "theta", "diameter",
    "equivalent_stress", "plastic_strain", "damage",
)  # fmt: skip


def viewer(folder: Path, case) -> str:
    """HTML of the viewer; empty where a run has no fields."""
    if not (folder / "run.pvd").is_file():
        return ""
    reader = timeline.read(folder)
    times = reader.time_values
    chosen = sorted({times[round(i)] for i in np.linspace(0, len(times) - 1, min(INSTANTS, len(times)))})
    frames = [_frame(*timeline.state_at(reader, time)) for time in chosen]
    ranges = {part: _ranges([frame[part] for frame in frames if part in frame]) for part in ("particles", "gas")}
    low, high = ((*corner, 0.0)[:3] for corner in (case.domain.corner, case.domain.upper))
    data = {
        "dimensions": case.dimensions, "lower": low, "upper": high, "spacing": case.resolution.spacing,
        "cell": case.resolution.cell or case.resolution.spacing, "units": {name: style.unit_of(name) for name in MAP},
        "ranges": ranges, "frames": [_encoded(frame) for frame in frames],
    }  # fmt: skip
    return (paths.PACKAGE / "show" / "viewer.html").read_text(encoding="utf-8").replace("@DATA@", json.dumps(data))


def _frame(time: float, particles, gas) -> dict:
    frame = {"time": time}
    if particles is not None and particles.n_points:
        frame["particles"] = _points(particles.points, particles.point_data, {})
    if gas is not None and gas.n_cells:
        frame["gas"] = _points(gas.cell_centers().points, gas.cell_data, _sizes(gas))
    return frame


def _sizes(gas) -> dict:
    """Width and height (C, 2) of the cells of a grid of boxes; of other meshes nothing, their cells are drawn as the
    case's."""
    if gas.GetClassName() != "vtkRectilinearGrid":
        return {}
    steps = np.meshgrid(
        *(np.diff(ticks) if len(ticks) > 1 else np.zeros(1) for ticks in (gas.z, gas.y, gas.x)), indexing="ij"
    )
    return {"size": np.stack((steps[2].ravel(), steps[1].ravel()), axis=1)}


def _points(places, arrays, shapes) -> dict:
    """Name -> values of every n-th point, of vectors their length; `x` the places; `shapes` as they are."""
    every = slice(None, None, -(-len(places) // POINTS))
    found = {name: np.asarray(values)[every] for name, values in ({"x": places} | shapes).items()}
    for name in MAP:
        if name in arrays:
            values = np.asarray(arrays[name])[every]
            found[name] = np.linalg.norm(values, axis=1) if values.ndim == 2 else values
    return found


def _ranges(parts: list[dict]) -> dict[str, list[float]]:
    """Least and greatest value over all instants."""
    names = [name for name in (parts[0] if parts else ()) if name not in ("x", "size")]
    return {
        name: [float(min(p[name].min() for p in parts)), float(max(p[name].max() for p in parts))] for name in names
    }


def _encoded(frame: dict) -> dict:
    def text(values) -> str:
        return base64.b64encode(np.ascontiguousarray(values, "<f4").tobytes()).decode()

    return {
        part: {name: text(v) for name, v in value.items()} if isinstance(value, dict) else value
        for part, value in frame.items()
    }
