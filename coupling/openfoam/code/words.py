"""The words of a file, one by one: refused in whatever place one of them could run code."""

from __future__ import annotations

import re
from pathlib import Path

from coupling.openfoam.code import binary, directives, patterns
from coupling.openfoam.code.tokens import Doubt, Kind, Token, Tokens, shown

# Entries that load libraries, types that run code or commands or write over files, switches of the programs, and lists
# of bytes and files within a file, where text would begin that is not seen here
CODE = re.compile(
    rb"(?i)(?<![a-z0-9_])[a-z0-9_]*libs(?![a-z0-9_])|coded|codeStream|systemCall|timeActivatedFileUpdate"
    rb"|allowSystemOperations|^(?:Info|Optimisation)Switches$|decomposedBlockData|^List<char>"
)
LIBRARIES = re.compile(rb"(?i)\w*libs")
WORD = re.compile(rb"[\w:.<>-]+")
INVALID = re.compile(rb"[\s\"';{}]")  # in words: dropped from keys such as "of/li bs"
FOAM_CASE = b"FOAM_CASE"  # includes would take an entry of that name for the variable
HEADER = b"FoamFile"


class Words:
    """A file as it is read: `file` is its place in the case, `strict` counts directives that are not known."""

    def __init__(self, data: bytes, file: Path, strict: bool):
        self.data, self.file, self.tokens = data, file, Tokens(data)
        self.included: set[Path] = set()
        self.strict, self.binary = strict or has_header(data), False
        self.header = self._header() if has_header(data) else {}
        self.binary = self.header.get(b"format") == b"binary"

    def read(self) -> None:
        """Go through the file; `Doubt` where it runs code, or may do so."""
        if self.binary:
            binary.require_known(self.header)
            if self.header.get(b"class") in binary.FILES:
                return binary.require_lists_alone(self.data, self.tokens.position, binary.FILES[self.header[b"class"]])
        for token in self.tokens:
            CHECKS[token.kind](self, token)

    def _header(self) -> dict[bytes, bytes]:
        """Key -> value of FoamFile {...}, which says how the rest is read: words and texts alone."""
        found: dict[bytes, bytes] = {}
        entry: list[Token] = []
        self.tokens.next()
        for count, token in enumerate(self.tokens):
            CHECKS[token.kind](self, token)
            if token.is_mark(b"}") and not entry:
                return found
            if token.is_mark(b";"):
                _keep(entry, found)
                entry = []
            elif token.kind in (Kind.WORD, Kind.STRING) and count > 0:
                entry.append(token)
            elif not (token.is_mark(b"{") and count == 0):
                break
        raise Doubt("a FoamFile header that is more than words and texts cannot be judged", 0)

    def word(self, token: Token) -> None:
        """A bare word, or the head of a list."""
        _refuse_code(token)
        if self.binary:
            self.tokens.position = binary.after_list(self.data, token.text, token.end)

    def quoted(self, token: Token) -> None:
        """A text, which may be a key, a directive or an expression too."""
        if WORD.fullmatch(token.text):
            _refuse_code(token)
        if b"/" in token.text:
            _refuse_scoped_key(token)
        if token.text.startswith(b"#"):
            self._refuse_directive(token)
        if patterns.may_be_key(token.text) and not patterns.value_is_harmless(self.data, token.end):
            raise Doubt(f"{shown(token.text)} as a key may stand for libs and run code of the case", token.start)

    def _refuse_directive(self, token: Token) -> None:
        if directives.names_one(token.text):
            raise Doubt(f"{shown(token.text)} may run code of the case", token.start)
        if self.strict:
            directives.require_plain_line(token, self.tokens)

    def variable(self, token: Token) -> None:
        """A macro; newer versions of OpenFOAM end one sooner, and evaluate ${{...}}."""
        _refuse_code(token)
        if re.search(rb"//|/\*|\$\{\{", token.text):
            raise Doubt(f"{shown(token.text)} cannot be judged", token.start)

    def hash(self, token: Token) -> None:
        """A directive; one that is not known is a comment in a file that is no dictionary, such as a table."""
        if self.strict or directives.names_one(token.text):
            self.included |= directives.follow(token, self.tokens, self.file)

    def mark(self, token: Token) -> None:
        """Ignore a bracket or another mark."""


CHECKS = {
    Kind.WORD: Words.word, Kind.STRING: Words.quoted, Kind.VERBATIM: Words.quoted, Kind.VARIABLE: Words.variable,
    Kind.HASH: Words.hash, Kind.MARK: Words.mark,
}  # fmt: skip


def has_header(data: bytes) -> bool:
    """True where a file begins with FoamFile, as those do that OpenFOAM opens by itself."""
    token = Tokens(data).next()
    return token is not None and token.kind is Kind.WORD and token.text == HEADER


def _keep(entry: list[Token], found: dict[bytes, bytes]) -> None:
    """Enter `key value;`; a number as a value is none of the tokens."""
    if not entry:
        return
    key, *values = entry
    if key.kind is not Kind.WORD or key.text in found or len(values) > 1:
        raise Doubt(f"{shown(key.text)} in a FoamFile header cannot be judged", key.start)
    found[key.text] = b" ".join(value.text for value in values)


def _refuse_code(token: Token) -> None:
    found = CODE.search(token.text)
    if found:
        raise Doubt(f"{shown(found.group())} runs code of the case", token.start)
    if token.text == FOAM_CASE:
        raise Doubt("FOAM_CASE as an entry: where includes lead cannot be said", token.start)


def _refuse_scoped_key(token: Token) -> None:
    """A key with slashes makes an entry of its last part, without what no word can have."""
    for part in token.text.split(b"/"):
        if LIBRARIES.fullmatch(INVALID.sub(b"", part)) or part == FOAM_CASE:
            raise Doubt(f"{shown(token.text)} as a key runs code of the case", token.start)
