"""What `sdph cost` shows: the table by accuracy, observed orders, effects off against their estimates, the figure."""

from __future__ import annotations

from pathlib import Path

from sdph import case as cases
from sdph import scenes
from sdph.cost import ladder
from sdph.explain import judge, tables

NEGLIGIBLE = 0.01  # both below the usual `run.accuracy`: rightly told to be of no account


def text(scene: str, rows: list[dict]) -> str:
    """All tables."""
    own = ladder.declared(scene)
    parts = [f"errors against: {own.reference}", tables.table([_row(own, row) for row in rows])]
    parts.append(tables.table([_answer(own, rows, limit) for limit in ladder.LIMITS]))
    found = ladder.orders(own, rows)
    parts.append("observed orders: " + (", ".join(f"{key} {order:.2f}" for key, order in found.items()) or "too few rungs yet"))
    dropped = without(scene, rows)
    return "\n\n".join([*parts, *([tables.table(dropped)] if dropped else [])])


def _row(own, row: dict) -> dict:
    return {"rung": row["label"], **{key: row[key] for key in own.knobs}, "error": row["error"], "wall [s]": row["wall_s"], "load": row["load"]}


def _answer(own, rows: list[dict], limit: float) -> dict:
    """For this error take these settings, it costs so much."""
    best = ladder.cheapest(rows, limit)
    take = " ".join(f"{key}={best[key]}" for key in own.knobs) if best else "nothing measured holds it"
    return {"for": f"{100 * limit:g} %", "take": take, "error": best["error"] if best else float("nan"), "it costs [s]": best["wall_s"] if best else float("nan")}


def without(scene: str, rows: list[dict]) -> list[dict]:
    """Measured change of the metrics when an effect is left out, beside its estimate."""
    judged = judge.judgements(cases.load(scenes.find(scene)[1], tuple(ladder.declared(scene).base)))
    middle = next((row for row in rows if row["label"] == f"all {_middle(rows)}"), None)
    found = []
    for row in rows:
        if row["without"] != ladder.ALL and middle:
            change, estimate = ladder._distance(middle, row), judged[row["without"]].error_if_off
            near = max(change, estimate) < NEGLIGIBLE or 0.1 <= change / max(estimate, 1e-300) <= 10.0
            found.append({"effect left out": row["without"], "measured change": change, "estimate": estimate, "right order": "yes" if near else "NO"})
    return found


def _middle(rows: list[dict]) -> str:
    count = int(next(str(row["label"]).split("/")[1] for row in rows if str(row["label"]).startswith("all ")))
    return f"{count // 2 + 1}/{count}"


def front(rows: list[dict]) -> list[dict]:
    """Rows that nothing beats in both error and time, by time."""
    kept, least = [], float("inf")
    for row in sorted(rows, key=lambda row: (row["wall_s"], row["error"])):
        if row["error"] < least and row["without"] == ladder.ALL:
            kept.append(row)
            least = row["error"]
    return kept


def draw(scene: str, rows: list[dict], picture: Path) -> None:
    """The work-precision diagram."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(7.5, 5.5), constrained_layout=True)
    for row in rows:
        axes.plot(row["wall_s"], max(row["error"], 1e-12), "o" if row["without"] == ladder.ALL else "x", color="tab:gray")
        axes.annotate(str(row["label"]), (row["wall_s"], max(row["error"], 1e-12)), fontsize=6, xytext=(3, 3), textcoords="offset points")
    best = front(rows)
    axes.plot([row["wall_s"] for row in best], [max(row["error"], 1e-12) for row in best], "o-", color="tab:red", label="Pareto front")
    loads = [float(row["load"]) for row in rows]
    axes.set(xscale="log", yscale="log", xlabel="wall time [s]", ylabel="error of the worst metric")
    axes.set_title(f"{scene}; reference: {ladder.declared(scene).reference}\nload of the machine {min(loads):g} to {max(loads):g} on {rows[0]['cores']} cores", fontsize=8)
    axes.legend()
    figure.savefig(picture, dpi=110)
    pyplot.close(figure)
