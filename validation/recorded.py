"""Tells what validation/record has in README.md, docs/measured.md and the READMEs here, so that nobody copies numbers.

    python validation/recorded.py

Between `<!-- recorded: SCENE -->` and the mark of its end stands a table of the checks of that record, without balances
that hold; with `<!-- recorded: SCENE, misses -->` one of those that miss, or a line where none does. A number in a text
is followed by where it is from, a record and the end of a check's name, and keeps its digits:
`0.102<!-- bubbling_bed: centroid at 0.20 s [m] -->`. What is not the check's value is named behind a semicolon,
`reference`, `bar`, `difference`, `ratio` or `off` (in %), and a factor: `; reference x 1000`. In the place of a check
may stand a count, `held` of those that were `judged` or `reported`; in the place of a number the check's verdict,
`**missed**` or `held`. Between `<!-- limiters: SCENE -->` and the end stands which limiters acted in the runs of that
record, how much, and why, which is docs/limiters.md's.
"""

from __future__ import annotations

import re
import sys
from functools import cache
from pathlib import Path

from sdph.study import record

ROOT = Path(__file__).parents[1]
RECORDS = ROOT / "validation" / "record"
HEAD = "| check | measured | reference | bar | |\n|--|--|--|--|--|"
END = "<!-- end of what is recorded -->"
TABLE = re.compile(
    rf"(?P<mark><!-- recorded: (?P<scene>\w+)(?P<misses>, misses)? -->\n)(?:(?!<!-- recorded).)*?{END}", re.DOTALL
)
LIMITERS = re.compile(
    rf"(?P<mark><!-- limiters: (?P<scene>\w+) -->\n)(?:(?!<!-- (?:recorded|limiters)).)*?{END}", re.DOTALL
)
WHY = re.compile(r"^\| `(\w+)` \| (.+) \|$", re.MULTILINE)
MISSED, HELD = "**missed**", "held"
NUMBER = re.compile(
    rf"(?P<told>[-+]?\d+(?:\.\d+)?(?:e-?\d+)?|{re.escape(MISSED)}|{HELD})"
    r"(?P<mark><!-- (?P<scene>\w+): (?P<check>[^;]+?)(?:; (?P<which>[a-z]+)(?: x (?P<factor>[\d.e-]+))?)? -->)"
)
NUMBERS = {
    "value": lambda check: check["value"],
    "reference": lambda check: check["reference"],
    "bar": lambda check: check["tolerance"],
    "difference": lambda check: check["value"] - check["reference"],
    "ratio": lambda check: check["value"] / check["reference"],
    "off": lambda check: 100.0 * (check["value"] / check["reference"] - 1.0),
}
COUNTS = {
    "held": lambda check: check["ok"] and check["tolerance"] is not None,
    "judged": lambda check: check["tolerance"] is not None,
    "reported": lambda check: check["tolerance"] is None,
}


@cache
def own(scene: str) -> dict:
    """The record of a scene or study; one without checks where there is none."""
    return record.read(RECORDS, scene) or {"scene": scene, "checks": []}


def files() -> list[Path]:
    """Pages that tell what is recorded."""
    return [ROOT / "README.md", ROOT / "docs" / "measured.md", *sorted(ROOT.glob("validation/*/README.md"))]


def pages() -> dict[Path, str]:
    """Each page and what it should be."""
    return {file: filled(file.read_text(encoding="utf-8")) for file in files()}


def filled(text: str) -> str:
    """The text with tables and numbers as they are recorded."""
    text = TABLE.sub(lambda match: match["mark"] + table(own(match["scene"]), bool(match["misses"])) + END, text)
    text = LIMITERS.sub(lambda match: match["mark"] + limiters(own(match["scene"])) + END, text)
    return NUMBER.sub(_number, text)


@cache
def reasons() -> dict[str, str]:
    """Reasons why limiters act, by column, of docs/limiters.md."""
    page = (ROOT / "docs" / "limiters.md").read_text(encoding="utf-8")
    return dict(WHY.findall(page.partition("\n## Why they act\n")[2].partition("\n## ")[0]))


def limiters(made: dict) -> str:
    """Limiters that acted in the runs of a record: a table with a column for each run in which some did."""
    runs, page = made.get("limiters"), "[limiters](../../docs/limiters.md)"
    if not runs:
        why = "the record is older than that" if runs is None else "it makes runs of its own"
        return f"Which {page} acted is not recorded: {why} ({made['date']}).\n" if made["checks"] else table(made, True)
    acting = {name: held for name, held in runs.items() if held}
    idle = [name for name in runs if not runs[name]]
    told = f"None of the {page} acted in {'; '.join(idle)} ({made['date']}).\n" if idle else ""
    return told + (_acting(acting, f"Which {page} acted ({made['date']}), the largest of a run") if acting else "")


def _acting(runs: dict[str, dict], told: str) -> str:
    """Table of the limiters of runs, in which each had some."""
    columns = list(dict.fromkeys(column for held in runs.values() for column in held))
    cells = {
        column: [_short(held[column], 2) if column in held else "" for held in runs.values()] for column in columns
    }
    head = f"| | {' | '.join(runs)} | why |\n|--|{'--|' * len(runs)}--|"
    rows = [f"| `{column}` | {' | '.join(cells[column])} | {reasons()[column]} |" for column in columns]
    return "\n".join([f"{told}:", "", head, *rows, ""])


def table(made: dict, misses: bool) -> str:
    """A line that says when a record was made, and a table of its checks."""
    if not made["checks"]:
        return f"Not recorded: `sdph validate {made['scene']} --record validation/record` does it.\n"
    checks = [check for check in made["checks"] if not check["ok"] or not (misses or "balances: " in check["name"])]
    missed, reported = (sum(map(of, made["checks"])) for of in (lambda check: not check["ok"], COUNTS["reported"]))
    made_by = f"Recorded {made['date']} (commit {made['commit']}, gas {made['gas']}{_apart(made.get('parts', {}))})"
    left_out = "those" if misses else "balances"
    told = f"{reported} only reported; " if reported else ""
    about = f"{len(made['checks'])} checks, {missed} missed; {told}{left_out} that hold are not shown"
    rows = ["", HEAD, *(row(check, made["scene"]) for check in checks)] if checks else []
    return "\n".join([f"{made_by}: {about}.", *rows, ""])


def _apart(parts: dict[str, dict]) -> str:
    """Words for the parts that were recorded by themselves: those of one date and commit together."""
    found = {}
    for name, own in parts.items():
        found.setdefault(f"{own['date']}, {own['commit']}", []).append(name)
    return "".join(f"; {', '.join(names)} {when}" for when, names in found.items())


def row(check: dict, scene: str) -> str:
    """A line of a table."""
    name = check["name"].removeprefix(f"{scene}, ").removeprefix("exact: ").replace("|", "\\|")
    cells = (_short(check["value"], 5), _short(check["reference"], 5), _short(check["tolerance"], 3))
    return f"| {name} | {' | '.join(cells)} | {'' if check['ok'] else MISSED} |"


def _short(number: float | None, digits: int) -> str:
    """A number in a table; nothing where there is none."""
    if number is None:
        return ""
    text = f"{number:.{digits}g}"
    return f"{number:.0f}" if "e+" in text else text


def _number(match: re.Match) -> str:
    checks, name, which = own(match["scene"])["checks"], match["check"], match["which"] or "value"
    if name in COUNTS:
        return str(sum(map(COUNTS[name], checks))) + match["mark"]
    found = [check for check in checks if check["name"].endswith(name)]
    if len(found) != 1:
        raise ValueError(f"{match['scene']}: {len(found)} checks end with {name!r}: {[c['name'] for c in found][:3]}")
    if match["told"] in (MISSED, HELD):
        return (HELD if found[0]["ok"] else MISSED) + match["mark"]
    signed = match["told"][0] == "+" or (match["told"][0] == "-" and which in ("difference", "off"))
    return alike(NUMBERS[which](found[0]) * float(match["factor"] or 1.0), match["told"], signed) + match["mark"]


def alike(number: float, told: str, signed: bool) -> str:
    """A number with as many digits as it was told with, and a sign where that is wanted."""
    mantissa, exponent, _ = told.partition("e")
    text = f"{number:{'+' if signed else ''}.{len(mantissa.partition('.')[2])}{'e' if exponent else 'f'}}"
    return re.sub(r"e([-+])0*(\d)", lambda match: f"e{match[1].strip('+')}{match[2]}", text)


def main() -> None:
    """Writes all pages but those with a mark of no check, or of two, and ends with a line for each of these."""
    wrong = []
    for file in files():
        try:
            file.write_text(filled(file.read_text(encoding="utf-8")), encoding="utf-8")
        except ValueError as error:
            wrong.append(f"{file}: {error}")
    if wrong:
        sys.exit("\n".join(wrong))


if __name__ == "__main__":
    main()
