"""Catches a run that goes unstable, within a few sub-steps: what grew, which particle, where, when, and what to lower.

Bounds come from the case: no particle can be ten times as fast as everything that drives it taken together, nor much
hotter or colder than all that the case gives a temperature. The gas solver knows no sound, so that sudden cooling drives
its gas past the speed of sound for a moment: ten times that is too much.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np

from sdph.case import judge
from sdph.engine import state as particles
from sdph.engine.kept import Unfit
from sdph.laws.constants import GAS_CONSTANT

RUNAWAY = 10.0  # times what drives the grains, times the speed of sound of the gas; our choice
COLLAPSE = 1e3  # times what drives the grains: sound that is faster shrinks the sub-steps until a run gets nowhere; our choice
LATENT = 0.25  # of the hottest: how far below the coldest evaporation may cool; our choice
FAR, DENSE = 1e3, 1e3  # times the domain and the density of the grains: no particle is further or denser; our choice
TINY = sys.float_info.min
ADIABATIC = 1.4  # cp/cv of a diatomic gas


class Unstable(RuntimeError):
    """A run that was stopped because it went unstable; `last` is the simulation's last good state."""

    def __init__(self, text: str, last: dict):
        super().__init__(text)
        self.last = last

    def leave(self, folder: Path) -> None:
        """The last good state, and a picture of it, into the run's folder."""
        np.savez(folder / "last_good.npz", **self.last)
        _picture(self.last, folder / "last_good.png", str(self))


class Watch:
    """What every guard does: it keeps the last good state, and stops the run where a value is out of its bounds."""

    def __init__(self, case):
        self.case, self.last = case, {}
        self.time, self.window = 0.0, 0

    def begin(self, simulation) -> None:
        """Before a window: the state to go back to."""
        self.time, self.window = simulation.time, simulation.windows
        self.last = {"time": simulation.time, **{name: a.copy() for name, a in simulation.state._asdict().items() if len(a)}}

    def admit(self, state: dict, names, bounds: dict) -> None:
        """Unfit where the arrays of a kept State, those `names` of effects among them, are not one row a particle each, or
        values are out of `bounds`, name -> (low, high)."""
        count, fresh = len(state["x"]), particles.empty(1, names, self.case.dimensions)
        for name, like in fresh._asdict().items():
            if len(state[name]) != count * len(like):
                raise Unfit(f"{name} has {len(state[name])} values where {count * len(like)} belong to {count} particles")
        if len(np.unique(state["ident"])) < count:
            raise Unfit("two particles have one number")
        far = FAR * max(self.case.domain.size)
        for name, (low, high) in (dict.fromkeys("xyz", (-far, far)) | bounds).items():
            worst = _outside(state[name], low, high)
            if worst is not None:
                which = f"{name} of particle {state['ident'][worst]} is {state[name][worst]:.3g}"
                raise Unfit(f"{which}; this case allows {low:.3g} to {high:.3g}")

    def hold(self, name, values, bounds, state, lower: str) -> None:
        """Unstable where a value (N,) of the particles is out of bounds (low, high, unit); `lower`: what is to be lowered."""
        worst = _outside(values, *bounds[:2])
        if worst is not None:
            self.stop(name, f"particle {state.ident[worst]}", particles.positions(state)[worst], values[worst], bounds, lower)

    def stop(self, name, which, place, value, bounds, lower: str) -> None:
        found = self._told(name, which, place, value, bounds)
        raise Unstable(f"the run went unstable at t = {self.time:.6g} s, in window {self.window + 1}: {found}; lower {lower}", self.last)

    def _told(self, name, which, place, value, bounds) -> str:
        """Name a value that is out of bounds (low, high, unit), its place [m], and what is allowed."""
        at = ", ".join(f"{a:.4g}" for a in place[: self.case.dimensions])
        low, high, unit = bounds
        return f"{name} of {which} at ({at}) m is {value:.3g} {unit}, this case allows {low:.3g} to {high:.3g} {unit}"


class Guard(Watch):
    """Looks at the grains after every sub-step, at its length too, and at the gas after every window."""

    def __init__(self, case):
        super().__init__(case)
        scales = judge.scales_of(case)
        drop = math.sqrt(2.0 * scales.gravity * max(case.domain.size))
        pressures = [b.pressure for b in case.boundaries.values() if b.pressure is not None]
        self.pressure = max(map(abs, pressures), default=0.0)
        blown = math.sqrt(2.0 * (max(pressures, default=0.0) - min(pressures, default=0.0)) / case.gas.density)
        agitated = math.sqrt(case.grains.granular_temperature) + scales.sound
        self.reach = scales.jet + scales.thrown + drop + blown + agitated
        given = [case.gas.temperature, *(patch.temperature for patch in scales.patches)]
        given += [b.temperature for b in case.boundaries.values() if b.temperature]
        slack = scales.span + LATENT * max(given) + self.reach**2 / case.grains.heat_capacity
        self.coldest, self.hottest = max(0.0, min(given) - slack), max(given) + slack
        self.sound = math.sqrt(ADIABATIC * GAS_CONSTANT / case.gas.molar_mass * max(given))
        self.cause, self.length = "largest", case.coupling.window_largest  # until the first window begins

    def begin(self, simulation, dt: float) -> None:
        """Before a window of `dt` [s]."""
        super().begin(simulation)
        self.cause, self.length = simulation.clock.limit, dt

    def admit_grains(self, state: dict, names, heaviest: float) -> None:
        """`admit` of grains, none of more than `heaviest` [kg]."""
        speed, positive, zero_on = (-RUNAWAY * self.reach, RUNAWAY * self.reach), (TINY, math.inf), (0.0, math.inf)
        bounds = dict.fromkeys("uvw", speed) | dict.fromkeys(("diameter", "born_mass", "born_diameter"), positive)
        bounds |= dict.fromkeys(("diameter_variance", "born_variance", "lost_still", "lost_moving"), zero_on)
        bounds |= {"mass": (TINY, heaviest), "density": (0.0, DENSE * self.case.grains.density), "evaporating": (0.0, 1.0)}
        bounds |= {"temperature": (self.coldest, self.hottest), "theta": (0.0, (COLLAPSE * self.reach) ** 2)}
        bounds |= {"nozzle": (0, len(self.case.nozzles)), "entering": (0, 1)}
        kinds = [particles.GRAIN, particles.INFLOW]
        self.admit(state, names, bounds)
        if not np.isin(state["kind"], kinds).all():
            raise Unfit("a particle is neither a grain nor of a nozzle")

    def admit_gas(self, fields: dict) -> None:
        """Unfit where gas that comes from a checkpoint is faster, hotter, colder or under more pressure than this case allows."""
        most = self.case.gas.density * (RUNAWAY * self.sound) ** 2 + self.pressure
        for name, values, bounds in (*self._of_gas(fields), ("pressure", fields["pressure"], (-most, most, "Pa"))):
            worst = _outside(values, *bounds[:2])
            if worst is not None:
                low, high, unit = bounds
                raise Unfit(f"gas {name} of cell {worst} is {values[worst]:.3g} {unit}; this case allows {low:.3g} to {high:.3g}")

    def sub_step(self, stepper) -> None:
        """After a sub-step: NaN, speed, temperature of the particles."""
        s = stepper.state
        lower = f"run.step_factor (now {self.case.run.step_factor:g}; the sub-step was ruled by {stepper.limit or 'conduction'}), then {self._shorter()}"
        speed = np.sqrt(s.u**2 + s.v**2 + (s.w**2 if len(s.w) else 0.0))
        self.hold("speed", speed, (0.0, RUNAWAY * self.reach, "m/s"), s, lower)
        if len(s.temperature):
            self.hold("temperature", s.temperature, (self.coldest, self.hottest, "K"), s, lower)
        self.hold("density", s.density, (0.0, math.inf, "kg/m3"), s, lower)
        collapse = f"what packs the grains: the sub-step has fallen to {stepper.length:.2g} s"
        self.hold("speed of sound", stepper.stress.sound, (0.0, COLLAPSE * self.reach, "m/s"), s, collapse)

    def gas(self, simulation) -> str | None:
        """Name what is out of bounds in the gas after a window, NaN, speed or temperature; None where nothing is."""
        for name, values, bound in self._of_gas(simulation.gas_state.fields):
            worst = _outside(values, *bound[:2])
            if worst is not None:
                return self._told(f"gas {name}", f"cell {worst}", simulation.gas.mesh.centres[worst], values[worst], bound)
        return None

    def _of_gas(self, fields: dict):
        """(name, values (C,), bounds) of what is looked at."""
        bounds = {"velocity": (0.0, RUNAWAY * self.sound, "m/s"), "temperature": (self.coldest, self.hottest, "K")}
        for name, bound in bounds.items():
            yield name, fields[name] if fields[name].ndim == 1 else particles.lengths(fields[name]), bound

    def _shorter(self) -> str:
        return f"coupling.window_largest_s below {self.length:.3g} (the window was ruled by {self.cause})"


def _outside(values, low: float, high: float):
    """Index of the worst value that is no number or out of bounds; None if all are fine."""
    if not len(values) or (low <= values.min() and values.max() <= high):  # false for nan
        return None
    if not np.isfinite(values).all():
        return int(np.argmin(np.isfinite(values)))
    return int(np.argmax(np.maximum(values - high, low - values)))


def _picture(last: dict, file: Path, title: str) -> None:
    """Where the particles were, coloured by speed."""
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
