"""The notebooks of examples/ run to their end as they are, and hold no path of the machine that made their pictures."""

from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

NOTEBOOKS = sorted((Path(__file__).parents[1] / "examples").glob("*.ipynb"))


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook(path, tmp_path):
    book = nbformat.read(path, as_version=4)
    shown = [cell for cell in book.cells if cell.get("outputs")]
    NotebookClient(book, timeout=600, resources={"metadata": {"path": str(tmp_path)}}).execute()
    told = [[output.output_type for output in cell.outputs if output.get("name") != "stderr"] for cell in shown]
    assert told and all(told)  # what has a result in the file has one now


def test_there_are_some_and_they_are_small():
    assert len(NOTEBOOKS) == 3
    for path in NOTEBOOKS:
        text = path.read_text(encoding="utf-8")
        assert len(text) < 500_000 and str(Path.home()) not in text and "site-packages" not in text
