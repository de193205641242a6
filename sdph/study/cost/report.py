"""What `sdph cost` shows: the table by accuracy, observed orders, effects off against their estimates, the figure."""

from __future__ import annotations

from pathlib import Path

from sdph import scenes
from sdph.case import judge
from sdph.case import read as cases
from sdph.study.cost import rows as measured_rows
from sdph.study.cost.ladder import ALL, declared
from sdph.study.cost.rows import OWN
from sdph.study.explain import tables

LIMITS = (0.10, 0.05, 0.02, 0.01)  # errors that the table answers for
NEGLIGIBLE = 0.01  # both below the usual `run.accuracy`: rightly told to be of no account
LEAST = 1e-12  # error that the logarithmic axis ends at


def text(scene: str, rows: list[dict]) -> str:
    """All tables."""
    own = declared(scene)
    parts = [f"errors against: {own.reference}", tables.table([_row(own, row) for row in rows])]
    parts.append(tables.table([_answer(own, rows, limit) for limit in LIMITS]))
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
        | {"error": row["error"], "wall [s]": row["wall_s"], "load": row["load"]}
    )


def _answer(own, rows: list[dict], limit: float) -> dict:
    """For this error take these settings, it costs so much."""
    best = measured_rows.cheapest(rows, limit)
    take = " ".join(f"{key}={best[key]}" for key in own.keys) if best else "nothing measured holds it"
    return {
        "for": f"{100 * limit:g} %",
        "take": take,
        "error": best["error"] if best else float("nan"),
        "it costs [s]": best["wall_s"] if best else float("nan"),
    }


def without(scene: str, rows: list[dict]) -> list[dict]:
    """Measured change of the metrics when an effect is left out, beside its estimate."""
    own = declared(scene)
    judged = judge.judgements(cases.load(scenes.find(scene)[1], (*own.settings, *own.excerpt)))
    middle = next((row for row in rows if measured_rows.has(row, own.middle)), None)
    found = []
    for row in rows if middle else ():
        if row["solver"] == OWN and row["without"] != ALL:
            change, estimate = measured_rows.distance(middle, row), judged[row["without"]].error_if_off
            found.append(
                {
                    "effect left out": row["without"],
                    "measured change": change,
                    "estimate": estimate,
                    "right order": "yes" if near(change, estimate) else "NO",
                }
            )
    return found


def near(change: float, estimate: float) -> bool:
    """Whether an estimate is right: within a factor of ten, or of no account like the change itself. An estimate is a
    share of the answer, so that a change of more than all of it counts as 1."""
    return max(change, estimate) < NEGLIGIBLE or 0.1 <= min(change, 1.0) / max(estimate, 1e-300) <= 10.0


def draw(scene: str, rows: list[dict], picture: Path) -> None:
    """The work-precision diagram."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(7.5, 5.5), constrained_layout=True)
    for row in rows:
        _point(axes, row)
    best = measured_rows.front(rows)
    axes.plot(
        [row["wall_s"] for row in best],
        [max(row["error"], LEAST) for row in best],
        "o-",
        color="tab:red",
        label="sdph, Pareto front",
    )
    for colour, solver in zip(("tab:blue", "tab:green"), sorted({row["solver"] for row in rows} - {OWN})):
        line = [row for row in rows if row["solver"] == solver]
        axes.plot(
            [row["wall_s"] for row in line],
            [max(row["error"], LEAST) for row in line],
            "s--",
            color=colour,
            label=solver,
        )
    loads = [float(row["load"]) for row in rows]
    axes.set(xscale="log", yscale="log", xlabel="wall time [s]", ylabel="error of the worst metric")
    axes.set_title(
        f"{scene}; reference: {declared(scene).reference}\nload of the machine {min(loads):g} to {max(loads):g} on "
        f"{int(rows[0]['cores'])} cores",
        fontsize=8,
        wrap=True,
    )
    axes.legend(fontsize=8)
    figure.savefig(picture, dpi=110)
    pyplot.close(figure)


def _point(axes, row: dict) -> None:
    place = row["wall_s"], max(row["error"], LEAST)
    axes.plot(*place, "o" if row["without"] == ALL else "x", color="tab:gray", ms=4)
    label = str(row["label"])
    named = f"{label.rpartition('.')[2]}={row[label]}" if label in row else label
    axes.annotate(named, place, fontsize=6, xytext=(3, 3), textcoords="offset points")
