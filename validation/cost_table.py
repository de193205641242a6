"""Writes what accuracy costs, from validation/*/cost.csv: the table of docs/cost.md, and what was measured of each
scene into its README.md, between marks.

    python validation/cost_table.py             tables
    python validation/cost_table.py --figures   cost.png of each scene too
"""

from __future__ import annotations

import sys
from pathlib import Path

from sdph.study.cost import errors, ladder, report, rows, summary

HERE = Path(__file__).parent
PAGE = HERE.parent / "docs" / "cost.md"
BEGIN, END = "<!-- made by validation/cost_table.py -->\n", "\n<!-- end of what it makes -->"


def with_table(text: str, lines: list[str]) -> str:
    """The text with `lines` between the marks."""
    before, mark, rest = text.partition(BEGIN)
    return before + mark + "\n".join(lines) + END + rest.partition(END)[2] if mark else text


def pages() -> dict[Path, str]:
    """Each page and what it should be."""
    found = {PAGE: summary.table(HERE)}
    found |= {HERE / scene / "README.md": summary.section(HERE, scene) for scene in ladder.with_ladder()}
    return {
        file: with_table(file.read_text(encoding="utf-8"), lines) for file, lines in found.items() if file.is_file()
    }


def main() -> None:
    for file, text in pages().items():
        file.write_text(text, encoding="utf-8")
    for scene in ladder.with_ladder() if "--figures" in sys.argv[1:] else ():
        measured = errors.judged(ladder.declared(scene), rows.read(HERE / scene / "cost.csv"))
        report.draw(scene, measured, HERE / scene / "cost.png")


if __name__ == "__main__":
    main()
