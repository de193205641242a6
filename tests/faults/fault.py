"""A fault: a piece of a source file, and what is put in its place."""

from __future__ import annotations

import hashlib
from typing import NamedTuple

KINDS = ("sign", "factor", "index", "drop", "off by one")


class Fault(NamedTuple):
    """Bytes `start` to `end` of `file` become `new`; `where` is the function, or the line of C++, and `number` counts
    faults that are else alike."""

    room: str
    file: str
    start: int
    end: int
    line: int
    kind: str
    where: str
    old: str
    new: str
    number: int = 0

    @property
    def name(self) -> str:
        """Eight hexadecimal digits, which stay while other lines of the file change."""
        own = (self.file, self.where, self.kind, self.old, self.new, str(self.number))
        return hashlib.sha256("\0".join(own).encode()).hexdigest()[:8]

    def planted(self, source: bytes) -> bytes:
        """The file with the fault in it."""
        assert source[self.start : self.end] == self.old.encode(), f"{self.file} is not what it was drawn from"
        return source[: self.start] + self.new.encode() + source[self.end :]

    def __str__(self) -> str:
        old, new = (" ".join(text.split()) for text in (self.old, self.new))
        return f"{self.name}  {self.file}:{self.line} ({self.where})  {self.kind}: {old}  ->  {new}"


def numbered(faults) -> list[Fault]:
    """Faults in order, those that are alike counted."""
    seen: dict[tuple, int] = {}
    result = []
    for fault in sorted(faults, key=lambda fault: (fault.start, fault.end, fault.kind, fault.new)):
        alike = (fault.where, fault.kind, fault.old, fault.new)
        result.append(fault._replace(number=seen.get(alike, 0)))
        seen[alike] = seen.get(alike, 0) + 1
    return result
