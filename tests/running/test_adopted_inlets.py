"""Inlets of an OpenFOAM case whose velocity is a table of times: taken as rows where they let gas in, else told."""

import numpy as np
import pytest

from coupling.openfoam.dictionary import read, table
from coupling.openfoam.foreign.conditions import conditions

TABLE = "((0 (0 0 0)) (0.5 (0 0 0.25)) (2 (1e-12 0 0.1)))"
ROWS = [[0.0, 0.0, 0.0, 0.0], [0.5, 0.0, 0.0, 0.25], [2.0, 0.0, 0.0, 0.1]]


def entry_of(folder, text: str) -> dict:
    """Entry of a patch, as the reader of dictionaries has it."""
    (folder / "U").write_text(f"inlet {{ type uniformFixedValue; {text} }}")
    return read(folder / "U")["inlet"]


class Files:
    """A case of gas alone with one patch, `entry` of U."""

    grains, start = "", "0"

    def __init__(self, entry):
        self.entry = entry

    def field(self, name):
        return {"boundaryField": {"inlet": self.entry}} if name == "U" else {}


class Mesh:
    """A floor whose normal out of the domain points down."""

    class Floor:
        kind, faces = "patch", slice(0, 4)

    patches = {"inlet": Floor}

    def outwards(self, name):
        return 1.0, np.array([0.0, 0.0, -1.0])


@pytest.mark.parametrize(
    ("text", "rows"),
    [
        (f"uniformValue table {TABLE};", ROWS),
        (f"uniformValue table {TABLE}; value uniform (0 0 9);", ROWS),
        (f"uniformValue {{ type table; values {TABLE}; }}", ROWS),
        (f"uniformValue {{ type table; values {TABLE}; outOfBounds clamp; }}", ROWS),
        ("uniformValue table ((0 (0 0 -1e-12)) (0.5 (0 0 0.25)) (2 (0 0 0.1)));", ROWS),
        (f"uniformValue {{ type table; values {TABLE}; outOfBounds repeat; }}", None),
        (f"uniformValue table {TABLE}; outOfBounds repeat;", None),
        ("uniformValue sine; value uniform (0 0 9);", None),
        ("uniformValue table ((0 (0 0 1)));", None),
        ("uniformValue table ((1 (0 0 1)) (1 (0 0 2)));", None),
        ("uniformValue table ((-1 (0 0 1)) (1 (0 0 2)));", None),
        ("uniformValue table ((0 (0 0 1)) (1 (0 0 -1)));", None),
        ("uniformValue table ((0 (0 0 0)) (1 (1 0 0)));", None),
    ],
)
def test_a_table_of_velocities(tmp_path, text, rows):
    found = conditions(Files(entry_of(tmp_path, text)), Mesh(), 3, 0.5)["inlet"]
    if rows:
        assert found.entries == {"kind": "velocity_inlet", "velocities": rows} and not found.note
    else:
        assert found.entries == {"kind": "wall"} and "U is uniformFixedValue" in found.note


def test_between_the_grains_of_a_bed_gas_is_faster(tmp_path):
    """The velocity of a gas between grains is the larger: all rows are made superficial, and that is told."""
    files = Files(entry_of(tmp_path, "uniformValue table ((0 (0 0 0.5)) (1 (0 0 1)));"))
    files.grains = "particles"
    files.first = lambda path: {"boundaryField": {"inlet": {"type": ["zeroGradient"]}}}
    found = conditions(files, Mesh(), 3, 0.6)["inlet"]
    assert found.entries["velocities"] == [[0.0, 0.0, 0.0, 0.2], [1.0, 0.0, 0.0, 0.4]] and "1 - 0.6" in found.note


@pytest.mark.parametrize("text", ["uniformValue (0 0 1);", "uniformValue constant (0 0 1);", "uniformValue sine;",
                                  "uniformValue table;", "uniformValue table ((0 1) (1 2));",
                                  'uniformValue { type tableFile; file "x"; }', ""])  # fmt: skip
def test_what_is_no_table_is_none(tmp_path, text):
    assert table(entry_of(tmp_path, text).get("uniformValue")) is None
