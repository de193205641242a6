"""Directives of a dictionary (#include and its like): which run code, and where those lead that read another file."""

from __future__ import annotations

import os
import re
from pathlib import Path

from coupling.openfoam.code.tokens import Doubt, Token, Tokens, shown

CODE = re.compile(rb"(?i)#\s*(?:calc|code|stream)")  # of openfoam.org too
PATH = rb"[ \t]*+(?:\"([^\"\\\n]*+)\"|([^\s\"'/;{}#$()]++))"
FUNCTION = rb"[ \t]*+\"?([A-Za-z]\w*+)(?:\([\w,.]*+\))?\"?(?=\s|;|\Z)"
LEFT = rb"()"
EVALUATED = rb"[ \t]*+(?:\"[^\"\\\n]*+\"|\{(?:[^{}\"#/\\\n]|/(?![/*]))*\})()"
ARGUMENTS = {  # what stands behind a directive, in its line
    b"#include": PATH, b"#sinclude": PATH, b"#includeIfPresent": PATH, b"#includeEtc": PATH, b"#sincludeEtc": PATH,
    b"#includeFunc": FUNCTION, b"#inputMode": rb"[ \t]*+\w++()", b"#eval": EVALUATED,
    b"#remove": rb"(?:[ \t]*+\"[^\"\\\n]*+\"|())",
    b"#if": LEFT, b"#ifeq": LEFT, b"#elif": LEFT, b"#else": LEFT, b"#endif": LEFT,
}  # fmt: skip
# The rest of the line is passed over unread where entries are skipped: nothing may begin in it that ends behind it
PLAIN = re.compile(rb"(?:[^\"#/\\$\n]|\"[^\"\\\n]*+\"|/(?![/*])|\$(?=[\w{:.\[]))*(?://[^\n]*+)?(?=\n|\Z)")

OF_CASE = {"$FOAM_CASE": "", "${FOAM_CASE}": "", "<case>": "", "<constant>": "constant", "<system>": "system"}
CERTAIN = re.compile(r"[\w.,+@=:%/-]+", re.ASCII)
WRITTEN = re.compile(r"log\..*|exchange-.*|postProcessing")  # by programs as they go


def follow(token: Token, tokens: Tokens, file: Path) -> set[Path]:
    """Step over what is behind a directive of `file`, and give the files that it reads, by their places in the case."""
    if CODE.match(token.text):
        raise Doubt(f"{shown(token.text)} runs code of the case", token.start)
    if token.text not in ARGUMENTS:
        raise Doubt(f"{shown(token.text)} is not known and may run code of the case", token.start)
    require_plain_line(token, tokens)
    argument = re.compile(ARGUMENTS[token.text]).match(tokens.data, token.end)
    if not argument:
        raise Doubt(f"what is behind {shown(token.text)} cannot be judged", token.start)
    tokens.position = argument.end()
    given = os.fsdecode(next((group for group in argument.groups() if group is not None), b""))
    return _read_by(token, given, file)


def _read_by(token: Token, given: str, file: Path) -> set[Path]:
    """The files that a directive reads; those of OpenFOAM's own etc are none of the case."""
    if token.text == b"#includeFunc":
        return {Path("system", given)}
    if token.text.endswith(b"Etc"):
        _require_inside(given, ".." if ".." in given.split("/") else given, token)
        return set()
    if not token.text.startswith((b"#include", b"#sinclude")):
        return set()
    return {_place(given, parent, token) for parent in _parents(given, file)}


def _parents(given: str, file: Path) -> set[Path]:
    """Folders from which a name counts: that of the file that has it; ./ is the folder where programs run."""
    return {file.parent, Path()} if given.startswith("./") else {file.parent}


def _place(given: str, parent: Path, token: Token) -> Path:
    head, slash, rest = given.partition("/")
    if slash and head in OF_CASE:
        parent, given = Path(OF_CASE[head]), rest
    place = os.path.normpath(parent / given)
    _require_inside(given, place, token)
    if WRITTEN.fullmatch(place.split("/")[0]):
        raise Doubt(f"it includes {place}, which is written as the programs run", token.start)
    return Path(place)


def _require_inside(given: str, place: str, token: Token) -> None:
    if given.startswith(("/", "~")) or place.split("/")[0] in ("..", "."):
        raise Doubt(f"{shown(token.text)} {given!r} leads out of the case", token.start)
    if not CERTAIN.fullmatch(given):
        raise Doubt(f"where {shown(token.text)} {given!r} leads cannot be said", token.start)


def names_one(text: bytes) -> bool:
    """True where a quoted text is a directive where a key is expected, as `"#calc"` is."""
    name = b"#" + text[1:].strip()
    return text.startswith(b"#") and (name in ARGUMENTS or CODE.match(name) is not None)


def require_plain_line(token: Token, tokens: Tokens) -> None:
    """`Doubt` where something begins behind a directive, in its line, that ends in another line."""
    begin = token.end
    if tokens.data.find(b"\n", token.start, begin) >= 0 or not PLAIN.match(tokens.data, begin):
        raise Doubt(f"the line of {shown(token.text)} cannot be judged", token.start)
