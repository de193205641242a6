"""Tables harmed at random: each is read as it stands, or refused in one line; nothing else comes of it."""

import math
import time

import numpy as np
from conftest import LONG
from hypothesis import given, settings
from hypothesis import strategies as st

from sdph.effects.around import frame
from sdph.running import output
from sdph.schema import CaseError

HEAD = ",".join(frame.COLUMNS)
CELLS = [
    "",
    " ",
    "0",
    "-1",
    "1e999",
    "nan",
    "inf",
    "-inf",
    "1e400",
    "0x10",
    "1_0",
    "1,5",
    "1;5",
    '"',
    '""',
    "'",
    "\t",
    "\0",
    "\ufeff",
    "ä",
    "x" * 200_000,
]
WHOLE = "\n".join([HEAD, *(f"{0.1 * n:.1f},{n},0,0,0,0,{0.2 * n:.1f}" for n in range(6))]) + "\n"


@st.composite
def harmed(draw) -> bytes:
    """The whole table with some cells, lines, separators or bytes changed."""
    rows = [line.split(",") for line in WHOLE.splitlines()]
    for _ in range(draw(st.integers(0, 3))):
        row = rows[draw(st.integers(0, len(rows) - 1))]
        what = draw(st.sampled_from(["cell", "cell", "cell", "shorter", "longer", "line away", "line again"]))
        if what == "cell" and row:
            row[draw(st.integers(0, len(row) - 1))] = draw(
                st.sampled_from(CELLS) | st.text(max_size=5) | st.floats().map(str)
            )
        elif what == "shorter" and row:
            row.pop()
        elif what == "longer":
            row.append("1")
        elif what == "line away" and len(rows) > 1:
            rows.remove(row)
        else:
            rows.append(row)
    text = draw(st.sampled_from(["\n", "\r\n", "\r", ""])).join(
        draw(st.sampled_from([",", ",", ";", "\t", " ", "|"])).join(row) for row in rows
    )
    data = text.encode(draw(st.sampled_from(["utf-8", "utf-8", "utf-8-sig", "utf-16", "utf-32"])), "surrogatepass")
    place = draw(st.integers(0, len(data)))
    return (
        data[:place] + draw(st.binary(max_size=4)) + data[place + draw(st.integers(0, 20)) :]
        if draw(st.booleans())
        else data
    )


@settings(max_examples=100 * LONG)
@given(harmed())
def test_a_harmed_table_of_a_case_is_read_or_refused(tmp_path_factory, data):
    file, begun = tmp_path_factory.getbasetemp() / "motion.csv", time.process_time()
    file.write_bytes(data)
    try:
        found = frame.motion(frame.Frame(table=str(file)), 0.0)
    except CaseError as error:
        assert "frame.table" in str(error) and len(str(error).splitlines()) == 1 and len(str(error)) < 600
    else:
        for at in (-1.0, 0.0, 0.25, 0.6, 1e9):
            assert all(np.isfinite(part).all() for part in found(at))
    assert time.process_time() - begun < 10.0


@settings(max_examples=100 * LONG)
@given(harmed())
def test_a_harmed_table_of_a_run_is_read_or_refused(tmp_path_factory, data):
    file = tmp_path_factory.getbasetemp() / "history.csv"
    file.write_bytes(data)
    try:
        columns = output.read_table(file, output.TEXTS)
    except CaseError as error:
        assert str(file) in str(error) and len(str(error).splitlines()) == 1 and len(str(error)) < 600
    else:
        assert len({len(column) for column in columns.values()}) == 1
        assert all(column.dtype.kind == "f" for name, column in columns.items() if name not in output.TEXTS)


def test_the_whole_table_is_read(tmp_path):
    (tmp_path / "motion.csv").write_text(WHOLE)
    acceleration, omega, _ = frame.motion(frame.Frame(table=str(tmp_path / "motion.csv")), 0.5)(0.25)
    assert math.isclose(acceleration[0], 2.5) and math.isclose(omega[2], 0.5)
