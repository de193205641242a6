"""Where a fault can be put in C++: signs, added terms, products, bounds of loops and components, line by line.

No site is a line with a text or a message, a comment, a declaration of a function, or one that includes a file.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from .fault import Fault, numbered

TALK = re.compile(r'"|#|<<|Error|Info|\bcase\b|operator|template|\busing\b')
LINE = re.compile(r"^\s+[\w*(].*[;{]\s*$|^\s+[-+:?]\s.*$")  # indented code that ends, or goes on with a sign
PATTERNS = (
    ("sign", re.compile(r"(?<=[\w)\]] )[-+](?= [\w(])"), {"+": "-", "-": "+"}),
    ("sign", re.compile(r"[-+]="), {"+=": "-=", "-=": "+="}),
    ("off by one", re.compile(r"(?<= )(?:<=|>=|<|>)(?= [\w(])"), {"<": "<=", "<=": "<", ">": ">=", ">=": ">"}),
    ("off by one", re.compile(r"(?<=label \w = )0(?=;)|(?<=label \w\w = )0(?=;)"), {"0": "1"}),
    ("index", re.compile(r"(?<=\.)[xyz](?=\(\))"), {"x": "y", "y": "z", "z": "x"}),
    ("index", re.compile(r"(?<=\[)[01](?=\])"), {"0": "1", "1": "0"}),
)
ADDED = re.compile(r"[\w.\->()\[\]]+ [-+]= [^;]*;")  # a whole statement that adds a term
PRODUCT = re.compile(r"(?:(?<= = )|(?<=return ))(?![^;]*(?:cast|char|byte|std::))[^;=]*[*/][^;=]*(?=;)")


def sites(room: str, file: str, source: bytes) -> list[Fault]:
    """All faults that a file has room for."""
    found, start = [], 0
    for number, line in enumerate(_without_comments(source.decode()).splitlines(keepends=True), 1):
        if LINE.match(line) and not TALK.search(line):
            found += _of_line(room, file, number, start, line)
        start += len(line.encode())
    return numbered(found)


def _of_line(room: str, file: str, number: int, start: int, line: str) -> Iterator[Fault]:
    def fault(found, new: str, kind: str) -> Fault:
        low = start + len(line[: found.start()].encode())
        old = found.group()
        return Fault(room, file, low, low + len(old.encode()), number, kind, line.strip(), old, new)

    for kind, pattern, table in PATTERNS:
        for found in pattern.finditer(line):
            yield fault(found, table[found.group()], kind)
    for found in ADDED.finditer(line):
        yield fault(found, ";", "drop")
    for found in PRODUCT.finditer(line):
        yield fault(found, f"1.2*({found.group()})", "factor")


def _without_comments(text: str) -> str:
    """The same text with blanks for what is commented out."""

    def blank(found) -> str:
        return re.sub(r"[^\n]", lambda one: " " * len(one.group().encode()), found.group())

    return re.sub(r"/\*.*?\*/|//[^\n]*", blank, text, flags=re.DOTALL)
