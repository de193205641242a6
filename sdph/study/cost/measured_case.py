"""The case of one's own that a ladder was measured of, kept beside its rows: a promise is of that case alone.

What comes with sdph changes with its version, and its rows with it; a case of one's own is edited.
"""

from __future__ import annotations

import json
from pathlib import Path

from sdph import scenes
from sdph.case import read as cases
from sdph.running import inputs, output, vessel
from sdph.schema import CaseError, flat
from sdph.study.cost.ladder import Ladder

FILE = "case.json"  # beside cost.csv
FILES = "files that it reads"


def of_ones_own(scene: str) -> Path | None:
    """The case file of what is no scene that comes with sdph; None of one that is."""
    if not Path(scene).exists():
        return None
    _, file = scenes.find(scene)
    return None if scenes.HERE in file.resolve().parents else file


def is_own(rows: Path) -> bool:
    """True where a table of rows is of a case of one's own."""
    return (rows.parent / FILE).is_file()


def of(file: Path, own: Ladder) -> dict:
    """All keys of a case as its rungs have them, but those that these set; and digests of the files that it reads."""
    case = vessel.load(file, (*own.settings, *own.excerpt))
    table = {key: value for key, value in flat(cases.to_table(case)).items() if key not in own.keys}
    return json.loads(output.strict_json(table | {FILES: inputs.digests(case, file)}))


def keep(scene: str, own: Ladder, rows: Path) -> None:
    """Write what a case of one's own is before its first rung; CaseError where rows are of another."""
    file = of_ones_own(scene)
    if file is None and is_own(rows):
        raise CaseError(f"{rows} was measured of a case of your own; give another folder: --out")
    if file and not rows.is_file():
        rows.parent.mkdir(parents=True, exist_ok=True)
        output.write_text(rows.parent / FILE, output.strict_json(of(file, own)))
    elif file and is_own(rows):
        refuse_other(file, own, rows)


def refuse_other(file: Path, own: Ladder, rows: Path) -> None:
    """CaseError where `rows` were measured of a case that differs from that in `file` in more than its ladder."""
    kept = rows.parent / FILE
    mend = f"move {rows} away and measure again: sdph cost {file.parent}"
    if not is_own(rows):
        raise CaseError(f"{rows} does not say which case it was measured of ({kept} is missing); {mend}")
    try:
        before = json.loads(kept.read_text(encoding="utf-8"))
    except ValueError:
        raise CaseError(f"{kept} is damaged; {mend}") from None
    now = of(file, own)
    other = [key for key in {**before, **now} if before.get(key) != now.get(key)]
    if other:
        raise CaseError(f"{rows} was measured of another case: {other[0]} differs from that in {file}; {mend}")
