"""What became of the faults, row by row in a CSV file, and what it amounts to."""

from __future__ import annotations

import csv
import tomllib
from pathlib import Path

from .fault import Fault
from .trial import CAUGHT, UNBUILT, Outcome

COLUMNS = ("fault", "room", "file", "line", "where", "kind", "old", "new", "outcome", "test", "seconds")
REASONS = Path(__file__).with_name("reasons.toml")


class Record:
    """The rows of a file; `resume` keeps those that are there."""

    def __init__(self, file: Path, resume: bool):
        self.file, self.rows = file, {}
        if resume and file.exists():
            with open(file, newline="", encoding="utf-8") as stream:
                self.rows = {row["fault"]: row for row in csv.DictReader(stream)}

    def __contains__(self, fault: Fault) -> bool:
        return fault.name in self.rows

    def caught(self, fault: Fault) -> bool:
        return self.rows[fault.name]["outcome"] == CAUGHT

    def add(self, fault: Fault, outcome: Outcome) -> None:
        """Write all rows with the new one."""
        own = {name: getattr(fault, name) for name in COLUMNS[1:8]}
        self.rows[fault.name] = {"fault": fault.name} | own | {
            "outcome": outcome.what, "test": outcome.test, "seconds": f"{outcome.seconds:.0f}"
        }  # fmt: skip
        self.file.parent.mkdir(parents=True, exist_ok=True)
        with open(self.file, "w", newline="", encoding="utf-8") as stream:
            writer = csv.DictWriter(stream, COLUMNS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(self.rows.values())

    def planted(self) -> list[dict]:
        """Rows of faults that could be seen: what compiles, and is not equivalent."""
        why = reasons()
        return [
            row for row in self.rows.values()
            if row["outcome"] != UNBUILT and not why.get(row["fault"], {}).get("equivalent")
        ]  # fmt: skip

    def report(self) -> str:
        """caught/planted of each room and in all; survivors with their reasons."""
        planted, why = self.planted(), reasons()
        lines = [f"{room:12} {_share(planted, room)}" for room in dict.fromkeys(row["room"] for row in planted)]
        lines.append(f"{'all':12} {_share(planted)}")
        for row in self.rows.values():
            if row["outcome"] not in (CAUGHT, UNBUILT):
                old, new = " ".join(row["old"].split()), " ".join(row["new"].split())
                reason = why.get(row["fault"], {}).get("why", "no reason is known: a test is missing")
                place = f"{row['fault']} {row['file']}:{row['line']} {row['where']}"
                lines.append(f"{row['outcome']}: {place}: {old} -> {new}; {reason}")
        return "\n".join(lines)


def reasons() -> dict[str, dict]:
    """By fault: why it survived, and whether it is equivalent, so that no result can change."""
    rows = tomllib.loads(REASONS.read_text(encoding="utf-8")).get("survivor", [])
    return {row["fault"]: row for row in rows}


def _share(rows: list[dict], room: str | None = None) -> str:
    own = [row for row in rows if room in (None, row["room"])]
    caught = sum(row["outcome"] == CAUGHT for row in own)
    return f"{caught}/{len(own)}" + (f" ({100.0 * caught / len(own):.0f} %)" if own else "")
