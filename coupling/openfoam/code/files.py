"""Files of a case that programs of OpenFOAM can come to, and what each of them says.

A case is read before any program is: what runs code of it is refused, and so is what cannot be decided.
"""

from __future__ import annotations

import gzip
import os
import re
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from coupling.openfoam.code.tokens import Doubt
from coupling.openfoam.code.words import Words, has_header
from sdph.schema import CaseError

COLLATED = re.compile(r"processors.*")  # ranks that share files, which hold files
SURFACES = re.compile(  # that are no dictionaries
    r"constant/(triSurface|geometry|extendedFeatureEdgeMesh)/.*\.(stlb?|obj|off|vt[kp]|gts|nas|ac|tri|ply|csv)(\.gz)?"
)
LARGEST = 2**31  # bytes that a compressed file may unpack to (our choice)


@dataclass(frozen=True)
class Findings:
    """Facts of a file as it was read: its size and time, what it includes, whether binary, whether read as strictly."""

    stamp: tuple[int, int]
    included: frozenset[Path]
    binary: bool
    strict: bool


def refuse_code(folder: Path, known: dict[Path, Findings] | None = None) -> None:
    """CaseError when a file of the case would run code, or may do so; `known` keeps what was found for another call."""
    known = {} if known is None else known
    if folder.is_symlink():
        raise _refusal(folder, "it is a link, and leads out of the case")
    if not folder.is_dir():
        raise CaseError(f"{folder} is no folder of an OpenFOAM case; put it back, or run anew")
    present = list(_files(folder))
    todo = {name: False for name in present if _is_opened(folder, name)}  # place -> whether another file includes it
    found: dict[Path, Findings] = {}
    while todo:
        name, included = todo.popitem()
        found[name] = known[name] = _findings(folder, name, included, known)
        for target in _with_compressed(found[name].included).intersection(present):
            if target not in found or not found[target].strict:
                todo[target] = True
    _refuse_binary_includes(folder, found)


def _refuse_binary_includes(folder: Path, found: dict[Path, Findings]) -> None:
    """A file that is included is read as text, whatever its header says, and as it is where it is named with its
    .gz."""
    binary = {name for name, findings in found.items() if findings.binary}
    for name, findings in found.items():
        for target in (target for target in findings.included if target.suffix == ".gz"):
            raise _refusal(
                folder / name, f"it includes {target}, a compressed file, which is read as it is: leave .gz out"
            )
        for target in _with_compressed(findings.included) & binary:
            raise _refusal(folder / name, f"it includes {target}, a binary file")


def _with_compressed(names: frozenset[Path]) -> set[Path]:
    """OpenFOAM takes FILE.gz where there is no FILE."""
    return {path for name in names for path in (name, name.with_name(f"{name.name}.gz"))}


def _files(folder: Path) -> Iterator[Path]:
    """All files of a case, by their places in it."""
    todo = [Path()]
    while todo:
        inside = todo.pop()
        for entry in sorted(os.scandir(folder / inside), key=lambda entry: entry.name):
            name = inside / entry.name
            if entry.is_symlink():
                raise _refusal(folder / name, "it is a link, and may lead out of the case")
            if entry.is_file():
                yield name
            elif entry.is_dir():
                _refuse_folder(folder, name)
                todo.append(name)
            else:
                raise _refusal(folder / name, "it is neither a file nor a folder")


def _refuse_folder(folder: Path, name: Path) -> None:
    if name.name == "dynamicCode":
        raise _refusal(folder / name, "it holds compiled code of the case")
    if COLLATED.fullmatch(name.name):
        raise _refusal(folder / name, "files of several ranks in one cannot be judged")


def _is_opened(folder: Path, name: Path) -> bool:
    """True where a program may open a file without being told to by an include."""
    in_folder = len(name.parts) > 1 and not name.parts[0].startswith(".")
    if in_folder and not SURFACES.fullmatch(name.as_posix()):
        return True
    try:
        return has_header(_content(folder / name))
    except Doubt:  # no text at all
        return False


def _findings(folder: Path, name: Path, included: bool, known: dict[Path, Findings]) -> Findings:
    status = (folder / name).stat()
    stamp, before = (status.st_size, status.st_mtime_ns), known.get(name)
    if before and before.stamp == stamp and (before.strict or not included):
        return before
    data = b""
    try:
        data = _content(folder / name)
        words = Words(data, name, included or name.parts[0] == "system")
        words.read()
    except Doubt as doubt:
        line = data.count(b"\n", 0, doubt.place) + 1
        raise _refusal(folder / name, f"line {line}: {doubt}") from None
    return Findings(stamp, frozenset(words.included), words.binary, words.strict)


def _content(path: Path) -> bytes:
    """Bytes of a file as OpenFOAM gets them: one that is called .gz and is not compressed is read as it is."""
    data = path.read_bytes()
    if path.suffix != ".gz" or not data.startswith(b"\x1f\x8b"):
        return data
    try:
        with gzip.open(path) as file:
            data = file.read(LARGEST)
    except (OSError, EOFError, zlib.error):
        raise Doubt("it cannot be unpacked", 0) from None
    if len(data) == LARGEST:
        raise Doubt("it is too large to be unpacked", 0)
    return data


def _refusal(path: Path, what: str) -> CaseError:
    return CaseError(f"{path}: {what}; mend it, or give --allow-code if the case is yours")
