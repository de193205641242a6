"""Fields of a run as data of the viewer in a report: some instants, some particles, numbers as base64."""

from __future__ import annotations

import base64
import json
from pathlib import Path

import numpy as np

from sdph.scenes import paths
from sdph.show import shot, style, timeline
from sdph.show.shot import Shot, numbers

INSTANTS, POINTS = 16, 20000  # at most in one report; more make no better picture and a large file
COLOURS = 24  # of a map; between them the viewer goes straight
LEVELS = 65535  # of a number on its way into the page
MAP = (  # arrays that are shown, by their name in the output
    "temperature", "velocity", "alpha_p", "pressure", "density", "vapour_mass_fraction", "theta", "diameter",
    "material", "equivalent_stress", "hoop_stress", "plastic_strain", "damage", "piece",
)  # fmt: skip


def viewer(folder: Path, case) -> str:
    """HTML of the viewer; empty where a run has no fields."""
    if not (folder / "run.pvd").is_file():
        return ""
    times = timeline.read(folder).time_values
    chosen = sorted({times[round(i)] for i in np.linspace(0, len(times) - 1, min(INSTANTS, len(times)))})
    shots = [shot.of_folder(folder, time) for time in chosen]
    turn = _turn(shots[-1])
    names = [name for name in MAP if any(name in own.named() for own in shots)]
    boxes = np.stack([own.box.reshape(3, 2) for own in shots])
    whole = np.stack([boxes[:, :, 0].min(axis=0), boxes[:, :, 1].max(axis=0)], axis=1)
    low, high = np.sort(turn @ whole, axis=1).T
    data = {
        "dimensions": 2 if shots[-1].axes else 3, "lower": list(low), "upper": list(high),
        "names": ["xyz"[int(np.argmax(np.abs(row)))] for row in turn],
        "spacing": shots[-1].spacing, "cell": case.resolution.cell or case.resolution.spacing,
        "scales": {name: _scale(name, shots) for name in names}, "first": shot.chosen(shots, None),
        "frames": [_encoded(_frame(own, names, turn)) for own in shots],
    }  # fmt: skip
    text = json.dumps(data).replace("</", "<\\/")
    return (paths.PACKAGE / "show" / "viewer.html").read_text(encoding="utf-8").replace("@DATA@", text)


def _turn(own: Shot) -> np.ndarray:
    """(3, 3) matrix that turns places so that the picture's right, up and towards the eye are x, y and z."""
    if own.axes:
        right, up = (np.eye(3)[a] for a in own.axes)
        return np.stack((right, up, np.cross(right, up)))
    up = np.asarray(own.up)
    right = np.eye(3)[0] if not up[0] else np.eye(3)[1]
    return np.stack((right, up, np.cross(right, up)))


def _scale(name: str, shots: list[Shot]) -> dict:
    """The scale of a field over all instants, of particles and gas alike."""
    found = style.scale(name, [own for taken in shots for own in taken.values(name)])
    colours = style.map_of(found.map)(np.linspace(0.0, 1.0, COLOURS))[:, :3]
    return {
        "title": found.title, "low": found.low, "high": found.high, "origin": found.origin, "factor": found.factor,
        "map": np.round(255.0 * colours).astype(int).tolist(),
    }  # fmt: skip


def _frame(own: Shot, names: list[str], turn: np.ndarray) -> dict:
    frame, gas = {"time": own.time}, own.gas
    if own.particles.n_points:
        frame["particles"] = _points(own.particles.points, own.particles.point_data, names, turn, {})
    if gas is not None and gas.n_cells:
        frame["gas"] = _points(gas.cell_centers().points, gas.cell_data, names, turn, _sizes(gas))
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


def _points(places, arrays, names: list[str], turn, shapes: dict) -> dict:
    """Name -> values of every n-th point, of vectors their length; `x` the places; `shapes` as they are."""
    every = slice(None, None, -(-len(places) // POINTS))
    found = {name: np.asarray(values)[every] for name, values in shapes.items()}
    found["x"] = np.asarray(places)[every] @ turn.T
    return found | {name: numbers(arrays[name])[every] for name in names if name in arrays}


def _encoded(frame: dict) -> dict:
    """Arrays as [least, largest, base64 of 16 bits between them]; what is no number is LEVELS."""

    def packed(values) -> list:
        values = np.asarray(values, float)
        known = values[np.isfinite(values)]
        low, high = (float(known.min()), float(known.max())) if known.size else (0.0, 0.0)
        share = (values - low) / (high - low or 1.0) * (LEVELS - 1)
        words = np.where(np.isfinite(share), share, LEVELS).round().astype("<u2")
        return [low, high, base64.b64encode(words.tobytes()).decode()]

    return {
        part: {name: packed(v) for name, v in value.items()} if isinstance(value, dict) else value
        for part, value in frame.items()
    }
