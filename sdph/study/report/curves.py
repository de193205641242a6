"""Curves of the report: a panel for each kind, an image of lines, with what references give."""

from __future__ import annotations

import html
import io
import re

import numpy as np

from sdph.study.report.bars import COLOURS
from sdph.study.report.shown import Shown, folded, picture, section, spoken

PANEL = (4.2, 2.6)  # inches of one curve
MOST = 9  # panels that are open; the rest is folded
GROWTH = re.compile(  # of bubbles, gel droplets and inflated bodies
    r"diameter_ratio$|(bubble(_\d+)?|cavity)_(pressure_Pa|area_m2|diameter_m)$|tear_width_m$"
)
SIZES = re.compile(r"(outflow_)?(D\d\d|Dv\d\d)_m$")
AXES = re.compile(r"_[xyz](?=_)|_[uvw](?=_m_s)|_(min|max|largest|lowest|highest)(?=_)")
STYLES = ("-", "--", ":", "-.")


def curves(runs: list[Shown]) -> str:
    """All that changes over time, panels of one kind together: metrics first, then probes, forces and the rest."""
    columns = list(dict.fromkeys(key for run in runs for key in (*run.metrics, *run.history)))
    groups: dict[str, list[str]] = {}
    for column in columns:
        if column != "time_s" and any(_varies(_series(run, column)[1]) for run in runs):
            groups.setdefault(_kind(column), []).append(column)
    order = sorted(groups, key=lambda kind: _rank(kind, runs))
    return section("Curves", _panels([_panel(runs, groups[kind], _series, "time_s") for kind in order]))


def profiles(runs: list[Shown]) -> str:
    """Means over slices and time, a panel for each kind of number, of all runs that have a profile of a name."""
    along = {name: f"{own.along}_m" for run in runs for name, own in run.case.profiles.items()}
    parts = [f"<h3>{html.escape(name)}</h3>{_profile(runs, name, place)}" for name, place in along.items()]
    return section("Profiles", "".join(parts))


def _profile(runs: list[Shown], name: str, place: str) -> str:
    """Panels of one profile over a `place`, a column."""
    tables = {run.folder: run.profile(name) for run in runs}

    def series(run: Shown, column: str) -> tuple[np.ndarray, np.ndarray]:
        own = tables[run.folder]
        return tuple(own.get(key, np.zeros(0)) for key in (place, column))

    groups: dict[str, list[str]] = {}
    for column in dict.fromkeys(key for own in tables.values() for key in own if key != place):
        if any(_varies(series(run, column)[1]) for run in runs):
            groups.setdefault(_kind(column), []).append(column)
    return _panels([_panel(runs, own, series, place) for own in groups.values()])


def _panels(drawn: list[str]) -> str:
    first, rest = (
        f'<div class="panels">{"".join(part)}</div>' if part else "" for part in (drawn[:MOST], drawn[MOST:])
    )
    return first + folded(f"{len(drawn[MOST:])} more curves", rest)


def _series(run: Shown, column: str) -> tuple[np.ndarray, np.ndarray]:
    own = run.metrics if column in run.metrics else run.history
    return (own["time_s"], own[column]) if column in own else (np.zeros(0), np.zeros(0))


def _varies(values) -> bool:
    values = values[np.isfinite(values)]
    return len(values) > 1 and np.ptp(values) > 1e-12 * np.abs(values).max()


def _kind(column: str) -> str:
    """Curves of one kind stand in one panel: components of a vector, least and largest, mean diameters."""
    if found := SIZES.match(column):
        return f"{found[1] or ''}sizes_m"
    return AXES.sub("", column)


def _rank(kind: str, runs: list[Shown]) -> int:
    """Sizes, metrics and what a bubble grows by, then probes, forces, and particles that are followed last."""
    known = {_kind(column) for run in runs for column in run.metrics}
    probes = tuple(f"{name}_" for run in runs for name in run.case.probes)
    followed = kind.startswith("particle_") and kind[9:10].isdigit()
    if kind in known or GROWTH.match(kind):
        return 0
    if probes and kind.startswith(probes):
        return 1
    return 2 if "force" in kind else 4 if followed else 3


def _panel(runs: list[Shown], columns: list[str], series, along: str) -> str:
    """Curves of `series` (of a run and a column) over `along`, a column too."""
    figure, axis = _figure(*PANEL)
    name, unit = spoken(_kind(columns[0]) if len(columns) > 1 else columns[0])
    for i, run in enumerate(runs):
        for j, column in enumerate(columns):
            way, values = series(run, column)
            label = " ".join(part for part in (run.name * (len(runs) > 1), _part(column) * (len(columns) > 1)) if part)
            look = (i, j) if len(runs) > 1 else (j, 0)
            colour, line = COLOURS[look[0] % len(COLOURS)], STYLES[look[1] % len(STYLES)]
            if len(way):
                axis.plot(way, values, line, color=colour, linewidth=1.4, label=plain(label))
            for when, value, bar in _references(run, column) if along == "time_s" else ():
                axis.errorbar(when, value, bar, fmt="o", color="black", markersize=4, capsize=3, linewidth=1)
    if len(runs) > 1 or len(columns) > 1:
        axis.legend(fontsize=7, frameon=False)
    axis.set_title(plain(name + (f" [{unit}]" if unit else "")), fontsize=9, loc="left")
    axis.set_xlabel("{} [{}]".format(*spoken(along)), fontsize=8)
    axis.locator_params(nbins=5)
    return _drawn(figure, name)


def _part(column: str) -> str:
    """Part of a column's name by which it differs from others in its panel."""
    if found := SIZES.match(column):
        return found[2]
    return " ".join(found.group()[1:] for found in AXES.finditer(column))


def _references(run: Shown, column: str) -> list[tuple[float, float, float]]:
    """(time [s], value, tolerance) of checks that name this column at a time."""
    name, unit = spoken(column)
    found = []
    for checks in run.comparisons.values():
        for check in checks:
            at = re.match(rf"{re.escape(name)}(?: \[{re.escape(unit)}\])? at ([\d.e-]+) s$", str(check.get("name")))
            if at:
                found.append((float(at[1]), check["reference"], check["tolerance"]))
    return found


def plain(text: str) -> str:
    """A text that matplotlib takes for no formula, and as a label does not leave out for its first letter."""
    return (" " if text.startswith("_") else "") + text.replace("$", r"\$")


def _figure(wide: float, high: float):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(wide, high), layout="constrained")
    axis = figure.add_subplot()
    axis.spines[["top", "right"]].set_visible(False)
    axis.tick_params(labelsize=8)
    axis.grid(alpha=0.25, linewidth=0.6)
    return figure, axis


def _drawn(figure, name: str) -> str:
    import matplotlib

    file = io.BytesIO()
    with matplotlib.rc_context({"svg.fonttype": "none", "font.family": "sans-serif"}):
        figure.savefig(file, format="svg", metadata={"Date": None})
    return picture(file.getvalue(), name, "svg+xml", "panel")
