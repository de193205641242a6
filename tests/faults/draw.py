"""Which faults are planted: drawn with a fixed seed over rooms and kinds, or given in a file."""

from __future__ import annotations

import itertools
import random
import tomllib
from collections.abc import Iterator
from pathlib import Path

from . import cpp_sites, python_sites
from .fault import KINDS, Fault
from .rooms import ROOMS, sources


def in_room(root: Path, room: str) -> list[Fault]:
    """Every fault that there is room for."""
    found = []
    for file in sources(root, room):
        read = python_sites if file.suffix == ".py" else cpp_sites
        found += read.sites(room, str(file.relative_to(root)), file.read_bytes())
    return found


def of_room(root: Path, room: str, seed: int) -> Iterator[Fault]:
    """Faults of a room in the order of a seed, one kind after the other, and of a kind one file after the other."""
    own, found = random.Random(f"{seed} {room}"), in_room(root, room)
    kinds = [_mixed([fault for fault in found if fault.kind == kind], own) for kind in KINDS]
    own.shuffle(kinds)
    return (fault for row in itertools.zip_longest(*kinds) for fault in row if fault)


def _mixed(faults: list[Fault], own: random.Random) -> list[Fault]:
    """In random order, each file once before any comes again."""
    own.shuffle(faults)
    turns: dict[str, int] = {}
    places = []
    for fault in faults:
        turns[fault.file] = turns.get(fault.file, 0) + 1
        places.append(turns[fault.file])
    return [fault for _, fault in sorted(zip(places, faults), key=lambda pair: pair[0])]


def drawn(root: Path, seed: int, only=()) -> Iterator[Fault]:
    """One fault of each room, then a second one, and so on."""
    rooms = [of_room(root, room, seed) for room in only or ROOMS]
    return (fault for row in itertools.zip_longest(*rooms) for fault in row if fault)


def given(root: Path, file: Path) -> list[Fault]:
    """The faults of a TOML file: [[fault]] with room, file, old (a text that is there once), new, and by."""
    found = []
    for row in tomllib.loads(file.read_text(encoding="utf-8"))["fault"]:
        source = (root / row["file"]).read_bytes()
        old = row["old"].encode()
        if source.count(old) != 1:
            raise ValueError(
                f"{file.name}: {row['old']!r} is {source.count(old)} times in {row['file']}; it must be once"
            )
        start = source.index(old)
        line = source.count(b"\n", 0, start) + 1
        found.append(
            Fault(row["room"], row["file"], start, start + len(old), line, "given", row["by"], row["old"], row["new"])
        )
    return found
