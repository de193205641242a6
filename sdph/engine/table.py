"""Tables in CSV files, read with every cell looked at; a `ValueError` says what is wrong, and where."""

from __future__ import annotations

import csv
import io
import math
import os
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from sdph.engine.kept import Many, Unfit
from sdph.schema import CaseError

LARGEST = 2**25  # bytes of a table, some 300 000 rows of a frame; our choice
SEPARATORS = ",;\t"  # that spreadsheets write between cells; of these the most frequent one of the first line holds
LONGEST = 2**20  # characters of the first line of a table; our choice


class TooLarge(ValueError):
    """A table that is longer than any that is read."""


@dataclass(frozen=True)
class Cells:
    """Names of the columns; (line of the file, cells) of every row; `ended` is false where the last line is not."""

    head: list[str]
    rows: list[tuple[int, list[str]]]
    ended: bool

    def whole(self) -> Cells:
        """The same, where every row is as long as the first line."""
        for line, row in self.rows:
            if len(row) != len(self.head):
                raise ValueError(f"line {line} has {len(row)} cells, the first line names {len(self.head)} columns")
        return self

    def column(self, name: str) -> list[tuple[int, str]]:
        """(line, cell) of every row."""
        place = self.head.index(name)
        return [(line, row[place]) for line, row in self.rows]


def read_cells(path: Path) -> Cells:
    """A CSV file in UTF-8; empty lines are passed over."""
    text = _text(path)
    first, _, _ = text.partition("\n")
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=max(SEPARATORS, key=first.count))
    try:
        rows = [(reader.line_num, row) for row in reader if row]
    except csv.Error as error:
        raise ValueError(f"line {reader.line_num}: {error}") from None
    if not rows:
        raise ValueError("it is empty")
    head = [name.strip() for name in rows.pop(0)[1]]
    if len(set(head)) < len(head):
        raise ValueError(f"two columns have the same name in its first line, {_short(','.join(head))}")
    return Cells(head, rows, text.endswith("\n"))


def _text(path: Path) -> str:
    if not path.is_file():  # nor a pipe or a device, which may have no end
        raise ValueError("there is no such file")
    if path.stat().st_size > LARGEST:
        raise TooLarge(f"it has {path.stat().st_size} bytes; at most {LARGEST} are allowed")
    try:
        with open(path, newline="", encoding="utf-8-sig") as file:  # with or without a byte order mark
            return file.read()
    except UnicodeDecodeError as error:
        raise ValueError(f"it is no text in UTF-8, by byte {error.start}") from None
    except OSError as error:
        raise ValueError(error.strerror) from None


def numbers(path: Path, names: tuple[str, ...]) -> tuple[list[int], dict[str, np.ndarray]]:
    """Line of the file of each row, and the columns `names` (rows,), all finite; other columns may be there."""
    cells = read_cells(path)
    for name in names:
        if name not in cells.head:
            raise ValueError(f"it has no column {name}; its first line is {_short(','.join(cells.head))}")
    cells.whole()
    return [line for line, _ in cells.rows], {
        name: np.array([_finite(*cell, name) for cell in cells.column(name)]) for name in names
    }


def _finite(line: int, cell: str, name: str) -> float:
    value = number(line, cell, name)
    if not math.isfinite(value):
        raise ValueError(f"line {line}: {name} = {cell.strip()}; it must be finite")
    return value


def number(line: int, cell: str, name: str) -> float:
    """The number that a cell holds."""
    try:
        return float(cell)
    except ValueError:
        raise ValueError(
            f"line {line}: {name} = {_short(cell)}; it must be a number, with a point for its decimals"
        ) from None


def column(cells: Cells, name: str, texts: tuple[str, ...] | None) -> np.ndarray:
    """(rows,) numbers, nan where a cell is empty; texts in a column of `texts`, or with None where they must be."""
    try:
        return np.array([number(line, cell or "nan", name) for line, cell in cells.column(name)])
    except ValueError:
        if texts is not None and name not in texts:
            raise
        return np.array([cell for _, cell in cells.column(name)])


class Found(dict):
    """Values by name, of a file that a run has left; `CaseError` where it has no such name."""

    def __init__(self, path: Path, values):
        super().__init__(values)
        self.path = path

    def __missing__(self, name: str):
        raise CaseError(f"{self.path} has no {name}: it is damaged, or of a case that has none; run it again")


def _short(text: str) -> str:
    return repr(text[:60])[:60]


class Table:
    """A CSV file that grows by rows of one set of keys."""

    KEPT, FORMS = ("columns", "place"), {"columns": Many("")}  # see sdph.engine.kept

    def __init__(self, path: Path | None):
        """A table at a path, or one that nobody keeps."""
        self.lasts = path is not None
        how = {"mode": "a", "newline": "", "encoding": "utf-8"}
        self.file = open(path, **how) if self.lasts else tempfile.TemporaryFile(**how)  # noqa: SIM115  (see `close`)
        self.columns: tuple[str, ...] = ()

    def admit(self, kept: dict) -> None:
        """CaseError where the file is shorter than it was, Unfit where it is another."""
        if not self.lasts:
            return
        name, length = self.file.name, kept["place"]
        if self.place < length:
            raise CaseError(f"{name} has lost rows that its checkpoint counts on; run anew")
        with open(name, newline="", encoding="utf-8", errors="replace") as file:
            columns = next(csv.reader([file.readline(LONGEST)]), []) if length > 0 else []
        if length < 0 or columns != kept["columns"]:
            raise Unfit(f"{Path(name).name} does not begin with its columns, or is cut to {length} bytes")

    def name(self, columns: tuple[str, ...]) -> None:
        """Name the columns before there is a row."""
        self.columns = columns
        csv.DictWriter(self.file, columns).writeheader()

    def write(self, row: dict) -> None:
        if not self.columns:
            self.name(tuple(row))
        if strange := sorted(set(row) - set(self.columns)):
            raise CaseError(
                f"{self.file.name} has no column {strange[0]}: another build of sdph began it; run anew, or go on with "
                "that build"
            )
        csv.DictWriter(self.file, self.columns).writerow(row)

    def flush(self) -> None:
        self.file.flush()

    @property
    def place(self) -> int:
        """Bytes written, all of them on the disk."""
        self.file.flush()
        os.fsync(self.file.fileno())
        return os.fstat(self.file.fileno()).st_size

    @place.setter
    def place(self, length: int) -> None:
        os.ftruncate(self.file.fileno(), length)

    def close(self) -> None:
        self.file.close()
