"""Lists of a binary file: bytes that are no text, which OpenFOAM steps over by their number."""

from __future__ import annotations

import re

from coupling.openfoam.code.tokens import BLANKS, Doubt

ARCHITECTURE = b"LSB;label=32;scalar=64"  # what most builds write; the widths below are of it
WIDTHS = {  # bytes of an entry of List<...>
    b"bool": 1, b"label": 4, b"scalar": 8, b"sphericalTensor": 8, b"edge": 8, b"complex": 16, b"vector": 24,
    b"symmTensor": 48, b"complexVector": 48, b"tensor": 72,
}  # fmt: skip
FILES = {  # class of a file that is nothing but lists -> bytes of an entry of each
    b"labelList": (4,), b"scalarField": (8,), b"vectorField": (24,), b"faceCompactList": (4, 4),
}  # fmt: skip
LIST = re.compile(rb"List<(\w+)>")
COUNT = re.compile(rb"\d{1,12}")
# longer than what turns up by chance among so many bytes
SUSPICIOUS = re.compile(rb"(?i)#\s*(?:calc|code|s?include)|libs\"?\s*\(|coded[a-z]|systemCall")


def require_known(header: dict[bytes, bytes]) -> None:
    """`Doubt` where the lists of a binary file cannot be told from its text."""
    if header.get(b"arch") != ARCHITECTURE:
        found = header.get(b"arch", b"missing").decode("latin-1")
        raise Doubt(f"a binary file whose arch is {found}, not {ARCHITECTURE.decode()}, cannot be judged", 0)


def after_list(data: bytes, word: bytes, position: int) -> int:
    """The place behind the list that `word` opens before `position`; `position` where it is no list in bytes."""
    found = LIST.fullmatch(word)
    if not found or found.group(1) in (b"word", b"string"):
        return position
    if found.group(1) not in WIDTHS:
        raise Doubt(f"a binary {word.decode('latin-1')} cannot be judged", position)
    return _after(data, position, WIDTHS[found.group(1)])


def require_lists_alone(data: bytes, position: int, widths: tuple[int, ...]) -> None:
    """`Doubt` where from `position` on there is more, or less, than lists with entries of `widths` bytes."""
    for width in widths:
        before, position = position, _after(data, position, width)
        if position == before:
            raise Doubt("a binary file that is not what its class says cannot be judged", position)
    if BLANKS.match(data, position).end() != len(data):
        raise Doubt("a binary file with more than its class says cannot be judged", position)


def _after(data: bytes, position: int, width: int) -> int:
    """The place behind `N(bytes)`, or `0()` or `0`; `position` where none of them is there."""
    count = COUNT.match(data, BLANKS.match(data, position).end())
    if not count:
        return position
    begin = BLANKS.match(data, count.end()).end()
    if data[begin : begin + 1] != b"(":
        return count.end() if int(count.group()) == 0 else position
    end = begin + 1 + int(count.group()) * width
    closing = BLANKS.match(data, min(end, len(data))).end()
    if data[closing : closing + 1] != b")":
        raise Doubt("a binary list does not end where it should", position)
    found = SUSPICIOUS.search(data, begin, end)
    if found:
        raise Doubt(f"{found.group().decode('latin-1')!r} among numbers may run code of the case", found.start())
    return closing + 1
