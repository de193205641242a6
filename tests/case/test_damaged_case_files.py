"""Files of cases: what is no TOML, too large, or harmed is refused with one line."""

import copy

import pytest
from builders import DISC, disc
from discs import TABLE, read_back
from hypothesis import given, settings
from hypothesis import strategies as st

from sdph.case import gas_cells
from sdph.case import read as cases
from sdph.schema import CaseError


def test_a_byte_order_mark_is_no_error(tmp_path):
    file = tmp_path / "case.toml"
    file.write_bytes(b"\xef\xbb\xbf" + DISC.read_bytes())
    assert cases.load(file) == disc()


@pytest.mark.parametrize("text", ["title = ", "a = [1,\n", b"\xff\xfe", f"a = {'9' * 5000}", "a = " + "[" * 3000])
def test_file_that_is_not_toml(tmp_path, text):
    file = tmp_path / "case.toml"
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(CaseError, match="is not TOML"):
        cases.load(file)


@pytest.mark.parametrize(
    "text", ["a." * 20000 + "b = 1\n", "[" + "'a'. " * 20000 + "b]\n", "x = {" + "a." * 20000 + "b = 1}\n"]
)
def test_key_of_very_many_parts_is_refused_at_once(tmp_path, text):
    """The time of the parser goes with the square of the parts: minutes for these."""
    (tmp_path / "case.toml").write_text(text)
    with pytest.raises(CaseError, match="a key there has 50 parts or more"):
        cases.load(tmp_path / "case.toml")


def test_file_of_gigabytes_is_refused_before_it_is_read(tmp_path):
    with open(tmp_path / "case.toml", "wb") as file:
        file.truncate(3 * 2**30)
    with pytest.raises(CaseError, match="too large for a case: at most 1048576 letters"):
        cases.load(tmp_path / "case.toml")


def paths(table, here=()):
    """Where every value of a nested table is."""
    for key, value in table.items():
        yield (*here, key)
        if isinstance(value, dict):
            yield from paths(value, (*here, key))


anything = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.integers(10**308, 10**310)
    | st.floats()
    | st.text(max_size=6)
    | st.sampled_from(["box", "ideal"]),
    lambda inner: (
        st.lists(inner, max_size=3) | st.dictionaries(st.sampled_from(["kind", "at_m", "x"]), inner, max_size=2)
    ),
    max_leaves=4,
)
# TOML has no null; a None stands for "take it away"
changes = st.lists(st.tuples(st.sampled_from(sorted(paths(TABLE))), anything, st.booleans()), min_size=1, max_size=3)


def mutate(table, path, value, rename):
    for key in path[:-1]:
        if not isinstance(table.get(key), dict):
            return
        table = table[key]
    if rename and path[-1] in table:
        table[path[-1] + "x"] = table.pop(path[-1])
    elif value is None:
        table.pop(path[-1], None)
    else:
        table[path[-1]] = value


@settings(max_examples=200)
@given(changes=changes)
def test_mutated_case_loads_or_is_refused(changes):
    """Nothing but `CaseError`, and what does load can be read back and fills the box with particles or gas cells."""
    table = copy.deepcopy(TABLE)
    for change in changes:
        mutate(table, *change)
    try:
        case = cases.from_table(table)
    except CaseError as error:
        assert str(error).strip()
        return
    assert read_back(case) == case
    assert len(gas_cells.cells(case)) == case.dimensions
