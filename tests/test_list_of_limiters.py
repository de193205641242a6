"""docs/limiters.md counts what it lists, and leaves nothing uncounted without a reason."""

import re

import pytest

from sdph.scenes import paths

PAGE = paths.PACKAGE.parent / "docs" / "limiters.md"
COLUMNS = re.compile(r"`[\w*]+`(?:, `[\w*]+`)* [LSH]\b")
REASON = re.compile(r"nothing to count: .{20,}")


@pytest.fixture(scope="module")
def page() -> str:
    return PAGE.read_text(encoding="utf-8")


def rows(text: str) -> list[str]:
    """Last cell of each numbered row."""
    return [row.rstrip(" |").rpartition(" | ")[2] for row in re.findall(r"^\| \d.*$", text, re.MULTILINE)]


def repairs(page: str) -> list[str]:
    """What each repair is counted as."""
    return rows(page.partition("## Why they act")[0])


def in_a_sum(cell: str) -> bool:
    """True where each column that it names holds other things too."""
    named = [part for part in cell.split(";") if COLUMNS.search(part)]
    return bool(named) and all(part.endswith("in a sum") for part in named)


def test_every_repair_is_counted_or_has_a_reason_not_to_be(page):
    told = repairs(page)
    assert len(told) > 50
    assert [cell for cell in told if bool(COLUMNS.search(cell)) == bool(REASON.match(cell))] == []


def test_the_page_tells_how_many_there_are(page):
    told, text = repairs(page), " ".join(page.split())
    sums, reasons = sum(map(in_a_sum, told)), sum(cell.startswith("nothing to count") for cell in told)
    own = len(told) - sums - reasons
    assert f"There are {len(told)} repairs of the numerics. {own} are counted in the ledger, the summary or" in text
    assert f" {sums} goes into a sum with other things, {reasons} are not counted because there is nothing" in text
    bounds, guards = (
        len(rows(page.partition(f"## {part}")[2].partition("\n## ")[0]))
        for part in ("Bounds that are part", "Guards against")
    )
    assert f" {bounds} more bounds are part of a law, a boundary or an interpolation, and {guards} guard" in text


def test_every_column_of_the_history_has_a_reason(page):
    """READMEs of scenes take it from there (validation/recorded.py)."""
    why = re.findall(r"^\| `(\w+)` \|", page.partition("## Why they act")[2].partition("\n## ")[0], re.MULTILINE)
    told = {
        name
        for cell in repairs(page)
        for named in re.finditer(r"((?:`\w+`(?:, )?)+)((?: [LSH])+)", cell)
        for name in re.findall(r"\w+", named[1] * ("H" in named[2]))
    }
    assert len(told) > 40 and len(why) == len(set(why)) and set(why) == told
