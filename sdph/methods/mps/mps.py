"""A liquid of moving particles, as a run needs it (sdph.methods.method.Method): stepper, ledger, pieces that left."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from sdph.engine import state as particles
from sdph.engine.kept import GROWING
from sdph.engine.state import LIQUID
from sdph.engine.stepped import Stepped
from sdph.engine.table import Table
from sdph.methods.mps import pieces, sheet
from sdph.methods.mps.method import MpsStepper
from sdph.methods.mps.totals import MpsLedger

RESOLVED = 10  # particles of a piece whose size is told by more than one spacing; swirl-sheet.md, section 7


class Mps(Stepped):
    """An incompressible liquid and what it does in a window."""

    matter = "liquid"
    # see sdph.engine.kept
    KEPT = ("windows", "stepper", "ledger", "drops", "diameters", "counts")
    FORMS = {"diameters": GROWING, "counts": GROWING}

    def __init__(self, case, ledger: Path, shortest: float):
        self.case, self.windows = case, 0
        self.stepper, self.ledger = MpsStepper(case, shortest), MpsLedger(ledger)
        self.drops = Table(ledger.with_name("droplets.csv"))  # pieces that have left
        self.diameters, self.counts = np.zeros(0), np.zeros(0)  # [m] and particles of each

    def tables(self) -> list:
        """Files that grow by rows."""
        return [self.ledger.table, self.drops]

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
        """Nothing: no column is a mean since the last row."""

    def row(self) -> dict[str, float]:
        """Columns of history.csv."""
        s = self._inside()
        size = particles.lengths(particles.velocities(s))
        pressure = self.stepper.gauge[self.state.kind == LIQUID]
        return {
            "time_s": self.time, "particles": len(s.x), "mass_kg": float(s.mass.sum()),
            "kinetic_energy_J": particles.energy_of_motion(s), "fastest_m_s": float(size.max(initial=0.0)),
            "pressure_largest_Pa": float(pressure.max(initial=0.0)),
            "number_density_largest_rel": float(self.stepper.number.max(initial=0.0) / self.stepper.cloud.number),
            "left": self._left,
        } | {
            f"largest_{a}_m": float(getattr(s, a).max(initial=0.0)) for a in "xyz"[: self.case.dimensions]
        }  # fmt: skip

    def held(self) -> dict[str, float]:
        """Share of the particles whose pressure would be below 0, where none is, now."""
        inside = self.state.kind == LIQUID
        return {
            "pressure_at_least_share": float((self.stepper.pressure[inside] == 0.0).mean()) if inside.any() else 0.0
        }

    def points(self):
        import pyvista

        inside = self.state.kind == LIQUID
        cloud = pyvista.PolyData(particles.positions(self.state)[inside])
        if inside.any():  # pyvista knows no empty arrays
            cloud["velocity"] = particles.velocities(self.state)[inside]
            cloud["pressure"] = self.stepper.gauge[inside]
            for name in ("ident", "kind", "mass", "density"):
                cloud[name] = getattr(self.state, name)[inside]
            cloud["piece"] = pieces.labels(cloud.points, self.case.method.piece * self.case.resolution.spacing)
        return cloud

    def walls(self):
        return None

    def summary(self) -> dict[str, float]:
        opening = self.stepper.openings
        found = {
            "liquid_particles": int((self.state.kind == LIQUID).sum()),
            "kinetic_energy_J": particles.energy_of_motion(self._inside()),
            "poisson_iterations_mean": self.stepper.iterations / max(1, self.steps),
            "pressure_clipped_Pa": self.stepper.clipped / max(1, self.steps) / max(1, len(self.state.x)),
        }
        if opening and opening.leave:
            whole = self.counts >= RESOLVED
            found |= {"droplets": opening.left, "droplets_resolved": int(whole.sum()), "cut_particles": opening.cut}
            found |= pieces.sizes(self.diameters, whole)
        if sheet.nozzle_of(self.case):
            found |= sheet.told(self.case, particles.positions(self._inside()))
        return found

    def warnings(self) -> list[str]:
        cut = self.stepper.openings.cut if self.stepper.openings else 0
        if not cut:
            return []
        return [f"{cut} particles were cut off the sheet one domain's length beyond its end: enlarge domain.size_m"]

    def _inside(self):
        return particles.take(self.state, self.state.kind == LIQUID)

    @property
    def _left(self) -> int:
        return self.stepper.openings.left if self.stepper.openings else 0
