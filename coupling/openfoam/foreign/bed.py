"""Grains that an OpenFOAM case starts with, as [particles.bed] of case.toml."""

from __future__ import annotations

import numpy as np

from coupling.openfoam.dictionary import vector
from coupling.openfoam.foreign.files import Files
from coupling.openfoam.poly_mesh import PolyMesh

DENSE = 0.5  # of the largest volume fraction: cells above it are of the bed; our choice
FULL = 0.98  # of the box around the bed that cells of it fill, from which on the bed is that box; our choice
FEW = 1e-4  # volume fraction below which there are no grains; our choice
QUARTER = 0.25  # of the height of a vessel that is filled where the case tells nothing; our choice
LOOSE = 0.55  # volume fraction of such a bed: a poured one; our choice


def bed(files: Files, mesh: PolyMesh, box, gravity, found: dict, notes: list[str]) -> dict:
    """Entries of the region; `box` (lower, upper) [m] of the mesh, `found` the section [grains]."""
    dimensions, limit = len(gravity), found.get("packing_limit", 0.63)
    volumes = mesh.volumes
    alpha = files.values(f"alpha.{files.grains}", len(volumes)) if files.grains else None
    if alpha is not None and len(alpha) == len(volumes) and alpha.max() > FEW:
        dense = alpha > DENSE * alpha.max()
        mean = float(alpha[dense] @ volumes[dense] / volumes[dense].sum())
        entries = {"volume_fraction": round(min(mean, limit), 6)}
        if dense.all():
            return {"shape": "walls"} | entries
        low, high = _around(mesh, dense, dimensions)
        depth = 1.0 if dimensions == 3 else float(np.ptp(mesh.points[:, 2]))
        if volumes[dense].sum() > FULL * np.prod(high - low) * depth:
            return {"shape": "box", "lower_m": _rounded(low), "upper_m": _rounded(high)} | entries
        mass = float(alpha @ volumes) * found["density_kg_m3"] / depth
        notes.append("particles.bed: as much mass as the case starts with, filled from below")
        return {"shape": "walls", "mass_kg": float(f"{mass:.6g}")} | entries
    return _from_boxes(files, box, dimensions, limit) or _chosen(box, gravity, notes)


def _around(mesh: PolyMesh, cells, dimensions: int) -> tuple[np.ndarray, np.ndarray]:
    """Corners (d,) [m] of the box around some cells, a mask (C,)."""
    faces = np.flatnonzero(cells[mesh.owner])
    corners = np.concatenate([mesh.corners[mesh.first[k] : mesh.first[k + 1]] for k in faces])
    own = mesh.points[corners][:, :dimensions]
    return own.min(axis=0), own.max(axis=0)


def _from_boxes(files: Files, box, dimensions: int, limit: float) -> dict:
    """Region of the first box of setFieldsDict that fills in grains, cut off at the mesh; empty where there is none."""
    name, rows = f"alpha.{files.grains}", files.read("system/setFieldsDict").get("regions", [])
    rows = rows[0] if rows and isinstance(rows[0], list) else rows
    for row in (row for row in rows if isinstance(row, dict) and files.grains):
        values = row.get("fieldValues", [[]])[0]
        given = [values[k + 1] for k in range(len(values) - 1) if values[k] == name]
        corners = [e for e in row.get("box", []) if isinstance(e, list)]
        if given and isinstance(given[0], float) and given[0] > FEW and len(corners) == 2:
            low, high = (np.array(vector([corner])[:dimensions]) for corner in corners)
            cut = {"lower_m": _rounded(np.maximum(low, box[0])), "upper_m": _rounded(np.minimum(high, box[1]))}
            return {"shape": "box", **cut, "volume_fraction": min(given[0], limit)}
    return {}


def _chosen(box, gravity, notes: list[str]) -> dict:
    """A bed that the case does not tell of."""
    along = int(np.argmax(np.abs(gravity))) if any(gravity) else len(gravity) - 1
    height = float(f"{QUARTER * (box[1][along] - box[0][along]):.4g}")
    if any(gravity):
        entries = {"shape": "walls", "height_m": height}
    else:  # no level without gravity: the lowest part along the last axis
        upper = np.array(box[1], float)
        upper[along] = box[0][along] + height
        entries = {"shape": "box", "lower_m": _rounded(box[0]), "upper_m": _rounded(upper)}
    notes.append(
        "particles.bed: the case tells of no grains at the start; a quarter of the vessel is filled: our choice"
    )
    return entries | {"volume_fraction": LOOSE}


def temperature(files: Files, mesh: PolyMesh, otherwise: float, notes: list[str]) -> float:
    """[K] of the grains at the start, the mean by their mass where it is uneven."""
    volumes = mesh.volumes
    own, alpha = (files.values(f"{name}.{files.grains}", len(volumes)) for name in ("T", "alpha"))
    if not files.grains or own is None or len(own) != len(volumes):
        return otherwise
    if not np.ptp(own):
        return float(own[0])
    notes.append(f"particles.bed: T.{files.grains} is uneven at the start: temperature_K is its mean by mass")
    there = alpha is not None and len(alpha) == len(volumes) and alpha.max() > FEW
    return float(np.average(own, weights=alpha * volumes if there else volumes))


def _rounded(corner) -> list[float]:
    return [float(f"{place + 0.0:.9g}") if abs(place) > 1e-12 else 0.0 for place in corner]
