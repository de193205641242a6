"""Tokens of an OpenFOAM dictionary, cut where OpenFOAM cuts them (ISstream.C of v1912).

Blanks, comments and numbers are passed over, many at a time: most of a mesh is numbers. A comment begins where a token
may begin, so not in a string, not in a word (a word ends at the slash) and not in a variable, which may hold slashes.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from enum import Enum, auto
from typing import NamedTuple

# No group is repeated possessively: before Python 3.11.5 what fails within one is passed over all the same (gh-106052)
BLANK = rb"(?:\s++|//[^\n]*+|/\*(?s:.*?)\*/)"
NUMBER = rb"(?:\([-+.\deE\s]*+\)|[-.\d][-+.\deE]*+)"  # also a bracket of nothing else
SKIPPED = re.compile(rb"(?:%b|%b){0,4096}" % (BLANK, NUMBER))  # so many at a time: each takes memory
BLANKS = re.compile(BLANK + rb"*")
STRING = re.compile(rb'"([^"\\\n]*+(?:\\(?s:.)[^"\\\n]*+)*)"')
ESCAPED = re.compile(rb"\\(?s:(.))")
VERBATIM = re.compile(rb"\{(?s:(.*?))#\}")
IN_WORD = re.compile(rb"[^\s\"'/;{}]*+")
IN_VARIABLE = re.compile(rb"[^\s\"';{}]*+")
IN_BRACED_VARIABLE = re.compile(rb"[^\s\"';]*+")
MARKS = b";()[]{}:,=+*"


class Doubt(ValueError):
    """Content of a file that runs code of the case or may do so, and its place (byte)."""

    def __init__(self, what: str, place: int):
        super().__init__(what)
        self.place = place


class Kind(Enum):
    """Kinds of tokens; HASH is a word that begins with #, VERBATIM a string between #{ and #}."""

    WORD = auto()
    STRING = auto()
    VERBATIM = auto()
    VARIABLE = auto()
    HASH = auto()
    MARK = auto()


class Token(NamedTuple):
    """A token: its text (of strings what is inside, without escapes), and its first byte and the one behind it."""

    kind: Kind
    text: bytes
    start: int
    end: int

    def is_mark(self, marks: bytes) -> bool:
        """True where it is one of `marks`."""
        return self.kind is Kind.MARK and self.text in marks


class Tokens:
    """Tokens of `data` from `position` on, which others may move; `Doubt` where something has no end."""

    def __init__(self, data: bytes, position: int = 0):
        self.data, self.position = data, position

    def __iter__(self) -> Iterator[Token]:
        while (token := self.next()) is not None:
            yield token

    def next(self) -> Token | None:
        """The next token, None at the end."""
        start = self.position
        while (end := SKIPPED.match(self.data, start).end()) > start:
            start = end
        if start == len(self.data):
            self.position = start
            return None
        token = self._token(start)
        self.position = token.end
        return token

    def _token(self, start: int) -> Token:
        first = self.data[start : start + 1]
        if first in READERS:
            return READERS[first](self.data, start)
        if first in MARKS:
            return Token(Kind.MARK, first, start, start + 1)
        end = _word_end(self.data, start)
        kind = Kind.WORD if end > start else Kind.MARK  # a lone single quote
        return Token(kind, self.data[start : max(end, start + 1)], start, max(end, start + 1))


def _string(data: bytes, start: int) -> Token:
    found = STRING.match(data, start)
    if not found:
        raise Doubt("a string without an end", start)
    return Token(Kind.STRING, ESCAPED.sub(_unescaped, found.group(1)), start, found.end())


def _unescaped(pair: re.Match) -> bytes:
    """A backslash is dropped before a quote and the end of a line, and kept before all else."""
    return pair.group(1) if pair.group(1) in b'"\n' else pair.group()


def _hash(data: bytes, start: int) -> Token:
    """# takes the word behind it, over blanks and comments, or opens a verbatim string."""
    begin = BLANKS.match(data, start + 1).end()
    if data[begin : begin + 1] == b"{":
        found = VERBATIM.match(data, begin)
        if not found:
            raise Doubt("a verbatim string without an end", start)
        return Token(Kind.VERBATIM, found.group(1), start, found.end())
    end = _word_end(data, begin)
    return Token(Kind.HASH, b"#" + data[begin:end], start, max(end, start + 1))


def _variable(data: bytes, start: int) -> Token:
    begin = BLANKS.match(data, start + 1).end()
    if data[begin : begin + 1] == b"{":
        end = _balanced(data, begin, IN_BRACED_VARIABLE.match(data, begin).end(), b"{", b"}")
    else:
        end = _balanced(data, begin, IN_VARIABLE.match(data, begin).end(), b"(", b")")
    return Token(Kind.VARIABLE, b"$" + data[begin:end], start, max(end, start + 1))


def _slash(data: bytes, start: int) -> Token:
    if data[start + 1 : start + 2] == b"*":
        raise Doubt("a comment without an end", start)
    return Token(Kind.MARK, b"/", start, start + 1)


def _word_end(data: bytes, start: int) -> int:
    return _balanced(data, start, IN_WORD.match(data, start).end(), b"(", b")")


def _balanced(data: bytes, start: int, end: int, opening: bytes, closing: bytes) -> int:
    """The place of the first closing bracket before `end` that closes nothing, or `end`."""
    depth = 0
    for found in re.finditer(rb"[%b%b]" % (re.escape(opening), re.escape(closing)), data[start:end]):
        depth += 1 if found.group() == opening else -1
        if depth < 0:
            return start + found.start()
    return end


READERS = {b'"': _string, b"#": _hash, b"$": _variable, b"/": _slash}


def shown(text: bytes) -> str:
    """A piece of a file as a message shows it."""
    return repr(text[:40].decode("latin-1"))
