"""Checkpoints: all that a run needs to go on bit for bit, in one folder that is there whole or not at all.

    RUN/checkpoints/<windows>/   manifest.json  numbers.json  arrays.npz  gas/<what the gas solver wrote>

This module knows no effect. A class that changes as a run goes names its attributes that do so,

    KEPT = ("time", "windows", "stepper")

and each of them is an array, a number, a text, None, a random generator, a tuple, list or dict of these, or an object
with KEPT in turn. What follows from the kept is not kept: a class that has to make it anew does so in `revive()`,
which is called once its attributes are back. An effect with a memory of its own keeps it in arrays of the State, or
in an object that is named in the KEPT of the one which owns it; nothing else is to be done.
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from sdph import __version__
from sdph.schema import CaseError, flat

FORMAT = 3  # of the files of a checkpoint
FOLDER = "checkpoints"
LASTING = 2  # checkpoints that are kept, so that there is one when the newest is damaged
FREE = ("run.end_time_s", "run.output_interval_s", "run.checkpoint_interval_s", "run.checkpoint_windows")  # keys that may change between the parts of a run
MANIFEST, NUMBERS, ARRAYS, GAS = "manifest.json", "numbers.json", "arrays.npz", "gas"


class Damaged(RuntimeError):
    """A checkpoint that is not whole."""


@dataclass(frozen=True)
class Checkpoint:
    """A checkpoint that was found whole."""

    folder: Path
    manifest: dict

    @property
    def gas(self) -> Path:
        return self.folder / GAS

    def refuse_other(self, case_table: dict) -> None:
        """CaseError when another version or another case wrote it, with the difference, or where the case ends before it."""
        for what, now in (("sdph", __version__), ("format", FORMAT)):
            if self.manifest[what] != now:
                raise CaseError(f"{self.folder} was written with {what} {self.manifest[what]}; this is {now}: go on with that one, or run anew")
        before, now = flat(self.manifest["case"]), flat(_plain(case_table))
        for key in sorted(before.keys() | now.keys()):
            if before.get(key) != now.get(key) and key not in FREE:
                change = f"{key} was {before.get(key, 'not given')} and is {now.get(key, 'not given')}"
                raise CaseError(f"{self.folder} is of another case: {change}; put it back, or run anew")
        reached, end = self.manifest["time_s"], now["run.end_time_s"]
        if reached > end:
            raise CaseError(f"{self.folder} has reached {reached:g} s, run.end_time_s = {end:g} lies before that; give a later --until")

    def fill(self, thing) -> None:
        """Put what was kept back into `thing`."""
        numbers = json.loads((self.folder / NUMBERS).read_text(encoding="utf-8"))
        with np.load(self.folder / ARRAYS) as arrays:
            _unpack(thing, numbers, arrays, "run")


def write(run_folder: Path, number: int, time: float, case_table: dict, thing, gas) -> Path:
    """Checkpoint `number` of a run at `time` [s]: `thing` (has KEPT) and the gas, if there is one. Older ones than the last two go."""
    folder = run_folder / FOLDER / f"{number:09d}"
    draft = folder.with_name(f".{folder.name}.part")
    shutil.rmtree(draft, ignore_errors=True)
    try:
        draft.mkdir(parents=True)
        _write_all(draft, time, case_table, thing, gas)
    except BaseException:
        shutil.rmtree(draft, ignore_errors=True)
        raise
    shutil.rmtree(folder, ignore_errors=True)  # of the same window, when a run that had ended goes on
    os.rename(draft, folder)
    _sync(folder.parent)
    for old in numbered(run_folder)[LASTING:]:
        shutil.rmtree(old, ignore_errors=True)
    return folder


def _write_all(draft: Path, time: float, case_table: dict, thing, gas) -> None:
    """The files of a checkpoint, on the disk when this returns."""
    if gas:
        gas.checkpoint(draft / GAS)
    arrays: dict[str, np.ndarray] = {}
    (draft / NUMBERS).write_text(json.dumps(_pack(thing, arrays)), encoding="utf-8")
    np.savez(draft / ARRAYS, **arrays)
    sums = {str(path.relative_to(draft)): _sum(path) for path in sorted(draft.rglob("*")) if path.is_file()}
    manifest = {"sdph": __version__, "format": FORMAT, "time_s": time, "case": case_table, "files": sums}
    (draft / MANIFEST).write_text(json.dumps(manifest, indent=1), encoding="utf-8")
    for path in (*draft.rglob("*"), draft):
        _sync(path)


def newest(run_folder: Path, status=lambda text: None) -> Checkpoint | None:
    """The newest whole checkpoint of a run; damaged ones are told of and passed over, drafts of a cut write removed."""
    for draft in (run_folder / FOLDER).glob(".*.part"):
        shutil.rmtree(draft, ignore_errors=True)
    for folder in numbered(run_folder):
        try:
            return _open(folder)
        except Damaged as damage:
            status(f"{folder} is passed over: {damage}")
    return None


def numbered(run_folder: Path) -> list[Path]:
    """Folders of checkpoints, newest first."""
    return sorted((p for p in (run_folder / FOLDER).glob("*") if p.name.isdigit()), reverse=True)


def _open(folder: Path) -> Checkpoint:
    try:
        manifest = json.loads((folder / MANIFEST).read_text(encoding="utf-8"))
        for name, expected in manifest["files"].items():
            if _sum(folder / name) != expected:
                raise Damaged(f"{name} is damaged")
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise Damaged(f"it is not whole ({error})") from None
    return Checkpoint(folder, manifest)


def _sum(path: Path) -> str:
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _sync(path: Path) -> None:
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def _pack(value, arrays: dict):
    """A value as JSON can hold it; arrays go to `arrays`, numbered: a key may be a text that a file cannot be called."""
    if isinstance(value, np.ndarray):
        arrays[name := str(len(arrays))] = value
        return {"array": name}
    if isinstance(value, np.random.Generator):
        return value.bit_generator.state
    if isinstance(value, np.generic):
        return value.item()
    parts = _parts(value)
    if parts is not None:
        return {key: _pack(part, arrays) for key, part in parts.items()}
    if isinstance(value, (list, tuple)):
        return [_pack(part, arrays) for part in value]
    return value


def _parts(value) -> dict | None:
    """Name -> value of what has named parts."""
    if hasattr(value, "KEPT"):
        return {name: getattr(value, name) for name in value.KEPT}
    if hasattr(value, "_asdict"):
        return value._asdict()
    return value if isinstance(value, dict) else None


def _unpack(like, saved, arrays, name: str):
    """What `saved` says, in the place of `like`: an object that has KEPT is filled, anything else is made anew."""
    if isinstance(saved, dict) and saved.keys() == {"array"}:
        return arrays[saved["array"]]
    if isinstance(like, np.random.Generator):
        like.bit_generator.state = saved
        return like
    if isinstance(saved, list):
        parts = [_unpack(None, part, arrays, f"{name}.{i}") for i, part in enumerate(saved)]
        return parts if isinstance(like, list) else tuple(parts)
    if not isinstance(saved, dict):
        return saved
    return _fill(like, saved, arrays, name)


def _fill(like, saved: dict, arrays, name: str):
    known = _parts(like) or {}
    fixed = hasattr(like, "KEPT") or hasattr(like, "_asdict")
    if fixed and known.keys() != saved.keys():
        differ = ", ".join(sorted(known.keys() ^ saved.keys()))
        raise CaseError(f"the checkpoint is of another version of sdph: {name} differs in {differ}; go on with that one, or run anew")
    parts = {key: _unpack(known.get(key), part, arrays, f"{name}.{key}") for key, part in saved.items()}
    if hasattr(like, "_asdict"):
        return type(like)(**parts)
    if not hasattr(like, "KEPT"):
        return parts
    for key, part in parts.items():
        setattr(like, key, part)
    if hasattr(like, "revive"):
        like.revive()
    return like


def _plain(table):
    """A table as it comes back from JSON."""
    return json.loads(json.dumps(table))
