"""Checkpoints: all that a run needs to go on bit for bit, in one folder that is there whole or not at all.

    RUN/checkpoints/<windows>/   manifest.json  numbers.json  arrays.npz  gas/<what the gas solver wrote>

What is kept, and how it is checked before anything is set, is told in `sdph.engine.kept`. A checkpoint may come from
anywhere: links are refused, files are read only where the manifest says how long they are, and nothing outside
`RUN/checkpoints` is ever removed.
"""

from __future__ import annotations

import hashlib
import json
import math
import os
import re
import shlex
import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

import numpy as np

from sdph.engine import kept
from sdph.engine.kept import short
from sdph.engine.reading import Unreadable, open_plain, read_arrays, read_json
from sdph.schema import CaseError, flat
from sdph.version import __version__

FORMAT = 21  # of the files of a checkpoint
FOLDER = "checkpoints"
LASTING = 2  # checkpoints that are kept, so that there is one when the newest is damaged
# keys that may change between the parts of a run
FREE = (
    "run.end_time_s", "run.output_interval_s", "run.checkpoint_interval_s", "run.checkpoint_windows", "run.launcher",
    "run.device",
)  # fmt: skip
# in a run folder, what a run that goes on writes into
WRITTEN = (
    "fields", "fields/pieces", "gas", "ledger.csv", "ledger_liquid.csv", "ledger_solid.csv", "history.csv",
    "metrics.csv", "outflow.csv", "droplets.csv",
)  # fmt: skip
LONGEST = 120  # letters of a list that is told in full; our choice
MANIFEST, NUMBERS, ARRAYS, GAS = "manifest.json", "numbers.json", "arrays.npz", "gas"
NAME, DRAFT = re.compile(r"[0-9]{9,18}"), re.compile(r"\.[0-9]{9,18}\.part")
# of what is in a manifest besides sdph and format
FORMS = {"time_s": float, "case": dict, "files": dict, "bytes": dict}
# bytes of a file from which on it is not read where less than a 64th is on the disk; our choice
HOLLOW, SHARE = 2**30, 64


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

    @property
    def time(self) -> float:
        """[s] that the run had reached."""
        return self.manifest["time_s"]

    @property
    def number(self) -> int:
        """Windows that the run had done."""
        return int(self.folder.name)

    def _refuse_version(self) -> None:
        for what, now in (("sdph", __version__), ("format", FORMAT)):
            if self.manifest[what] != now:
                was = short(self.manifest[what]).strip(kept.QUOTES)
                raise CaseError(
                    f"{self.folder} was written with {what} {was}; this is {now}: go on with that one, or run anew"
                )

    def refuse_other(self, case_table: dict) -> None:
        """CaseError where another version or case wrote it, with the difference, or where the case ends before it."""
        self._refuse_version()
        before, now = flat(self.manifest["case"]), flat(_plain(case_table))
        for key in sorted(before.keys() | now.keys()):
            if before.get(key) != now.get(key) and key not in FREE:
                change = f"{key} was {_told(before, key)} and is {_told(now, key)}"
                raise CaseError(f"{self.folder} is of another case: {change}; put it back, or run anew")
        end = now["run.end_time_s"]
        if self.time > end:
            reached = f"{self.folder} has reached {self.time:g} s"
            raise CaseError(f"{reached}, run.end_time_s = {end:g} lies before that; give a later --until")

    def refuse(self, why) -> CaseError:
        """CaseError to raise where this checkpoint does not fit."""
        mend = "remove it to go on from the one before it, or run anew"
        return CaseError(f"{self.folder} is no checkpoint to go on from: {why}; {mend}")

    def fill(self, thing, ready: Callable[[dict], None] = lambda values: None) -> None:
        """Put what was kept back into `thing`; `ready(values)` is called when all is checked and nothing set."""
        try:
            arrays = read_arrays(self.folder / ARRAYS, self.manifest["bytes"][ARRAYS])
            values = kept.unpack(read_json(self.folder / NUMBERS), arrays)
            if arrays:
                raise kept.Unfit(f"array {short(next(iter(arrays)))} has no place")
            kept.check(thing, values, "run")
            ready(values)
            kept.put(thing, values)
        except kept.OtherVersion as error:
            other = "the checkpoint is of another version of sdph"
            raise CaseError(f"{other}: {error}; go on with that one, or run anew") from None
        except (Unreadable, kept.Unfit) as error:
            raise self.refuse(error) from None


def _told(table: dict, key: str) -> str:
    """A value of a case for a line; of a list all of it where that is short."""
    if key not in table:
        return "not given"
    whole = isinstance(table[key], list) and len(text := ascii(table[key])) <= LONGEST
    return text if whole else short(table[key])


def write(run_folder: Path, number: int, time: float, case_table: dict, thing, gas) -> Path:
    """Checkpoint `number` of a run at `time` [s]: `thing` (has KEPT) and the gas, if there is one. The one before
    stays."""
    folder = _own(run_folder) / f"{number:09d}"
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
    lasting = [older for older in numbered(run_folder) if int(older.name) <= number][:LASTING]
    for other in set(numbered(run_folder)) - set(lasting):  # later ones were damaged: the run has not gone on from them
        shutil.rmtree(other, ignore_errors=True)
    return folder


def _write_all(draft: Path, time: float, case_table: dict, thing, gas) -> None:
    """The files of a checkpoint, on the disk when this returns."""
    if gas:
        gas.checkpoint(draft / GAS)
    arrays: dict[str, np.ndarray] = {}
    (draft / NUMBERS).write_text(json.dumps(kept.pack(thing, arrays)), encoding="utf-8")
    np.savez(draft / ARRAYS, **arrays)
    files = {str(path.relative_to(draft)): path for path in sorted(draft.rglob("*")) if path.is_file()}
    lengths = {name: path.stat().st_size for name, path in files.items()}
    manifest = {"sdph": __version__, "format": FORMAT, "time_s": float(time), "case": case_table}
    manifest |= {"files": {name: _sum(path, lengths[name]) for name, path in files.items()}, "bytes": lengths}
    (draft / MANIFEST).write_text(json.dumps(manifest, indent=1), encoding="utf-8")
    for path in (*draft.rglob("*"), draft):
        _sync(path)


def newest(run_folder: Path, status=lambda text: None) -> Checkpoint | None:
    """The newest whole checkpoint of a run; damaged ones are told of and passed over."""
    for folder in numbered(run_folder):
        try:
            return _open(folder)
        except Damaged as damage:
            status(f"{folder} is passed over: {damage}")
    return None


def told(checkpoint: Checkpoint, run_folder: Path) -> str:
    """Place of the last checkpoint of a run, and the command that goes on from it."""
    return f"(last checkpoint: {checkpoint.folder}; go on with: sdph run --resume {shlex.quote(str(run_folder))})"


def prepare(run_folder: Path) -> None:
    """Refuse what leads out of the folder of a run that was claimed to go on, and remove drafts that were cut."""
    for path in (run_folder / name for name in WRITTEN):
        if path.is_symlink() or (path.exists() and not (path.is_file() or path.is_dir())):
            raise CaseError(
                f"{path} is a link or a device; a run goes on in its own folder: put there what it stands for"
            )
    for draft in _own(run_folder).glob(".*.part"):
        if DRAFT.fullmatch(draft.name):
            shutil.rmtree(draft, ignore_errors=True)


def numbered(run_folder: Path) -> list[Path]:
    """Folders of checkpoints, newest first."""
    found = [path for path in _own(run_folder).glob("*") if NAME.fullmatch(path.name)]
    return sorted(found, key=lambda path: int(path.name), reverse=True)


def _own(run_folder: Path) -> Path:
    """The folder of a run's checkpoints, which is no link: what is removed there would be gone elsewhere."""
    folder = run_folder / FOLDER
    if folder.is_symlink():
        raise CaseError(f"{folder} is a link; a run keeps its checkpoints in its own folder: put them there")
    return folder


def _open(folder: Path) -> Checkpoint:
    _refuse_links(folder)
    try:
        manifest = read_json(folder / MANIFEST)
        if not isinstance(manifest, dict) or not {"sdph", "format"} <= manifest.keys():
            raise Damaged("it has no manifest of a checkpoint")
        if manifest["format"] == FORMAT:  # of others nothing is known; `refuse_other` says so
            _refuse_form(manifest)
            _refuse_files(folder, manifest["files"], manifest["bytes"])
    except (OSError, Unreadable) as error:
        raise Damaged(f"it is not whole ({error})") from None
    return Checkpoint(folder, manifest)


def _refuse_links(folder: Path) -> None:
    """CaseError where the folder of a checkpoint, or anything down to its gas's files, is a link."""
    for path in (folder, *folder.glob("*"), *(folder / GAS).glob("*")):
        if path.is_symlink():
            raise CaseError(
                f"{path} is a link; checkpoints are plain files: put the file itself there, or remove {folder}"
            )


def _refuse_form(manifest) -> None:
    for key, form in FORMS.items():
        if type(manifest.get(key)) is not form:
            raise Damaged(f"{key} of its manifest is {short(manifest.get(key))}")
    sums, lengths, time = manifest["files"], manifest["bytes"], manifest["time_s"]
    whole = all(isinstance(text, str) for text in sums.values()) and all(
        type(n) is int and n >= 0 for n in lengths.values()
    )
    if not (whole and sums.keys() == lengths.keys() >= {NUMBERS, ARRAYS}):
        raise Damaged("its manifest does not name its files with sums and lengths")
    if not (math.isfinite(time) and time >= 0.0):
        raise Damaged(f"time_s of its manifest is {time}")


def _refuse_files(folder: Path, sums: dict, lengths: dict) -> None:
    """Damaged where other files are there than the manifest has, or one is not as it was written."""
    found = [path for path in (*folder.glob("*"), *(folder / GAS).glob("*")) if path != folder / GAS]
    if {str(path.relative_to(folder)) for path in found} != {MANIFEST, *sums}:
        raise Damaged("other files are there than its manifest names")
    for name in sums:
        if len(PurePosixPath(name).parts) > 2 or _sum(folder / name, lengths[name]) != sums[name]:
            raise Damaged(f"{short(name)} is damaged")


def _sum(path: Path, length: int) -> str:
    """SHA-256 of a file of `length` bytes; of one that has other bytes, or next to none on the disk, it is empty."""
    with open(open_plain(path, length), "rb") as file:
        found = os.fstat(file.fileno())
        hollow = found.st_size > HOLLOW and 512 * found.st_blocks < found.st_size // SHARE
        return "" if found.st_size != length or hollow else hashlib.file_digest(file, "sha256").hexdigest()


def _sync(path: Path) -> None:
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def _plain(table):
    """A table as it comes back from JSON."""
    return json.loads(json.dumps(table))
