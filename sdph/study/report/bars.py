"""Bars of the report, of HTML alone so that they fit any width: deviations from references, balances, wall times."""

from __future__ import annotations

import html
import math
from typing import NamedTuple

from sdph.running import balances
from sdph.study.report.shown import Shown, folded, section, side_by_side, spoken, table

COLOURS = ("#1f5fa8", "#c2561a", "#2b8a5a", "#8a3d9e", "#6b6b6b", "#b8890b")
GOOD, BAD, BAND = "#2b8a5a", "#b00020", "#2b8a5a22"
LEAST = -17  # decimal logarithm at the left end of balances: round-off
WIDEST = 10.0  # tolerances at the ends of deviations: one beyond is drawn that long; our choice


class Span(NamedTuple):
    """Part of a row's track, from left to right [%]."""

    left: float
    right: float
    colour: str


def row(name: str, spans: list[Span], said: str) -> str:
    """A name, a track with coloured parts, and the value in words."""
    parts = "".join(
        f'<i style="left:{s.left:.2f}%;width:{max(0.4, s.right - s.left):.2f}%;background:{s.colour}"></i>'
        for s in spans
    )
    return f'<div class="row"><span>{html.escape(name)}</span><div>{parts}</div><span>{html.escape(said)}</span></div>'


def checks(runs: list[Shown]) -> str:
    """Deviation from each reference over its tolerance, and the numbers."""
    body = ""
    for run in runs:
        for name, rows in run.comparisons.items():
            body += f"<h3>{html.escape(run.name)} against {html.escape(name)}</h3>{_deviations(rows)}"
            cells = [
                [*map(one.get, ("name", "value", "reference", "tolerance")), "ok" if one.get("ok") else "FAILED"]
                for one in rows
            ]
            body += folded("numbers", table(["check", "value", "reference", "tolerance", ""], cells))
    return section("References", body)


def _deviations(rows: list[dict]) -> str:
    """(value - reference)/tolerance, the band being what is allowed; checks that allow nothing stand in the table."""
    known = [one for one in rows if all(_number(one.get(k)) for k in ("value", "reference", "tolerance"))]
    shares = [((one["value"] - one["reference"]) / one["tolerance"], one) for one in known if one["tolerance"] > 0.0]
    if not shares:
        return ""
    reach = min(WIDEST, max(1.5, 1.1 * max(abs(share) for share, _ in shares)))
    body = ""
    for share, one in shares:
        end = 50.0 + 50.0 * min(1.0, max(-1.0, share / reach))
        allowed = Span(50.0 - 50.0 / reach, 50.0 + 50.0 / reach, BAND)
        own = Span(min(50.0, end), max(50.0, end), GOOD if one.get("ok") else BAD)
        body += row(str(one.get("name")), [allowed, own], f"{share:+.2f}")
    return f'{body}<p class="note">(value - reference)/tolerance; the band is what is allowed</p>'


def closures(runs: list[Shown]) -> str:
    """All balances in one figure: what is missing, on a logarithmic track, and the most that is allowed."""
    tables = [{one["name"]: one for one in balances.checks(_numbers(run.summary, lost=True))} for run in runs]
    names = list(dict.fromkeys(name for own in tables for name in own))
    if not names:
        return ""
    body = ""
    for name in names:
        for i, (run, own) in enumerate(zip(runs, tables)):
            if name in own:
                value, bar = abs(own[name]["value"]), own[name]["tolerance"]
                colour = COLOURS[i % len(COLOURS)] if math.isfinite(value) else BAD
                spans = [Span(0.0, _place(bar), BAND), Span(0.0, _place(value), colour)]
                label = spoken(name)[0] + (f", {run.name}" if len(runs) > 1 else "")
                body += row(
                    label, spans, f"{value:.1g}, may be {bar:.0e}" if own[name]["ok"] else f"{value:.2g}: missed"
                )
    note = "missing over what is there, moved or exchanged, from 1e-17 to 1, logarithmic; the band is what is allowed"
    numbers = side_by_side(runs, [{name: one["value"] for name, one in own.items()} for own in tables])
    return section("Balances", f'{body}<p class="note">{note}</p>{folded("numbers", numbers)}')


def _place(value: float) -> float:
    """Place [%] of a number on the logarithmic track; its end of what is none."""
    if not math.isfinite(value):
        return 100.0
    return 100.0 * (1.0 - min(max(math.log10(value) if value else LEAST, LEAST), 0.0) / LEAST)


def _number(value, lost: bool = False) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and (lost or math.isfinite(value))


def _numbers(summary: dict, lost: bool = False) -> dict:
    """Numbers of a summary; those that are nan or infinite too where `lost`."""
    return {key: value for key, value in summary.items() if _number(value, lost)}


def times(runs: list[Shown]) -> str:
    """Wall times: a bar for each run, its parts as long as they took."""
    rows = [
        {k: v for k, v in run.summary.items() if k.startswith("wall_") or k.endswith(("_per_window", "_per_s"))}
        for run in runs
    ]
    numbers = side_by_side(runs, rows) if any(rows) else ""
    return section("Where the time went", "".join(map(_time, runs)) + folded("numbers", numbers))


def _time(run: Shown) -> str:
    parts = {k[5:-2]: v for k, v in run.summary.items() if k.startswith("wall_") and k.endswith("_s") and k != "wall_s"}
    whole = max(run.summary.get("wall_s") or 0.0, sum(parts.values()))
    if not whole:
        return ""
    parts["else"] = whole - sum(parts.values())
    spans, legend, left = [], "", 0.0
    for (name, own), colour in zip(parts.items(), COLOURS):
        spans.append(Span(left, left + 100.0 * own / whole, colour))
        legend += f'<span><i style="background:{colour}"></i>{html.escape(name)} {own:.3g} s</span>'
        left = spans[-1].right
    return row(run.name, spans, f"{whole:.3g} s") + f'<p class="legend">{legend}</p>'
