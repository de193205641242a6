"""A liquid of moving particles, as a run needs it (sdph.methods.method.Method): stepper, ledger, pieces that left."""

from __future__ import annotations

import contextlib
from pathlib import Path

import numpy as np

from sdph.effects.around import tank
from sdph.engine import arrays, ashore, gathered
from sdph.engine import state as particles
from sdph.engine.kept import GROWING
from sdph.engine.state import LIQUID
from sdph.engine.stepped import Stepped
from sdph.engine.table import Table
from sdph.methods.mps import aboard, history, limiters, pieces, sheet
from sdph.methods.mps.instants import Instants
from sdph.methods.mps.method import MpsStepper
from sdph.methods.mps.pieces import RESOLVED
from sdph.methods.mps.totals import MpsLedger


class Mps(Stepped):
    """An incompressible liquid and what it does in a window."""

    matter = "liquid"
    # see sdph.engine.kept
    KEPT = ("windows", "stepper", "ledger", "drops", "diameters", "counts", "impulse", "since", "instants")
    FORMS = {"diameters": GROWING, "counts": GROWING}

    def __init__(self, case, ledger: Path | None, shortest: float):
        self.case, self.windows = case, 0
        self.stepper = MpsStepper(case, shortest)
        self.ledger = MpsLedger(ledger, not {"tank", "inflow"} & set(case.effects))
        self.drops = Table(ledger and ledger.with_name("droplets.csv"))  # pieces that have left
        self.diameters, self.counts = np.zeros(0), np.zeros(0)  # [m] and particles of each
        # of the liquid by all but gravity at the last row [kg m/s], and its time [s]
        self.impulse, self.since = np.zeros(3), 0.0
        self.instants = Instants(case)

    def tables(self) -> list:
        """Files that grow by rows."""
        return [self.ledger.table, self.drops]

    def advance(self, end: float, most: float = np.inf) -> None:
        """Go to `end` [s], or as far as `most` steps get."""
        if self.case.run.device != "cpu" and arrays.here(self.state.x):
            aboard.board(self.stepper)
        super().advance(end, most)

    @contextlib.contextmanager
    def whole(self):
        with ashore.ashore(self.stepper), gathered.whole(self.stepper) as chief:
            yield chief

    def close(self) -> None:
        self.stepper.guard.look(self.stepper)
        self.ledger.close_window(self.stepper, self.time - self.begun)
        if self.stepper.openings:
            told = self.stepper.openings.told
            for row in told:
                self.drops.write(row)
            self.diameters = np.append(self.diameters, [row["diameter_m"] for row in told])
            self.counts = np.append(self.counts, [float(row["particles"]) for row in told])
            told.clear()

    def new_row(self) -> None:
        """Begin the mean of the load on the tank anew, and measure the sheet: the history has a row of now."""
        self.impulse, self.since = self.stepper.impulses[1].copy(), self.time
        self.instants.look(self)

    def row(self) -> dict[str, float]:
        """Columns of history.csv."""
        with ashore.ashore(self.stepper):
            return history.row(self)

    def held(self) -> dict[str, float]:
        return limiters.held(self.stepper)

    def points(self):
        with ashore.ashore(self.stepper):
            return self._points()

    def _points(self):
        import pyvista

        domain, apart = self.stepper.domain, self.case.method.piece * self.case.resolution.spacing
        rows = np.flatnonzero(self.state.kind == LIQUID)  # of copies too
        piece, _ = pieces.labels(domain, self.state, rows, apart, self.case.liquid_period)
        own = self.stepper.active
        cloud = pyvista.PolyData(particles.positions(self.state)[own])
        if len(own):  # pyvista knows no empty arrays
            cloud["velocity"] = particles.velocities(self.state)[own]
            cloud["pressure"] = self.stepper.gauge[own]
            for name in ("ident", "kind", "mass", "density"):
                cloud[name] = getattr(self.state, name)[own]
            cloud["piece"] = piece[: len(own)]
        return cloud

    def walls(self):
        return tank.shape_of(self.case).surface() if "tank" in self.case.effects else None

    def summary(self) -> dict[str, float]:
        with self.whole():
            found = self._summary()
        shared = self.stepper.domain.summary(self.steps - self.stepper.steps_before)
        return found | shared | ashore.told(self.stepper)

    def _summary(self) -> dict[str, float]:
        opening = self.stepper.openings
        found = {
            "liquid_particles": int((self.state.kind == LIQUID).sum()),
            "kinetic_energy_J": particles.energy_of_motion(self.inside()),
            "poisson_iterations_mean": self.stepper.iterations / max(1, self.steps),
            "pressure_clipped_Pa": self.stepper.clipped / max(1, self.steps) / max(1, len(self.state.x)),
        }
        if opening and opening.leave:
            whole = self.counts >= RESOLVED
            found |= {"droplets": opening.left, "droplets_resolved": int(whole.sum()), "cut_particles": opening.cut}
            found |= pieces.sizes(self.diameters, whole)
        if sheet.nozzle_of(self.case):
            found |= sheet.told(self.case, particles.positions(self.inside())) | self.instants.told(self)
        if holes := self.stepper.holes:
            found |= holes.told()
            if sheet.nozzle_of(self.case):
                found |= sheet.torn(self.case, holes.opened.middle)
        return found

    def warnings(self) -> list[str]:
        cut = self.stepper.openings.cut if self.stepper.openings else 0
        ends = "were cut off the sheet one domain's length beyond its end: enlarge domain.size_m"
        left = ", ".join(self.case.method.left_out)
        told = f"left out, as moving particles do without it or cannot have it: {left}"
        found = [told] * bool(left) + [f"{cut} particles {ends}"] * bool(cut) + sheet.untold(self.case)
        return found + pieces.coarse(self.diameters, self.counts)

    def inside(self):
        """State of the liquid, of which each process has a part."""
        return particles.take(self.state, self.stepper.active)
