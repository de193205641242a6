"""Report of `sdph cost`: the table by accuracy, observed orders, effects off against their estimates, the figure."""

from __future__ import annotations

import math
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
LEAST = 1e-12  # error that the logarithmic axis ends at
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
    parts += [different] if (different := errors.model_difference(own, rows)) else []
    found = measured_rows.orders(own, rows)
    parts.append(
        "observed orders: " + (", ".join(f"{key} {order:.2f}" for key, order in found.items()) or "too few rungs yet")
    )
    dropped = without(scene, rows)
    return "\n\n".join([*parts, *([tables.table(dropped)] if dropped else [])])


def _row(own, row: dict) -> dict:
    who = {"rung": row["label"] if row["solver"] == OWN else f"{row['solver']}, {row['label']}"}
    return (
        who
        | {key: row[key] for key in own.keys}
        | {"error": row["error"], "at most, with all finer": row["bound"], "off the reference": row["off reference"]}
        | {"wall [s]": row["wall_s"], "load": row["load"]}
    )


def _limit(name: str, metric: errors.Converged) -> dict:
    """Limit that a metric converges to: its share of the reference, or its own value."""
    value, doubt, order = metric.limit
    return {
        "metric": name,
        "limit": value * metric.scale if not metric.referred else math.nan,
        "limit off the reference": value if metric.referred else math.nan,
        "doubt": doubt,
        "order": order,
        "": "off beyond the doubt: model and reference differ" if metric.off else "",
    }


def answer(own, rows: list[dict], limit: float) -> dict:
    """Tell which settings to take for this error and what they cost, or why nothing can be told."""
    best = measured_rows.cheapest(rows, limit)
    take = " ".join(f"{key}={best[key]}" for key in own.keys) if best else errors.refusal(own, rows, limit)
    return {
        "for": f"{100 * limit:g} %",
        "take": take,
        "at most": best["bound"] if best else math.nan,
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
                "effect left out": row["without"], "measured change": change, "estimate": estimate,
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
    for row in rows:
        _point(axes, row)
    _line(axes, measured_rows.front(rows), "o-", "tab:red", "sdph, promised")
    for colour, solver in zip(("tab:blue", "tab:green"), sorted({row["solver"] for row in rows} - {OWN})):
        _line(axes, [row for row in rows if row["solver"] == solver], "s--", colour, f"{solver}, by the same rule")
    loads = [float(row["load"]) for row in rows]
    axes.set(xscale="log", yscale="log", xlabel="wall time [s]", ylabel="distance of the worst metric from the limit")
    axes.set_title(
        f"{scene}; reference: {declared(scene).reference}\nload of the machine {min(loads):g} to {max(loads):g} on "
        f"{int(rows[0]['cores'])} cores",
        fontsize=8,
        wrap=True,
    )
    axes.legend(fontsize=8)
    figure.savefig(picture, dpi=110)
    pyplot.close(figure)


def _line(axes, rows: list[dict], style: str, colour: str, label: str) -> None:
    told = [row for row in rows if math.isfinite(row["bound"])]
    places = [row["wall_s"] for row in told], [max(row["bound"], LEAST) for row in told]
    axes.plot(*places, style, color=colour, label=label if told else f"{label}: nothing")


def _point(axes, row: dict) -> None:
    if not math.isfinite(row["error"]):
        return
    place = row["wall_s"], max(row["error"], LEAST)
    axes.plot(*place, "o" if row["without"] == ALL else "x", color="tab:gray", ms=4)
    label = str(row["label"])
    named = f"{label.rpartition('.')[2]}={row[label]}" if label in row else label
    axes.annotate(named, place, fontsize=6, xytext=(3, 3), textcoords="offset points")
