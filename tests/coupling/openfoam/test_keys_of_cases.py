"""Keys of OpenFOAM cases that load code: known however they are written."""

import subprocess

import pytest
from hypothesis import given
from hypothesis import strategies as st
from written_cases import DICTIONARY, put

from coupling.openfoam.code import refuse_code
from coupling.openfoam.code.patterns import may_be_key
from coupling.openfoam.programs import barrier
from sdph.schema import CaseError

PIECES = (
    'libs ("x.so");',
    '"li.*" ("x.so");',
    '"libs" ("x.so");',
    '"a/libs" ("x.so");',
    "/*",
    "*/",
    "//",
    "\n",
    '"',
    '\\"',
    "\\\n",
    "#{",
    "#}",
    "$x/",
    "${x}",
    "{",
    "}",
    ";",
    " a ",
    'note "',
    '";',
    "FoamFile ",
    "FoamFile { ",
    "#inputMode protect\n",
    "#if 0\n",
    "#else\n",
    "#endif\n",
    "x (",
    ")",
    "List<char> 2(",
    " 1",
    "#",
    "'",
    "#eval {",
)


@pytest.mark.openfoam
@given(st.lists(st.sampled_from(PIECES), min_size=1, max_size=8), st.sampled_from(["", "//*/", '";', "#}", "\n}\n"]))
def test_whatever_passes_gives_openfoam_no_libraries(tmp_path_factory, pieces, end):
    """foamDictionary is the judge: it reads what the reader has let pass."""
    case = tmp_path_factory.mktemp("gas")
    put(case, "system/a", DICTIONARY + "".join(pieces) + '\nlibs ("x.so");' + end)
    try:
        refuse_code(case)
    except CaseError:
        return
    command = ["foamDictionary", "-entry", "libs", "-value", "system/a"]
    done = subprocess.run(command, cwd=case, env=barrier.environment(), capture_output=True, check=False)
    assert done.returncode != 0 or b"x.so" not in done.stdout


MATCHING = (  # with the head, the tail and the capitals of a key
    "{0}.*", ".*{1}", "{0}({1}|x)", "{0}[a-zA-Z]*", "(?i){2}", "^{0}{1}$", "((({0}))).*", "{0}.+.*.*.*.*.*",
    "[[:alpha:]]*", "{0}(a*)*{1}",
)  # fmt: skip


@given(st.sampled_from(["libs", "functionObjectLibs"]), st.data())
def test_expressions_that_match_a_key_are_known(key, data):
    cut = data.draw(st.integers(0, len(key)))
    head, tail = key[:cut], key[cut:]
    form = data.draw(st.sampled_from(MATCHING))
    assert may_be_key(form.format(head, tail, key.upper()).encode())


def test_expressions_that_take_for_ever_are_not_tried():
    assert may_be_key(b"(.+)*x") and may_be_key(b"(.+)+(.+)+x")


@pytest.mark.parametrize("pattern", ["inlet.*", "(U|k|epsilon)", "div\\(.*\\)", "lib", "libs", ".*Wall"])
def test_other_expressions_are_none(pattern):
    assert not may_be_key(pattern.encode())
