"""Reference runs of stock OpenFOAM solvers on the same case: twoPhaseEulerFoam (two fluids), reactingParcelFoam (droplets).

A run takes its folder from `openfoam_case_templates/<scene>/{tfm,dpm}`; every physical number reaches it from the case
by the macro files. What a run gave is kept in the user's cache under a hash of all that went into it.
"""

from __future__ import annotations

import hashlib
import json
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from coupling.openfoam import fields, install, programs, reference_numbers
from sdph.case import Case

# file of the solver -> name here
TWO_FLUID_FIELDS = {
    "alpha.particles": "alpha_p",
    "T.particles": "particle_temperature",
    "T.gas": "gas_temperature",
    "U.particles": "particle_velocity",
    "U.gas": "gas_velocity",
    "Theta.particles": "granular_temperature",
    "p": "pressure",
}
DROPLET_FIELDS = {"T": "gas_temperature", "U": "gas_velocity", "p": "pressure", "vapour": "vapour_mass_fraction"}
PARCEL_FIELDS = {"d": "diameter", "T": "temperature", "U": "velocity", "nParticle": "count", "rho": "density"}
CLOUD = "lagrangian/reactingCloud1"

Progress = Callable[[float, float], None]


@dataclass(frozen=True)
class Reference:
    """What a reference run gave. C cells, T outputs, N time steps.

    times (T,) [s]; centres (C, 3) [m]; volumes (C,) [m3]; fields: name -> (T, C) or (T, C, 3);
    history: "time" (N,) [s] and name -> (N,) at the middle of the first region of particles;
    parcels: one dictionary per output, name -> (P,) or (P, 3) (droplets only); wall [s]; log: the solver's.
    """

    solver: str
    times: np.ndarray
    centres: np.ndarray
    volumes: np.ndarray
    fields: dict[str, np.ndarray]
    history: dict[str, np.ndarray]
    parcels: tuple[dict[str, np.ndarray], ...]
    wall: float
    log: str

    def at(self, when: float) -> int:
        """Index of the output nearest to `when` [s]."""
        return int(np.argmin(np.abs(self.times - when)))


def run_two_fluid(case: Case, template: Path, folder: Path, ranks: int = 1, progress: Progress | None = None) -> Reference:
    """Run twoPhaseEulerFoam on the case in `folder` (or take it from the cache)."""
    numbers = reference_numbers.two_fluid(case) | {"ranks": str(ranks)}
    programs.write(case, template, folder, {"sdphTwoFluid": numbers})
    prepare = [["blockMesh"], ["setFields"]]
    names = {"centre": ("T.particles", "T.gas")}
    return _run(case, "twoPhaseEulerFoam", prepare, folder, ranks, progress, TWO_FLUID_FIELDS, names)


def run_droplets(case: Case, template: Path, folder: Path, progress: Progress | None = None) -> Reference:
    """Run reactingParcelFoam on the case in `folder` (or take it from the cache)."""
    programs.write(case, template, folder, {"sdphDroplets": reference_numbers.droplets(case)})
    return _run(case, "reactingParcelFoam", [["blockMesh"]], folder, 1, progress, DROPLET_FIELDS, {})


def _run(case, solver, prepare, folder, ranks, progress, names, probes) -> Reference:
    kept = install.user_cache() / "references" / f"{_key(folder, solver, ranks)}.npz"
    if kept.exists():
        return _load(kept)
    for command in prepare:
        programs.run(command, folder, folder / f"log.{command[0]}")
    began = time.perf_counter()
    log = folder / f"log.{solver}"
    programs.run_solver(solver, folder, log, ranks, case.run.end_time, progress)
    reference = _read(solver, folder, names, probes, time.perf_counter() - began, log)
    _keep(reference, kept)
    return reference


def _key(folder: Path, solver: str, ranks: int) -> str:
    """Hash of all inputs in the folder, the solver's version and the closures library."""
    digest = hashlib.sha256(f"{solver} {ranks} {install.identity()}".encode())
    for path in sorted(p for part in ("0", "constant", "system") for p in (folder / part).rglob("*") if p.is_file()):
        if "polyMesh" not in path.parts:
            digest.update(path.relative_to(folder).as_posix().encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:32]


def _read(solver, folder, names, probes, wall, log) -> Reference:
    programs.run(["postProcess", "-funcs", "(writeCellCentres writeCellVolumes)", "-time", "0"], folder, folder / "log.cells")
    cells = fields.cell_count(folder)
    outputs = fields.times(folder)
    present = {file: name for file, name in names.items() if (outputs[-1][1] / file).exists()}
    return Reference(
        solver=solver,
        times=np.array([when for when, _ in outputs]),
        centres=fields.read(folder / "0/C", cells),
        volumes=fields.read(folder / "0/V", cells),
        fields={name: np.array([fields.read(path / file, cells) for _, path in outputs]) for file, name in present.items()},
        history=_history(folder, probes),
        parcels=tuple(_parcels(path / CLOUD) for _, path in outputs if (path / CLOUD).is_dir()),
        wall=wall,
        log=str(log),
    )


def _history(folder: Path, probes: dict[str, tuple[str, ...]]) -> dict[str, np.ndarray]:
    history = {}
    for probe, names in probes.items():
        for file in names if (folder / "postProcessing" / probe).is_dir() else ():
            history["time"], values = fields.read_probe(folder, probe, file)
            history[TWO_FLUID_FIELDS[file]] = values[:, 0]
    return history


def _parcels(folder: Path) -> dict[str, np.ndarray]:
    parcels = {name: fields.read_parcels(folder / file) for file, name in PARCEL_FIELDS.items()}
    return parcels | {"position": fields.read_positions(folder / "positions")}


def _keep(reference: Reference, path: Path) -> None:
    """Write under another name first: what stands under the final name is whole."""
    path.parent.mkdir(parents=True, exist_ok=True)
    table = asdict(reference)
    groups = {group: table.pop(group) for group in ("fields", "history")}
    arrays = {f"{group}/{name}": values for group, entries in groups.items() for name, values in entries.items()}
    for place, parcels in enumerate(table.pop("parcels")):
        arrays |= {f"parcels/{place:06d}/{name}": values for name, values in parcels.items()}
    plain = {name: table.pop(name) for name in ("solver", "wall", "log")}
    partial = path.with_suffix(".partial.npz")
    np.savez_compressed(partial, plain=json.dumps(plain), **table, **arrays)
    partial.replace(path)


def _load(path: Path) -> Reference:
    with np.load(path) as stored:
        arrays = {name: stored[name] for name in stored.files}
    plain = json.loads(str(arrays.pop("plain")))
    groups: dict[str, dict] = {"fields": {}, "history": {}, "parcels": {}}
    for name in [name for name in arrays if "/" in name]:
        group, _, key = name.partition("/")
        groups[group][key] = arrays.pop(name)
    parcels: dict[str, dict] = {}
    for key, values in sorted(groups.pop("parcels").items()):
        parcels.setdefault(key.partition("/")[0], {})[key.partition("/")[2]] = values
    return Reference(**plain, **arrays, **groups, parcels=tuple(parcels.values()))
