"""Tables of what was measured, checks of ours against them, figures of both."""

from __future__ import annotations

import csv
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from sdph.study.compare import check

DATA = Path(__file__).parent / "data"
GRAVITY = 9.80665  # m/s2, standard (CGPM 1901)


def table(name: str) -> np.ndarray:
    """Rows of data/<name>.csv as a structured array; its head names source and units."""
    with open(DATA / f"{name}.csv", encoding="utf-8") as file:
        names, *rows = csv.reader(line for line in file if not line.startswith("#"))
    return np.rec.fromarrays([_column(texts) for texts in zip(*rows)], names=names)


def _column(texts) -> np.ndarray:
    """Numbers where all are, else the texts."""
    try:
        return np.array(texts, dtype=float)
    except ValueError:
        return np.array(texts)


def ratios(name: str, ours, found, labels, bar: float) -> list[dict]:
    """Two checks, each within the share `bar`: the mean of ours over what was measured, and the row farthest off."""
    worst = int(np.argmax(np.abs(ours / found - 1.0)))
    return [
        check(f"{name}: mean over measured, {len(found)} rows [-]", np.mean(ours / found), 1.0, bar),
        check(f"{name}: worst, {labels[worst]}", ours[worst], found[worst], bar, True),
    ]


def differences(name: str, ours, found, labels, bar: float) -> list[dict]:
    """Two checks, each within `bar`, in its unit: root mean square of ours less what was measured, and the row farthest
    off."""
    apart = ours - found
    worst = int(np.argmax(np.abs(apart)))
    return [
        check(f"{name}: rms off, {len(found)} rows", np.sqrt(np.mean(apart**2)), 0.0, bar),
        check(f"{name}: worst, {labels[worst]}", ours[worst], found[worst], bar),
    ]


@contextmanager
def figure(file: Path, xlabel: str, ylabel: str):
    """Axes to draw on, written to `file` in the end."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    drawn, axes = pyplot.subplots(figsize=(6.5, 4.5), constrained_layout=True)
    yield axes
    axes.set(xlabel=xlabel, ylabel=ylabel)
    axes.legend(fontsize=8)
    drawn.savefig(file, dpi=90)
    pyplot.close(drawn)
