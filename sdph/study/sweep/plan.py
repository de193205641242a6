"""Points of a sweep: values of keys, a grid of them or a list.

`key=1,2,5` are values (of texts and lists too: commas in brackets and quotes do not count), `key=1:5:3` three numbers
from 1 to 5, both ends included.
"""

from __future__ import annotations

import itertools
import math
import re
from pathlib import Path

import numpy as np

from sdph.engine.table import read_cells
from sdph.schema import CaseError

MOST_RUNS = 10_000  # runs of a sweep; our choice: more is a slip
PARTS = re.compile(r"""(?:"[^"]*"|'[^']*'|\[(?:[^\[\]]|\[[^\[\]]*\])*\]|[^,])+""")
RANGE = re.compile(r"([^:]+):([^:]+):(\d+)")
DIGITS_OF_RANGE = 12  # of a number of a range


def points(sets: list[str], table: Path | None = None) -> list[dict[str, str]]:
    """Key -> value, as text of TOML, of every run: each row of the `table` with each combination of the values of
    `sets`."""
    keys: dict[str, list[str]] = {}
    for text in sets:
        key, equals, value = text.partition("=")
        if not equals or not key.strip():
            raise CaseError(f"--set {text}: give it as section.key=v1,v2 or section.key=a:b:n")
        if key.strip() in keys:
            raise CaseError(f"--set {text}: {key.strip()} was given already; give all its values at once")
        keys[key.strip()] = values(value, text)
    rows = _rows(table) if table else [{}]
    both = keys.keys() & rows[0].keys()
    if both:
        raise CaseError(f"--set {min(both)}: it is a column of {table} too; leave one of them out")
    count = len(rows) * math.prod(len(own) for own in keys.values())
    if count > MOST_RUNS:
        raise CaseError(f"that makes {count} runs; a sweep has {MOST_RUNS} at most: give fewer values")
    grid = [dict(zip(keys, combination)) for combination in itertools.product(*keys.values())]
    return [row | own for row in rows for own in grid]


def values(text: str, told: str) -> list[str]:
    """The values of a list or range, as text."""
    parts = PARTS.findall(text)
    found = [part.strip() for part in parts]
    if not found or ",".join(parts) != text or not all(found):
        raise CaseError(f"--set {told}: a value is missing; give it as section.key=v1,v2 or section.key=a:b:n")
    return [value for part in found for value in _range(part, told)]


def _range(text: str, told: str) -> list[str]:
    """Numbers a:b:n as text, each the shortest that is right to 12 digits; else the text itself."""
    match = RANGE.fullmatch(text)
    try:
        low, high, count = (float(match[1]), float(match[2]), int(match[3])) if match else (0.0, 0.0, 0)
    except ValueError:  # a text with colons in it
        return [text]
    if not match:
        return [text]
    if not (math.isfinite(low) and math.isfinite(high) and 2 <= count <= MOST_RUNS):
        raise CaseError(f"--set {told}: {text} must be a:b:n, n a whole number of at least 2, such as 1:5:3")
    whole = all(number == int(number) and "." not in part for number, part in ((low, match[1]), (high, match[2])))
    numbers = np.linspace(low, high, count).tolist()
    if whole and all(number == int(number) for number in numbers):  # for keys that must be whole
        return [str(int(number)) for number in numbers]
    return [repr(float(f"{number:.{DIGITS_OF_RANGE}g}")) for number in numbers]


def _rows(table: Path) -> list[dict[str, str]]:
    """Rows of a CSV file whose first line names keys; an empty cell leaves the case's own value."""
    try:
        cells = read_cells(table).whole()
    except ValueError as error:
        raise CaseError(f"--table {table}: {error}; give a CSV file whose first line names keys") from None
    if not cells.rows:
        raise CaseError(f"--table {table}: it has no rows; give a row for each run")
    rows = [{key: cell.strip() for key, cell in zip(cells.head, row) if cell.strip()} for _, row in cells.rows]
    return [dict.fromkeys(cells.head, "") | row for row in rows]
