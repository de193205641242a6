"""The rooms that faults are planted in: their files, and the tests that should see what is wrong in them.

A room's tests are folders or files in the order in which they are run; those that import the faulty module, or name it,
come first. The first failure ends a trial.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

GRAINS = ("tests/methods/grains", "tests/exchange", "tests/effects/gas", "tests/effects/grains")
SOLIDS = ("tests/methods/solids",)
LIQUIDS = ("tests/methods/liquids", "tests/effects/liquids", "tests/validation/test_liquid_scenes.py")


class Room(NamedTuple):
    """Patterns of source files from the root of the tree; folders of tests, or files of them."""

    files: tuple[str, ...]
    tests: tuple[str, ...]


AROUND = "sdph/effects/around"
ROOMS = {
    "laws": Room(("sdph/laws/*.py",), ("tests/laws", "tests/effects", *GRAINS, *LIQUIDS, *SOLIDS, "tests/validation")),
    "effects": Room(
        (f"{AROUND}/gravity.py", *(f"sdph/effects/{own}/*.py" for own in ("gas", "grains", "liquids", "solids"))),
        ("tests/effects", *GRAINS, *LIQUIDS, *SOLIDS, "tests/laws", "tests/validation"),
    ),
    "equations": Room(
        ("sdph/methods/*/*.py",),
        ("tests/methods", "tests/effects", "tests/engine", "tests/exchange", "tests/running", "tests/validation"),
    ),
    "exchange": Room(("sdph/exchange/*.py",), ("tests/exchange", "tests/effects/gas", *GRAINS, "tests/validation")),
    "transfer": Room(
        ("coupling/transfer.py",),
        ("tests/coupling/test_transfer.py", "tests/coupling/test_vorticity.py", "tests/exchange"),
    ),
    "ledger": Room(
        ("sdph/engine/ledger.py", "sdph/engine/table.py"),
        (
            "tests/engine/test_ledger.py",
            "tests/engine/test_table_fuzz.py",
            "tests/engine",
            "tests/exchange",
            "tests/effects/gas",
        ),
    ),
    "frame": Room(
        (f"{AROUND}/frame.py", f"{AROUND}/tank.py", "sdph/running/tank.py"),
        ("tests/effects/around", "tests/methods/liquids", "tests/running/test_tank.py", "tests/engine/walls"),
    ),
    "walls": Room(
        (f"{AROUND}/walls.py", "sdph/engine/walls/*.py", "sdph/methods/liquids/walls.py"),
        ("tests/effects/around", "tests/engine/walls", "tests/methods", "tests/running/test_tank.py", *LIQUIDS),
    ),
    "inflow": Room(
        tuple(f"{AROUND}/{name}.py" for name in ("inflow", "nozzles", "streams", "outflow", "drain")),
        ("tests/effects/around", "tests/methods/liquids", "tests/running", "tests/exchange"),
    ),
    "restart": Room(
        ("sdph/engine/restart.py", "sdph/engine/kept.py", "sdph/engine/reading.py", "sdph/engine/state.py"),
        ("tests/engine/test_restart.py", "tests/engine", "tests/running"),
    ),
    "messages": Room(("coupling/transport/*.py",), ("tests/coupling/transport",)),
    "embedded": Room(("coupling/embedded/*.py",), ("tests/coupling/embedded", "tests/exchange", "tests/effects/gas")),
    "sdphGasFoam": Room(
        ("coupling/openfoam/sdphGasFoam/*.[CH]",),
        (
            "tests/coupling/openfoam/test_gas_solver.py",
            "tests/coupling/openfoam/test_two_gases.py",
            "tests/coupling/openfoam/test_gas_process.py",
            "tests/coupling/openfoam/test_wire_in_cpp.py",
            "tests/coupling/openfoam",
        ),
    ),
}


def sources(root: Path, room: str) -> list[Path]:
    """Files of a room, in order, but those of `explain` (see python_sites) and those that declare inputs."""
    found = {file for pattern in ROOMS[room].files for file in root.glob(pattern)}
    return sorted(file for file in found if file.stem not in ("scales", "sections"))


def seen_by(root: Path, room: str, file: str) -> list[str]:
    """Test files for a fault in `file`, those that are likeliest to see it first."""
    order: dict[str, None] = {}
    for place in ROOMS[room].tests:
        found = [root / place] if place.endswith(".py") else sorted((root / place).rglob("test_*.py"))
        order |= {str(test.relative_to(root)): None for test in found}
    return sorted(order, key=lambda test: _distance(root / test, file))


def _distance(test: Path, file: str) -> int:
    """0 where a test imports the module, 1 where it names it or is named after it, else 2."""
    text, module = test.read_text(encoding="utf-8"), Path(file).with_suffix("")
    package, name = ".".join(module.parts[:-1]), module.name
    imported = rf"(from|import) {re.escape(package)}\.{name}\b|from {re.escape(package)} import [^\n]*\b{name}\b"
    if re.search(imported, text):
        return 0
    return 1 if name in test.stem or re.search(rf"\b{name}\b", text) else 2
