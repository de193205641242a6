"""Catches a run that goes unstable, within a few sub-steps: what grew, which particle, where, when, and what to lower.

Bounds come from the case: no particle can be ten times as fast as everything that drives it taken together, nor much
hotter or colder than all that the case gives a temperature. The gas solver knows no sound, so that sudden cooling
drives its gas past the speed of sound for a moment: ten times that is too much.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from sdph.engine import arrays
from sdph.engine import state as particles
from sdph.engine.kept import Unfit

RUNAWAY = 10.0  # times the fastest that a case foresees, sound of a gas or a liquid among it; our choice
FAR, DENSE = 1e3, 1e3  # times the domain and the density of the grains: no particle is further or denser; our choice
TINY = sys.float_info.min


class Unstable(RuntimeError):
    """A run that was stopped because it went unstable; `last` is the simulation's last good state."""

    def __init__(self, text: str, last: dict):
        super().__init__(text)
        self.last = last

    def leave(self, folder: Path) -> None:
        """Write the last good state, and a picture of it, into the run's folder."""
        np.savez(folder / "last_good.npz", **self.last)
        _picture(self.last, folder / "last_good.png", str(self))


class Watch:
    """Base of all guards: keeps the last good state, and stops the run where a value is out of its bounds."""

    def __init__(self, case):
        self.case, self.last = case, {}
        self.time, self.window = 0.0, 0

    def begin(self, simulation) -> None:
        """Keep the state before a window, to go back to."""
        self.time, self.window = simulation.time, simulation.windows
        self.last = {
            "time": simulation.time,
            **{name: arrays.copy(a) for name, a in simulation.state._asdict().items() if len(a)},
        }

    def _admit_rows(self, state: dict, names) -> None:
        """Unfit where the arrays are not one row a particle each, or two particles have one number."""
        count, like = len(state["x"]), particles.empty(1, names, self.case.dimensions)
        for name in state:
            own, due = len(state[name]), count * len(getattr(like, name))
            if own != due:
                raise Unfit(f"{name} has {own} values where {due} belong to {count} particles")
        if len(np.unique(state["ident"])) < count:
            raise Unfit("two particles have one number")

    def admit(self, state: dict, names, bounds: dict) -> None:
        """Unfit where the arrays of a kept State, those `names` of effects among them, are not one row a particle each,
        or values are out of `bounds`, name -> (low, high)."""
        self._admit_rows(state, names)
        far = FAR * self.case.domain.furthest
        for name, (low, high) in (dict.fromkeys("xyz", (-far, far)) | bounds).items():
            worst = outside(state.get(name, ()), low, high)
            if worst is not None:
                which = f"{name} of particle {state['ident'][worst]} is {state[name][worst]:.3g}"
                raise Unfit(f"{which}; this case allows {low:.3g} to {high:.3g}")

    def hold(self, name, values, bounds, state, lower: str) -> None:
        """Unstable where a value (N,) of the particles is out of bounds (low, high, unit); `lower`: what is to be
        lowered."""
        worst = outside(values, *bounds[:2])
        if worst is not None:
            self.stop(
                name,
                f"particle {state.ident[worst]}",
                particles.positions(state)[worst],
                values[worst],
                bounds,
                f"lower {lower}",
            )

    def stop(self, name, which, place, value, bounds, remedy: str) -> None:
        """Unstable: a value at a place (3,) [m] is out of bounds; `remedy`: what to do."""
        found = self._told(name, which, place, value, bounds)
        raise Unstable(
            f"the run went unstable at t = {self.time:.6g} s, in window {self.window + 1}: {found}; {remedy}",
            {name: arrays.brought(a) if name != "time" else a for name, a in self.last.items()},
        )

    def _told(self, name, which, place, value, bounds) -> str:
        """Name a value that is out of bounds (low, high, unit), its place [m], and what is allowed."""
        at = ", ".join(f"{a:.4g}" for a in place[: self.case.dimensions])
        low, high, unit = bounds
        return f"{name} of {which} at ({at}) m is {value:.3g} {unit}, this case allows {low:.3g} to {high:.3g} {unit}"


def outside(values, low: float, high: float):
    """Index of the worst value that is no number or out of bounds; None if all are fine."""
    if not len(values) or (low <= values.min() and values.max() <= high):  # false for nan
        return None
    if not np.isfinite(values).all():
        return int(np.argmin(np.isfinite(values)))
    return int(np.argmax(np.maximum(values - high, low - values)))


def _picture(last: dict, file: Path, title: str) -> None:
    """Draw the particles of the last good state, coloured by speed."""
    import textwrap

    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(7, 6), constrained_layout=True)
    x, y, u, v = (last[name][last["kind"] != particles.INFLOW] for name in "xyuv")
    dots = axes.scatter(x, y, s=4, c=np.hypot(u, v))
    figure.colorbar(dots, label="speed [m/s]")
    axes.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
    axes.set_title("\n".join(textwrap.wrap(f"last good state, t = {last['time']:.6g} s. {title}", 90)), fontsize=7)
    figure.savefig(file, dpi=110)
    pyplot.close(figure)
