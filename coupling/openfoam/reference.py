"""What a reference run of OpenFOAM gave, kept in the user's cache under a hash of all that went into it."""

from __future__ import annotations

import hashlib
import json
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

INPUTS = ("0", "constant", "system")  # folders of an OpenFOAM case


@dataclass(frozen=True)
class Reference:
    """What a run gave. C cells, T outputs, N time steps, P parcels.

    times (T,) [s]; centres (C, 3) [m]; volumes (C,) [m3]; fields: name -> (T, C) or (T, C, 3), SI;
    history: "time" (N,) [s] and name -> (N,) in the middle of the first region of particles;
    parcels: one dictionary per output, name -> (P,) or (P, 3) (droplets only); wall [s] of the solver.
    """

    solver: str
    wall: float
    times: np.ndarray
    centres: np.ndarray
    volumes: np.ndarray
    fields: dict[str, np.ndarray]
    history: dict[str, np.ndarray]
    parcels: tuple[dict[str, np.ndarray], ...]

    def at(self, when: float) -> int:
        """Index of the output nearest to `when` [s]."""
        return int(np.argmin(np.abs(self.times - when)))


def key(folder: Path, made_with: str) -> str:
    """Hash of the inputs in a case folder and of what runs it."""
    digest = hashlib.sha256(made_with.encode())
    for path in sorted(p for part in INPUTS for p in (folder / part).rglob("*") if p.is_file()):
        if "polyMesh" not in path.parts:
            digest.update(path.relative_to(folder).as_posix().encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:32]


def keep(reference: Reference, path: Path) -> None:
    """Written under another name first: what stands under the final name is whole."""
    path.parent.mkdir(parents=True, exist_ok=True)
    table = asdict(reference)
    groups = {group: table.pop(group) for group in ("fields", "history")}
    groups |= {f"parcels{place:06d}": parcels for place, parcels in enumerate(table.pop("parcels"))}
    arrays = {f"{group}/{name}": values for group, entries in groups.items() for name, values in entries.items()}
    plain = {name: table.pop(name) for name in ("solver", "wall")}
    partial = path.with_suffix(".partial.npz")
    np.savez_compressed(partial, plain=json.dumps(plain), **table, **arrays)
    partial.replace(path)


def load(path: Path) -> Reference:
    """What `keep` wrote."""
    with np.load(path) as stored:
        arrays = {name: stored[name] for name in stored.files}
    plain = json.loads(str(arrays.pop("plain")))
    groups: dict[str, dict[str, np.ndarray]] = {"fields": {}, "history": {}}
    for name in [name for name in arrays if "/" in name]:
        group, _, entry = name.partition("/")
        groups.setdefault(group, {})[entry] = arrays.pop(name)
    parcels = tuple(groups.pop(group) for group in sorted(groups) if group.startswith("parcels"))
    return Reference(**plain, **arrays, **groups, parcels=parcels)
