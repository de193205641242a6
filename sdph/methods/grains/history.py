"""Columns of history.csv of grains: the particles that `[track]` names, materials, heat from walls."""

from __future__ import annotations

import math

import numpy as np

from sdph import effects
from sdph.engine import state as particles
from sdph.engine.walls.parts import counts
from sdph.engine.world import here

TRACKED = {
    "x_m": "x", "y_m": "y", "z_m": "z", "u_m_s": "u", "v_m_s": "v", "w_m_s": "w", "temperature_K": "temperature",
    "granular_temperature_m2_s2": "theta", "diameter_m": "diameter", "mass_kg": "mass",
    "sealed": "sealed", "bubble_m3": "bubble_void",
}  # fmt: skip


def tracked(case, stepper) -> dict[str, float]:
    """Place, velocity, temperatures and heat rates of the tracked particles (paper, figures 9 and 10); nan before they
    come in and once they are gone."""
    if not case.track:
        return {}
    state, columns, arrays = stepper.own, {}, carried(case)
    fields = {key: getattr(state, name) for key, name in TRACKED.items() if name in arrays}
    fields["convective_heat_W"] = state.received if len(state.received) else np.zeros(len(state.x))
    for ident in case.track:
        place = np.flatnonzero((state.ident == ident) & (state.kind != particles.INFLOW))
        found = {key: float(values[place[0]]) if len(place) else math.nan for key, values in fields.items()}
        found["conductive_heat_W"] = float(stepper.conduction_rate(place[0])) if len(place) else math.nan
        columns |= {f"particle_{ident}_{key}": value for key, value in found.items()}
    return stepper.world.known(columns)


def carried(case) -> set[str]:
    """Names of the arrays that particles of a case have, were there any: so that every row has the same columns."""
    names = effects.arrays(case)
    return {name for name, values in particles.empty(1, names, case.dimensions)._asdict().items() if len(values)}


def of_materials(case, state) -> dict[str, float]:
    """Mass [kg] of each of several materials in the gas, its mean height [m] against gravity over the domain's corner
    (nan without gravity or grains), and its mean velocity [m/s] along it."""
    if not case.mixed:
        return {}
    found, gravity = {}, np.array((*case.domain.gravity, 0.0)[:3])
    up = -gravity / np.linalg.norm(gravity) if gravity.any() else np.full(3, math.nan)
    height = (particles.positions(state) - np.array((*case.domain.corner, 0.0)[:3])) @ up
    rise = particles.velocities(state) @ up
    for number, name in enumerate(case.materials):
        mass = state.mass * (state.material == number)
        total, *sums = here().sum(np.array([mass.sum(), mass @ height, mass @ rise])).tolist()
        means = (own / total if total else math.nan for own in sums)
        found |= dict(zip((f"material_{name}_{key}" for key in ("kg", "height_m", "rise_m_s")), (total, *means)))
    return found


class Warmed:
    """Heat [J] that each wall with a temperature gave the grains, and the area that they covered of it, times time
    [m2 s]: in the last window, and since the time `start` [s]; per metre of depth in two dimensions."""

    KEPT = ("sums", "times")  # see sdph.engine.kept

    def __init__(self, hot, start: float):
        self.hot, self.names, self.start = hot, hot.names if hot else (), start
        self.sums, self.times = np.zeros((2, len(self.names), 2)), np.zeros(2)  # times [s]

    def add(self, gave: np.ndarray, begun: float, end: float) -> None:
        """Take what a window from `begun` to `end` [s] brought, (F, 2) of each face."""
        counted = float(counts(begun, end, self.start))
        self.times = np.array([end - begun, self.times[1] + counted * (end - begun)])
        if self.hot:
            own = self.hot.owners @ gave
            self.sums = np.array([own, self.sums[1] + counted * own])

    def row(self) -> dict[str, float]:
        """Means of the window by column: heat [W], share of the area that grains cover; nan of no time."""
        return self._means(0)

    def summary(self) -> dict[str, float]:
        """Means since the time from which they are taken, and areas [m2]."""
        areas = zip(self.names, self.hot.areas) if self.hot else ()
        sizes = {f"{name}_area_m2": float(area) for name, area in areas}
        return {f"mean_{key}": value for key, value in self._means(1).items()} | sizes

    def _means(self, since: int) -> dict[str, float]:
        time, found = self.times[since] or math.nan, {}
        for n, name in enumerate(self.names):
            heat, covered = self.sums[since, n] / time
            found |= {f"{name}_grain_heat_W": float(heat), f"{name}_covered": float(covered / self.hot.areas[n])}
        return found
