"""Words of OpenFOAM dictionaries are cut where OpenFOAM cuts them."""

import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from coupling.openfoam import code
from coupling.openfoam.code.tokens import Doubt, Kind, Tokens

WORD, STRING, VERBATIM, VARIABLE, HASH, MARK = Kind


def cut(text):
    return [(token.kind, token.text) for token in Tokens(text)]


@pytest.mark.parametrize("text, expected", [
    (b'note "http://x"; libs', [(WORD, b"note"), (STRING, b"http://x"), (MARK, b";"), (WORD, b"libs")]),
    (b'"/*" libs "*/"', [(STRING, b"/*"), (WORD, b"libs"), (STRING, b"*/")]),
    (b'"a\\"//" b', [(STRING, b'a"//'), (WORD, b"b")]),
    (b'"a\\\\" b "c"', [(STRING, b"a\\\\"), (WORD, b"b"), (STRING, b"c")]),
    (b'"a\\\nb"', [(STRING, b"a\nb")]),
    (b'a // "\n b', [(WORD, b"a"), (WORD, b"b")]),
    (b'a /* " // */ b', [(WORD, b"a"), (WORD, b"b")]),
    (b"a /*/ b */ c", [(WORD, b"a"), (WORD, b"c")]),
    (b"a/**/b//", [(WORD, b"a"), (WORD, b"b")]),
    (b"div(phi,U) Gauss;", [(WORD, b"div(phi,U)"), (WORD, b"Gauss"), (MARK, b";")]),
    (b"(a b)", [(MARK, b"("), (WORD, b"a"), (WORD, b"b"), (MARK, b")")]),
    (b'libs("x")', [(WORD, b"libs("), (STRING, b"x"), (MARK, b")")]),
    (b"$x/* libs */", [(VARIABLE, b"$x/*"), (WORD, b"libs"), (MARK, b"*"), (MARK, b"/")]),
    (b"${a{b}c}d; e", [(VARIABLE, b"${a{b}c}d"), (MARK, b";"), (WORD, b"e")]),
    (b"{$x}", [(MARK, b"{"), (VARIABLE, b"$x"), (MARK, b"}")]),
    (b"#calc #{ a # } \" #}; b", [(HASH, b"#calc"), (VERBATIM, b' a # } " '), (MARK, b";"), (WORD, b"b")]),
    (b"# /* */ \n calc", [(HASH, b"#calc")]),
    (b"# {x#}", [(VERBATIM, b"x")]),
    (b"a#calc", [(WORD, b"a#calc")]),
    (b"-1.5e-3 .5 (0 1e5 2) 4(0 1 2 3) - x", [(WORD, b"x")]),
    (b"5libs", [(WORD, b"libs")]),
    (b"2//3\n4 a", [(WORD, b"a")]),
    (b"' a", [(MARK, b"'"), (WORD, b"a")]),
    (b"", []), (b" \n// end", []),
])  # fmt: skip
def test_words_are_cut_as_openfoam_does(text, expected):
    assert cut(text) == expected


@pytest.mark.parametrize("text", [b'a "b', b'"a\nb"', b"a /* b", b"/*/", b"#{ a #", b'"a\\"'])
def test_what_has_no_end_is_told(text):
    with pytest.raises(Doubt, match="without an end"):
        cut(text)


PIECES = {  # text -> what is found in it
    b'"a // b"': (STRING, b"a // b"),
    b'"/*"': (STRING, b"/*"),
    b'"#{"': (STRING, b"#{"),
    b'"\\""': (STRING, b'"'),
    b'#{ // " #}': (VERBATIM, b' // " '),
    b"word": (WORD, b"word"),
    b"f(a,b)": (WORD, b"f(a,b)"),
    b"$x": (VARIABLE, b"$x"),
    b"${x}": (VARIABLE, b"${x}"),
    b"#include": (HASH, b"#include"),
    b";": (MARK, b";"),
    b"{": (MARK, b"{"),
    b"}": (MARK, b"}"),
    b"(": (MARK, b"("),
    b",": (MARK, b","),
}
COMMENTS = [b' // " /* #{\n', b' /* // " #{ */ ', b" /***/ "]
GAPS = st.sampled_from([b" ", b"\n", b"\t", b" 1.5e-3 ", b" (0 0 1) ", *COMMENTS])


@given(st.lists(st.tuples(GAPS, st.sampled_from(list(PIECES)))), GAPS)
def test_nothing_is_hidden_between_comments_and_numbers(pairs, last):
    assert cut(b"".join(b"%b%b" % pair for pair in pairs) + b" " + last) == [PIECES[piece] for _, piece in pairs]


@given(st.text(alphabet="ab1.-e \"\\/*#{}()$;\n'", max_size=40).map(str.encode))
def test_tokens_go_forward_and_cover_what_is_no_blank(text):
    place = 0
    try:
        for token in Tokens(text):
            assert place <= token.start < token.end <= len(text)
            place = token.end
    except Doubt as doubt:
        assert place <= doubt.place < len(text)


@given(st.lists(st.floats(allow_nan=False, allow_infinity=False)), st.integers(0, 3))
def test_numbers_are_passed_over(numbers, depth):
    text = b" ".join(b"%r" % number for number in numbers)
    assert all(kind is MARK for kind, _ in cut(b"(" * depth + text + b")" * depth))


def test_no_group_is_repeated_possessively():
    """Before Python 3.11.5 (Debian 12) such a group passes over what it does not match (gh-106052)."""
    folder = Path(code.__file__).parent
    found = {file.name: re.findall(r"\)(?:[*+?]|\{[0-9,]+\})\+", file.read_text()) for file in folder.glob("*.py")}
    assert len(found) > 3 and not any(found.values()), found
