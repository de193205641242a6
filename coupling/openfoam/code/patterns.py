"""Regular expressions as keys: `"li.*" ("mine.so");` is found by who looks for `libs`."""

from __future__ import annotations

import re

from coupling.openfoam.code.tokens import Kind, Tokens

KEYS = (  # under which OpenFOAM looks for libraries, and for what includes expand
    "libs", "functionObjectLibs", "motionSolverLibs", "dynamicFvMeshLibs", "geometricGAMGAgglomerationLibs",
    "algebraicGAMGAgglomerationLibs", "FOAM_CASE",
)  # fmt: skip
SPECIAL = re.compile(rb"[\\.*+?()\[\]{}|^$]")
# Expressions that mean the same here and in POSIX, and are quick to decide: no classes and bounds, no escaped letters,
# nothing repeated that holds repetitions, few repetitions (our choice)
SIMPLE = re.compile(rb"(?:[\w\s.*+?|():,<>=@%-]|\\[^\w\s])*")
NESTED = re.compile(rb"\)[*+?]|\(\?|[*+?]{2}")
REPETITIONS = 4
LONGEST = 200


def may_be_key(text: bytes) -> bool:
    """True where a quoted key is an expression that matches one of KEYS, or may do so."""
    return SPECIAL.search(text) is not None and any(_may_match(part.strip(b"'")) for part in {text, *text.split(b"/")})


def _may_match(part: bytes) -> bool:
    repetitions = sum(part.count(mark) for mark in (b"*", b"+", b"?"))
    if not SIMPLE.fullmatch(part) or NESTED.search(part) or repetitions > REPETITIONS or len(part) > LONGEST:
        return True
    try:
        expression = re.compile(part.decode("latin-1"))
    except re.error:
        return True
    return any(expression.fullmatch(key) for key in KEYS)


def value_is_harmless(data: bytes, position: int) -> bool:
    """True where a dictionary, the end of a list, or a value that names no library follows a quoted text."""
    depth, names = 0, False
    for count, token in enumerate(Tokens(data, position)):
        if (token.is_mark(b"{") and count == 0) or (token.is_mark(b")]}") and depth == 0):
            return True
        if token.is_mark(b";") and depth == 0:
            return not names
        depth += token.is_mark(b"([{") - token.is_mark(b")]}")
        names |= token.kind is not Kind.MARK and (depth > 0 or token.kind is not Kind.WORD)
    return False
