"""The page of metrics names every column that they write."""

import ast
from pathlib import Path

import pytest

from sdph.running import metrics, sizing

ROOMS = sorted(Path(metrics.__file__).parent.glob("*.py"))
PAGE = (Path(__file__).parents[3] / "docs/metrics.md").read_text(encoding="utf-8")
# first paragraphs, which docs/making puts into the page
TOLD = PAGE + " ".join(own.__doc__.split("\n\n")[0] for own in metrics.AT_OUTPUTS.values())


def columns(file: Path) -> set[str]:
    """Texts that are keys of tables within functions."""
    functions = (node for node in ast.walk(ast.parse(file.read_text())) if isinstance(node, ast.FunctionDef))
    tables = (node for function in functions for node in ast.walk(function) if isinstance(node, ast.Dict))
    keys = (key for table in tables for key in table.keys if isinstance(key, ast.Constant))
    return {key.value for key in keys if isinstance(key.value, str)}


def test_columns_are_found():
    assert {"superficial_velocity_m_s", "alpha_p_mean", "motion_J"} <= set().union(*map(columns, ROOMS))


@pytest.mark.parametrize("file", ROOMS, ids=lambda file: file.stem)
def test_every_column_is_on_the_page(file):
    assert [name for name in sorted(columns(file)) if name not in TOLD] == []


def test_sizes_are_on_the_page():
    assert [name for name in sizing.NAMES if f"`{name}`" not in PAGE] == []
