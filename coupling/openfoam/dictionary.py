"""Dictionaries of an OpenFOAM case as Python values: what another's case says of itself, without running any of it.

An entry is a dict, or the list of its values: numbers, words, lists (of brackets) and `Dimensions`. Macros ($name) and
#include are followed; what would run code, or is not known, is the value UNKNOWN.
"""

from __future__ import annotations

import gzip
import re
from pathlib import Path

from sdph.schema import CaseError

UNKNOWN = "#unknown"
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
TOKEN = re.compile(
    r"""\s+|//[^\n]*|/\*.*?\*/|(?P<verbatim>\#\{.*?\#\})|(?P<text>"(?:\\.|[^"\\])*")|(?P<hash>\#\w+)"""
    r"""|(?P<variable>\$(?:\{[^}]*\}|[\w:.]+))|(?P<mark>[][{}();])"""
    r"""|(?P<word>[^\s;{}()[\]"]+(?:\([^\s()]*\)[^\s;{}()[\]"]*)*)""",
    re.DOTALL,
)
BINARY = re.compile(rb"List<(scalar|vector|symmTensor|tensor)>\s*(\d+)\s*\(")
WIDTHS = {b"scalar": 1, b"vector": 3, b"symmTensor": 6, b"tensor": 9}
INCLUDES, PASSED = ("#include", "#includeIfPresent", "#sinclude"), ("#inputMode", "#includeEtc", "#includeFunc")
DEEPEST = 20  # includes and brackets within each other; our choice


class Dimensions(tuple):
    """Exponents of a unit, [kg m s K ...]."""

    __slots__ = ()


def read(path: Path) -> dict:
    """The dictionary of a file, or of FILE.gz; empty where there is none."""
    data = content(path)
    return {} if data is None else _Reader(path).block(_tokens(_without_binary(data)), {}, ())


def content(path: Path) -> bytes | None:
    """Bytes of a file, or of its compressed form; None where neither is there."""
    packed = path.with_name(f"{path.name}.gz")
    try:
        if path.is_file():
            return path.read_bytes()
        return gzip.decompress(packed.read_bytes()) if packed.is_file() else None
    except (OSError, EOFError) as error:
        raise CaseError(f"{path} cannot be read: {error}; mend the OpenFOAM case") from None


def _without_binary(data: bytes) -> str:
    """Text of a file; lists of a binary one are left out."""
    if not re.search(rb"format\s+binary", data[:2000]):
        return data.decode("utf-8", "replace")
    parts, place = [], 0
    for found in BINARY.finditer(data):
        if found.start() >= place:
            parts.append(data[place : found.start()])
            place = found.end() + 8 * WIDTHS[found.group(1)] * int(found.group(2)) + 1
    return b" ".join([*parts, data[place:]]).decode("utf-8", "replace")


def _tokens(text: str):
    """(kind, text) of the tokens, blanks and comments left out."""
    return iter([(found.lastgroup, found.group()) for found in TOKEN.finditer(text) if found.lastgroup])


class _Reader:
    """Reader of one file and of what it includes."""

    def __init__(self, path: Path):
        self.path, self.depth = path, 0

    def block(self, tokens, found: dict, outer: tuple) -> dict:
        """Entries up to a closing bracket, or the end, put into `found`; `outer` are the dictionaries around it."""
        for kind, text in tokens:
            if text == "}":
                break
            if kind == "hash":
                self._directive(text, tokens, found, outer)
            elif kind == "variable":
                found.update(entry if isinstance(entry := _looked_up(text, found, outer), dict) else {})
            elif kind in ("word", "text"):
                self._entry(text.strip('"'), tokens, found, outer)
        return found

    def _entry(self, key: str, tokens, found: dict, outer: tuple) -> None:
        values = []
        for kind, text in tokens:
            if text == "{":
                found[key] = self._nested(tokens, found.get(key), (found, *outer))
                return
            if text == ";":
                break
            values += self._value(kind, text, tokens, found, outer)
        whole = values[0] if len(values) == 1 and isinstance(values[0], dict) else values
        found[key] = whole

    def _nested(self, tokens, before, outer: tuple) -> dict:
        return self.block(tokens, dict(before) if isinstance(before, dict) else {}, outer)

    def _value(self, kind: str, text: str, tokens, found: dict, outer: tuple) -> list:
        """Values that a token stands for, and those within its brackets."""
        if text in "([":
            return [self._list(text, tokens, found, outer)]
        if text == "{":  # within a list
            return [self.block(tokens, {}, (found, *outer))]
        if kind == "variable":
            own = _looked_up(text, found, outer)
            return own if isinstance(own, list) else [own]
        if kind in ("hash", "verbatim"):
            return [UNKNOWN]
        return [_plain(text)]

    def _list(self, opening: str, tokens, found: dict, outer: tuple):
        inside = []
        for kind, text in tokens:
            if text in ")]":
                break
            inside += self._value(kind, text, tokens, found, outer)
        return Dimensions(inside) if opening == "[" else inside

    def _directive(self, name: str, tokens, found: dict, outer: tuple) -> None:
        """Follow an include; what else stands as an entry takes one word."""
        if name not in (*INCLUDES, *PASSED):
            return
        target = next(tokens, ("", ""))[1].strip('"')
        path = self.path.parent / target
        if name in INCLUDES and self.depth < DEEPEST and "$" not in target and (data := content(path)) is not None:
            self.depth += 1
            self.block(_tokens(_without_binary(data)), found, outer)
            self.depth -= 1


def _plain(text: str):
    return float(text) if NUMBER.fullmatch(text) else text.strip('"')


def _looked_up(text: str, found: dict, outer: tuple):
    """Value of a macro in its dictionary or those around it; UNKNOWN where it is not there."""
    name = text[1:].strip("{}").lstrip(":.")
    for scope in (found, *outer):
        own = scope
        for part in [name] if name in scope else name.split("."):
            own = own.get(part) if isinstance(own, dict) else None
        if own is not None:
            return own
    return UNKNOWN


def number(entry) -> float | None:
    """The last number of an entry, such as `nu [0 2 -1 0 0 0 0] 1e-05` or `uniform 300`, of an uneven field the mean;
    None where there is none."""
    if uneven(entry):
        values = entry[-1] if isinstance(entry[-1], list) else []
        return sum(values) / len(values) if values and all(isinstance(value, float) for value in values) else None
    found = [value for value in entry if isinstance(value, float)] if isinstance(entry, list) else []
    return found[-1] if found and UNKNOWN not in entry else None


def uneven(entry) -> bool:
    """Tell whether an entry is a field, value by value."""
    return isinstance(entry, list) and "nonuniform" in entry


def vector(entry) -> list[float] | None:
    """The last three numbers in brackets of an entry; None where there are none."""
    found = [value for value in entry if isinstance(value, list)] if isinstance(entry, list) else []
    whole = bool(found) and len(found[-1]) == 3 and all(isinstance(value, float) for value in found[-1])
    return [float(value) for value in found[-1]] if whole else None


def table(entry) -> list[tuple[float, list[float]]] | None:
    """Times and vectors of a Function1, `table ((0 (0 0 0)) (1 (0 0 1)))` or a dictionary with such `values`; None of
    what is no table of vectors, or goes on otherwise than as it ends."""
    bounds = entry.get("outOfBounds") if isinstance(entry, dict) else None
    own = [*entry.get("type", []), *entry.get("values", [])] if isinstance(entry, dict) else entry
    if not isinstance(own, list) or len(own) != 2 or own[0] != "table" or not isinstance(own[1], list):
        return None
    if bounds not in (None, ["clamp"]) or not all(isinstance(row, list) and len(row) == 2 for row in own[1]):
        return None
    rows = [(time, vector([velocity])) for time, velocity in own[1]]
    return rows if all(isinstance(time, float) and velocity for time, velocity in rows) else None


def word(entry) -> str:
    """The first word of an entry; empty where there is none."""
    return next((value for value in entry if isinstance(value, str)), "") if isinstance(entry, list) else ""


def of_patch(entries: dict, patch: str) -> dict:
    """Entry of a patch in boundaryField: by its name, else by the last pattern that it fits; empty where none does."""
    if isinstance(entries.get(patch), dict):
        return entries[patch]
    for pattern, entry in reversed(entries.items()):
        try:
            if isinstance(entry, dict) and re.fullmatch(pattern, patch):
                return entry
        except re.error:
            continue
    return {}
