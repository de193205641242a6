"""Results of a reference run of OpenFOAM, kept in the user's cache under a hash of all that went into it."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

INPUTS = ("0", "constant", "system")  # folders of an OpenFOAM case
TIMED = ("fields", "parcels")  # groups of a reference that are given at each output


@dataclass(frozen=True)
class Reference:
    """Results of a run. C cells, N time steps, P parcels.

    centres (C, 3) [m]; volumes (C,) [m3]; fields: time [s] -> name -> (C,) or (C, 3), SI;
    history: "time_s" and columns such as "centre_temperature_K", (N,) each;
    parcels: time [s] -> name -> (P,) or (P, 3) (droplets only); wall [s] of the solver.
    """

    solver: str
    wall: float
    centres: np.ndarray
    volumes: np.ndarray
    fields: dict[float, dict[str, np.ndarray]]
    history: dict[str, np.ndarray]
    parcels: dict[float, dict[str, np.ndarray]]

    def nearest(self, when: float) -> float:
        """The time [s] of the output nearest to `when` [s]."""
        return min(self.fields, key=lambda time: abs(time - when))


def key(folder: Path, made_with: str) -> str:
    """Hash of the inputs in a case folder and of what runs it."""
    digest = hashlib.sha256(made_with.encode())
    for path in sorted(p for part in INPUTS for p in (folder / part).rglob("*") if p.is_file()):
        if "polyMesh" not in path.parts:
            digest.update(path.relative_to(folder).as_posix().encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:32]


def keep(reference: Reference, path: Path) -> None:
    """Write a reference, under another name first: what stands under the final name is whole."""
    path.parent.mkdir(parents=True, exist_ok=True)
    arrays = {"centres": reference.centres, "volumes": reference.volumes}
    arrays |= {f"history/{name}": column for name, column in reference.history.items()}
    for group in TIMED:
        for time, entries in getattr(reference, group).items():
            arrays |= {f"{group}/{time!r}/{name}": values for name, values in entries.items()}
    plain = json.dumps({"solver": reference.solver, "wall": reference.wall})
    partial = path.with_suffix(".partial.npz")
    np.savez_compressed(partial, plain=plain, **arrays)
    partial.replace(path)


def load(path: Path) -> Reference:
    """Read what `keep` wrote."""
    with np.load(path) as stored:
        arrays = {name: stored[name] for name in stored.files}
    plain = json.loads(str(arrays.pop("plain")))
    groups: dict[str, dict] = {"history": {}} | {group: {} for group in TIMED}
    for name in [name for name in arrays if "/" in name]:
        group, *time, entry = name.split("/")
        target = groups[group].setdefault(float(time[0]), {}) if time else groups[group]
        target[entry] = arrays.pop(name)
    return Reference(**plain, **arrays, **groups)
