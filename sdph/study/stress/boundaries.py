"""`sdph stress --map`: how far beyond its limit a sub-step, and how long a window, stays stable, effect by effect.

The hard cases that have a [map] are run again with its knob turned up until a criterion breaks:

    [map]   effect = "conduction"   knob = "run.step_factor"   values = [0.5, 1.0, ...]   limit = 1.0
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from sdph.study.explain import tables
from sdph.study.stress import suite

CAREFUL = 2.0  # times: a limit that could be more than that larger is too careful (issue 18)


@dataclass(frozen=True)
class Boundary:
    """Largest stable and smallest unstable value of a knob; `limit` is what the code predicts, 0 where it predicts
    none."""

    effect: str
    knob: str
    limit: float
    stable: list
    unstable: list

    @property
    def verdict(self) -> str:
        held = max(self.stable, default=0.0)
        if not self.limit:
            return (
                "no limit foreseen, none found"
                if not self.unstable
                else f"no limit foreseen, breaks at {min(self.unstable):g}"
            )
        if held < self.limit:
            return "WRONG: breaks within its limit"
        return "right" if held <= CAREFUL * self.limit else f"careful: holds to {held / self.limit:g} times"


def boundaries(report=print) -> list[Boundary]:
    """Runs all maps."""
    found = []
    for hard in (hard for hard in map(suite.load, suite.files()) if hard.map):
        found.append(_boundary(hard))
        report(f"{found[-1].effect}: {found[-1].verdict}", flush=True)
    return found


def _boundary(hard) -> Boundary:
    stable, unstable = [], []
    for value in hard.map["values"]:
        section, key = hard.map["knob"].split(".")
        (stable if suite.run(hard, {section: {key: value}}).ok else unstable).append(value)
        if unstable:
            break
    return Boundary(hard.map["effect"], hard.map["knob"], hard.map.get("limit", 0.0), stable, unstable)


def table(picture: Path) -> str:
    """The boundaries as a table; drawn into `picture`."""
    found = boundaries()
    draw(found, picture)
    return tables.table([
        {"effect": b.effect, "knob": b.knob, "limit": b.limit or "none", "largest stable": max(b.stable, default=0.0),
         "smallest unstable": min(b.unstable, default="-"), "": b.verdict}
        for b in found
    ])  # fmt: skip


def draw(found: list[Boundary], picture: Path) -> None:
    """Measured range of stability against the predicted limit; sub-steps over their limit, windows in seconds."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    kinds = [("run.step_factor", "sub-step over its limit"), ("coupling.window_largest_s", "window [s]")]
    figure, panels = pyplot.subplots(1, 2, figsize=(12, 4), constrained_layout=True)
    for axes, (knob, label) in zip(panels, kinds):
        own = [b for b in found if b.knob == knob]
        for row, b in enumerate(own):
            axes.plot(b.stable, [row] * len(b.stable), "o", color="tab:green")
            axes.plot(b.unstable, [row] * len(b.unstable), "x", color="tab:red")
            if b.limit:
                axes.plot([b.limit], [row], "|", ms=20, color="k")
        axes.set(xscale="log", xlabel=label, yticks=range(len(own)), yticklabels=[b.effect for b in own])
    panels[0].set_title("green: stable, red: not, bar: predicted limit", fontsize=9)
    figure.savefig(picture, dpi=110)
    pyplot.close(figure)
