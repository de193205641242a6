"""Sizes of the house: files and functions short enough to be read, and the rooms those of .importlinter."""

import ast
import configparser
import statistics

import pytest

from sdph.scenes import paths

ROOT = paths.PACKAGE.parent
LONGEST_FILE, LONGEST_FUNCTION = 300, 50  # lines
SHORT = 15  # lines, of 90 % of the functions
MEDIAN = 6
SOURCES = (".py", ".C", ".H")
FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)


def lengths(text: str) -> dict[str, int]:
    """Lines of each function, without decorators, by "name:line"."""
    functions = [node for node in ast.walk(ast.parse(text)) if isinstance(node, FUNCTIONS)]
    return {f"{own.name}:{own.lineno}": own.end_lineno - own.lineno + 1 for own in functions}


def functions_of(*packages: str) -> dict[str, int]:
    """Lines of all functions of these folders, by file, name and line."""
    files = [file for package in packages for file in sorted((ROOT / package).rglob("*.py"))]
    found = {file.relative_to(ROOT): lengths(file.read_text(encoding="utf-8")) for file in files}
    return {f"{file}:{name}": lines for file, own in found.items() for name, lines in own.items()}


@pytest.mark.parametrize("folder", ["sdph", "coupling", "tests", "validation", "benchmarks"])
def test_no_file_is_long(folder):
    files = [file for file in (ROOT / folder).rglob("*") if file.suffix in SOURCES]
    long = {file.name: count for file in files if (count := len(file.read_bytes().splitlines())) > LONGEST_FILE}
    assert len(files) > 10 and not long


@pytest.mark.parametrize("folder", ["sdph", "coupling", "tests", "validation", "benchmarks"])
def test_no_function_is_long(folder):
    found = functions_of(folder)
    assert len(found) > 50
    assert not {name: lines for name, lines in found.items() if lines > LONGEST_FUNCTION}


def test_nine_functions_of_ten_are_short():
    found = functions_of("sdph", "coupling")
    assert statistics.median(found.values()) <= MEDIAN
    longer = {name: lines for name, lines in found.items() if lines > SHORT}
    assert len(longer) <= 0.1 * len(found), f"{len(longer)} of {len(found)} have more than {SHORT} lines"


def test_lengths_are_counted():
    assert lengths("@law\ndef one():\n    return 1\n\n\nclass A:\n    def two(self):\n        pass\n") == {
        "one:2": 2, "two:7": 2,
    }  # fmt: skip


def test_rooms_are_those_of_the_floors():
    """A room that no floor holds could import what it likes."""
    read = configparser.ConfigParser()
    read.read(ROOT / ".importlinter")
    floors = read["importlinter:contract:floors"]["layers"].split("\n")
    named = {room.strip() for floor in floors for room in floor.split("|")} - {"", "coupling"}
    entries = [entry for entry in paths.PACKAGE.iterdir() if entry.suffix == ".py" or (entry / "__init__.py").exists()]
    assert {f"sdph.{entry.stem}" for entry in entries} - {"sdph.__init__"} == named
