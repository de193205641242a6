"""Instants at which a swirling sheet is measured as it goes on, and their means.

The first is when the nozzle has fed it for one and a half times the way through the domain: liquid of the mouth is then
at the outlet, and as much again as half of it has passed, so that nothing is seen of the first layers, which had no
sheet before them (swirl-sheet.md, section 7). From then on one follows every tenth of that way: at 20 m/s and 20 mm all
of the sheet has gone on by 2 mm, ten and more of the cells that a place is measured by, so that at any one place the
liquid is another each time and lengths are independent. Angles are of a slope over 0.6 of the sheet, which stays in it
for six instants: their scatter is that of instants which share liquid.
"""

from __future__ import annotations

import math

import numpy as np

from sdph.engine import state as particles
from sdph.engine.kept import ROW, Many, Unfit
from sdph.methods.mps import sheet

FILLED = 1.5  # ways through the domain until the first instant; swirl-sheet.md, section 7
APART = 0.1  # of that way between two; as above
EARLY = 1e-6  # of the time between two: a row of the history that is early by round-off counts; our choice
NAMES = (
    "half_angle_deg", "half_angle_of_outline_deg", "break_up_length_m", "empty_area_m2", "empty_share",
    "tenth_empty_way_m", "half_empty_way_m",
)  # fmt: skip


class Instants:
    """Measures of the sheet of a case at its instants, a row each with NAMES and `time_s`, and `light` (n,): sum over
    them of the share of light that gets through, in rows of pixels up to the outlet. All processes know them."""

    KEPT, FORMS = ("rows", "light"), {"rows": Many(ROW)}  # see sdph.engine.kept

    def __init__(self, case):
        self.case, self.rows, nozzle = case, [], sheet.nozzle_of(case)
        self.between = self.begin = self.end = math.inf  # [s]
        pixels = 0
        if nozzle:
            way = sheet.way_out(case)
            self.between = APART * way / nozzle.speed
            self.begin = nozzle.start + FILLED * way / nozzle.speed
            self.end = math.inf if nozzle.end is None else nozzle.end
            pixels = math.ceil(way / (sheet.PIXEL * case.resolution.spacing))
        self.light = np.zeros(pixels)

    def admit(self, kept: dict) -> None:
        """Unfit where a row is not one of an instant."""
        for row in kept["rows"]:
            if row.keys() != {"time_s", *NAMES} or not all(isinstance(value, float) for value in row.values()):
                raise Unfit("an instant of the sheet has not its columns, or not numbers in them")

    def due(self, time: float) -> bool:
        """Tell whether one is to be measured at `time` [s]: while the nozzle feeds the sheet."""
        wanted = self.rows[-1]["time_s"] + self.between if self.rows else self.begin
        return time < self.end and time >= wanted - EARLY * self.between

    def look(self, run) -> None:
        """Measure the sheet of a run if it is time."""
        if not self.due(run.time):
            return
        with run.whole() as chief:
            found = self._seen(run) if chief else None
        row, light = run.stepper.world.told(found)
        self.rows.append(row)
        self.light += light

    def _seen(self, run) -> tuple[dict[str, float], np.ndarray]:
        """Row of now and light (n,), 1 where no liquid has come."""
        seen, length = sheet.seen_from(self.case, particles.positions(run.inside()))
        light, found = np.ones(len(self.light)), sheet.transmission(seen, self.case.resolution.spacing)[1]
        many = min(len(light), len(found))
        light[:many] = found[:many]
        return {"time_s": run.time} | sheet.measured(self.case, seen, length), light

    def told(self, run) -> dict[str, float]:
        """Summary: mean and standard deviation (of a sample, n - 1) over the instants, now among them if it is time,
        their number, and the break-up length of their mean light; nan where a number is nan at any of them, as the mean
        of the others would be too small, and a deviation of fewer than two."""
        rows, light = list(self.rows), self.light
        if self.due(run.time):
            row, more = self._seen(run)
            rows, light = [*rows, row], light + more
        found = {"instants": len(rows)}
        for name in NAMES:
            own = np.array([row[name] for row in rows])
            found[sheet.named(name, "mean")] = float(own.mean()) if len(own) else math.nan
            found[sheet.named(name, "deviation")] = float(own.std(ddof=1)) if len(own) > 1 else math.nan
        pixel, slant = sheet.PIXEL * self.case.resolution.spacing, sheet.slant(sheet.nozzle_of(self.case))
        z, mean = (np.arange(len(light)) + 0.5) * pixel, light / max(1, len(rows))
        return found | {"break_up_length_of_mean_light_m": slant * sheet.first_past(z, mean, sheet.HALF)}
