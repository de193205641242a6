"""Report of `sdph cost`: the table by accuracy, observed orders, effects off against their estimates, the figure."""

from __future__ import annotations

import math
from collections import Counter
from pathlib import Path

from sdph import scenes
from sdph.case import judge
from sdph.laws.constants import TINY
from sdph.running import vessel
from sdph.study.cost import errors
from sdph.study.cost import rows as measured_rows
from sdph.study.cost.ladder import ALL, declared
from sdph.study.cost.rows import OWN
from sdph.study.explain import tables

LIMITS = (0.10, 0.05, 0.02, 0.01)  # errors that the table answers for
NEGLIGIBLE = 0.01  # both below the usual `run.accuracy`: rightly told to be of no account
UNDER_ALL = 0.5  # of the least error that is not 0: where a rung without any is drawn, on an axis without 0; our choice
NEAR_THE_EDGE = 0.7  # of the width: names of points beyond it stand on their left
FACTOR = 3.0  # an estimate is right within it: our choice


def text(scene: str, rows: list[dict]) -> str:
    """All tables; `rows` as `sdph.study.cost.errors.judged` gives them."""
    own = declared(scene)
    parts = [f"errors against the limit of the ladder; reference: {own.reference}"]
    parts.append(tables.table([_row(own, row) for row in rows]))
    known = errors.converged(own, rows)
    parts += [tables.table([_limit(name, metric) for name, metric in known.items()])] if known else []
    parts.append(tables.table([answer(own, rows, limit) for limit in LIMITS]))
    parts += [tables.table([prices(own, rows, name) for name in known])] if len(known) > 1 else []
    parts += [line for line in (errors.model_difference(own, rows), *instants(own, known)) if line]
    found = {key: order for key, order in measured_rows.orders(own, rows).items() if order > 0.0}
    told = ", ".join(f"{key} {order:.2f}" for key, order in found.items()) or "none, or too few rungs yet"
    parts.append(f"observed orders: {told}")
    dropped = without(scene, rows)
    return "\n\n".join([*parts, *([tables.table(dropped)] if dropped else [])])


def instants(own, known: dict[str, errors.Converged]) -> list[str]:
    """Advice to take means over time of metrics that swing from rung to rung, if there are such in a ladder of keys of
    summary.json."""
    swing = [name for name, metric in known.items() if metric.limit.swings and metric.limit.doubt > errors.TOLD]
    told = [name for name in swing if name in own.metrics and not name.startswith("mean_")]
    return [
        f"{', '.join(told)}: no order over the rungs. A number of metrics.csv is that of the last instant: where its "
        f"curve fluctuates, its mean has less doubt; set run.average_from_s and give mean_{told[0]} in place of "
        f"{told[0]}"
    ] if told else []  # fmt: skip


def _row(own, row: dict) -> dict:
    who = {"rung": row["label"] if row["solver"] == OWN else f"{row['solver']}, {row['label']}"}
    told = {"error": "error", "at most, with all finer": "bound", "off the reference": "off reference"}
    return (
        who
        | {key: row[key] for key in own.keys}
        | {head: errors.percent(row[name]) for head, name in told.items()}
        | {"wall [s]": row["wall_s"], "load": row["load"]}
    )


def _limit(name: str, metric: errors.Converged) -> dict:
    """Limit that a metric converges to: its share of the reference, or its own value."""
    limit = metric.limit
    return {
        "metric": name,
        "limit": metric.own,
        "limit off the reference": errors.percent(limit.value) if metric.referred else "-",
        "doubt": errors.percent(limit.doubt),
        "order": limit.order,
        "": "off beyond the doubt: model and reference differ" if metric.off else limit.why,
    }


def answer(own, rows: list[dict], limit: float) -> dict:
    """Tell which settings to take for this error and what they cost, or why nothing can be told."""
    best = measured_rows.cheapest(rows, limit)
    take = " ".join(f"{key}={best[key]}" for key in own.keys) if best else errors.refusal(own, rows, limit)
    return {
        "for": f"{100 * limit:g} %",
        "take": take,
        "at most": errors.percent(best["bound"]) if best else "-",
        "it costs [s]": best["wall_s"] if best else math.nan,
    }


def prices(own, rows: list[dict], metric: str) -> dict:
    """Time [s] that each error of one metric alone costs."""
    judged = errors.judged(own, measured_rows.of_metric(rows, metric))
    best = {limit: measured_rows.cheapest(judged, limit) for limit in LIMITS}
    return {"it costs [s] in one metric": metric} | {
        f"{100 * limit:g} %": row["wall_s"] if row else math.nan for limit, row in best.items()
    }


def without(scene: str, rows: list[dict]) -> list[dict]:
    """Measured change of the metrics when an effect is left out, beside its estimate."""
    own = declared(scene)
    judged = judge.judgements(vessel.load(scenes.find(scene)[1], (*own.settings, *own.excerpt)))
    middle = next((row for row in rows if measured_rows.has(row, own.middle)), None)
    found = []
    for row in rows if middle else ():
        if row["solver"] == OWN and row["without"] != ALL:
            change, estimate = measured_rows.distance(middle, row), judged[row["without"]].error_if_off
            found.append({
                "effect left out": row["without"], "measured change": errors.percent(change),
                "estimate": errors.percent(estimate),
                "within a factor of 3": "yes" if near(change, estimate) else "NO",
            })  # fmt: skip
    return found


def near(change: float, estimate: float) -> bool:
    """True of a right estimate: within a factor of three, or of no account like the change itself. An estimate is a
    share of the answer, so that a change of more than all of it counts as 1."""
    if max(change, estimate) < NEGLIGIBLE:
        return True
    return 1.0 / FACTOR <= min(change, 1.0) / max(estimate, TINY) <= FACTOR


def draw(scene: str, rows: list[dict], picture: Path) -> None:
    """The work-precision diagram: each row by its own error, lines by what may be promised, all finer rows and the
    doubt about the limit included."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(7.5, 5.5), constrained_layout=True)
    rows = _on_the_axis(rows)
    _line(axes, measured_rows.front(rows), "o-", "tab:red", "sdph, at most, with all finer")
    for colour, solver in zip(("tab:blue", "tab:green"), sorted({row["solver"] for row in rows} - {OWN})):
        _line(axes, [row for row in rows if row["solver"] == solver], "s--", colour, f"{solver}, by the same rule")
    loads = [float(row["load"]) for row in rows]
    axes.set(xscale="log", yscale="log", xlabel="wall time [s]")
    axes.set_ylabel("distance of the worst metric from the limit [%], triangles: none")
    _points(axes, [row for row in rows if math.isfinite(row["error"])])
    axes.set_title(
        f"{scene}; reference: {declared(scene).reference}\nload of the machine {min(loads):g} to {max(loads):g} on "
        f"{int(rows[0]['cores'])} cores",
        fontsize=8,
        wrap=True,
    )
    axes.legend(fontsize=8)
    figure.savefig(picture, dpi=110)
    pyplot.close(figure)


def _on_the_axis(rows: list[dict]) -> list[dict]:
    """The rows with errors of 0 (`none`) drawn below all others."""
    told = [row[key] for row in rows for key in ("error", "bound")]
    least = UNDER_ALL * min((error for error in told if 0.0 < error < math.inf), default=1.0)
    return [
        row | {key: max(row[key], least) for key in ("error", "bound")} | {"none": not row["error"]} for row in rows
    ]


def _line(axes, rows: list[dict], style: str, colour: str, label: str) -> None:
    told = [row for row in rows if math.isfinite(row["bound"])]
    places = [row["wall_s"] for row in told], [100.0 * row["bound"] for row in told]
    axes.plot(*places, style, color=colour, label=label if told else f"{label}: nothing can be told")


def _points(axes, rows: list[dict]) -> None:
    """Each row by its own error, and beside it its name, unless that lies on another one, which counts it: rungs have
    theirs before effects left out."""
    for row in rows:
        style = "v" if row["none"] else "o" if row["without"] == ALL else "x"
        axes.plot(*_place(row), style, color="tab:gray", ms=4)
    axes.figure.draw_without_rendering()
    names, more = {}, Counter()
    for row in sorted(rows, key=lambda row: row["without"] != ALL):
        name = _named(axes, row)
        text = name.get_text()
        name.set_text(f"{text} (+ 99)")  # with room for how many it hides
        room = name.get_window_extent()
        name.set_text(text)
        under = next((other for other, taken in names.items() if taken.overlaps(room)), name)
        if under is name:
            names[name] = room
        else:
            name.remove()
            more[under] += 1
    for name, hidden in more.items():
        name.set_text(f"{name.get_text()} (+ {hidden})")


def _place(row: dict) -> tuple[float, float]:
    return row["wall_s"], 100.0 * row["error"]


def _named(axes, row: dict):
    """The name of a row, on the side of its point where there is room."""
    label = str(row["label"])
    named = f"{label.rpartition('.')[2]}={row[label]}" if label in row else label
    across, _ = axes.transAxes.inverted().transform(axes.transData.transform(_place(row)))
    side, off = ("right", -3) if across > NEAR_THE_EDGE else ("left", 3)
    return axes.annotate(named, _place(row), fontsize=6, xytext=(off, 3), textcoords="offset points", ha=side)
