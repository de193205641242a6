"""Order of convergence of the bubbling bed in the window and in the spacing, by three runs each (Richardson).

    python validation/bubbling_bed/convergence.py [END_S]

Coarse beds (20 mm, 10 mm, 5 mm) on the embedded gas, cells twice the spacing; what is followed is the height of the
grains' centroid and the heat that they took. Prints what each run gave, and orders.
"""

from __future__ import annotations

import math
import sys
import tempfile
from pathlib import Path

from coupling.embedded import EmbeddedGas
from sdph import effects, scenes
from sdph.case import read as cases
from sdph.engine.ledger import Ledger
from sdph.running.simulation import Simulation

END = 0.05  # s, when the bubble has begun to grow
SPACINGS = (20.0, 10.0, 5.0)  # mm
WINDOWS = (8e-4, 4e-4, 2e-4)  # s
COARSE = 10.0  # mm, spacing of the runs in the window


def run(end: float, spacing: float, window: float) -> dict[str, float]:
    """Rise of the centroid [m] and heat taken [J/m] by the bed at `end`."""
    overrides = (
        f"run.end_time_s={end}", f"run.output_interval_s={end}", "track.particles=[]",
        f"resolution.spacing_mm={spacing}", f"resolution.cell_mm={2.0 * spacing}",
        "domain.size_m=[0.48,0.96]", "particles.bed.upper_m=[0.48,0.48]", "boundaries.jet.span_m=[0.2,0.28]",
        "boundaries.jet.velocity_m_s=[0.0,1.875]", f"coupling.window_largest_s={window}",
        "coupling.window_tolerance=1e30", "coupling.courant=1e30",
    )  # fmt: skip
    case = cases.load(scenes.HERE / "bubbling_bed" / "case.toml", overrides)
    gas = EmbeddedGas(case)
    with tempfile.TemporaryDirectory() as folder:
        simulation = Simulation(
            case, gas, Ledger(Path(folder) / "ledger.csv", case, gas.mesh.depth, *effects.in_ledger(case))
        )
        simulation.start()
        before = simulation.state.y.mean()
        while simulation.time < end:
            simulation.window()
        simulation.ledger.table.close()
        heat = simulation.ledger.sums["heat_to_particles_J"]
    return {"rise_m": float(simulation.state.y.mean() - before), "heat_J_per_m": heat}


def order(coarse: float, middle: float, fine: float) -> float:
    """p of an error that halves 2^p-fold; nan where the differences change sign."""
    ratio = (coarse - middle) / (middle - fine) if middle != fine else math.nan
    return math.log2(ratio) if ratio > 0.0 else math.nan


def main(end: float) -> None:
    series = {
        "window [s]": [(w, run(end, COARSE, w)) for w in WINDOWS],
        "spacing [mm]": [(s, run(end, s, WINDOWS[-1])) for s in SPACINGS],
    }
    for name, rows in series.items():
        for value, found in rows:
            print(f"{name} {value:g}:", ", ".join(f"{key} {number:.6g}" for key, number in found.items()))
        for key in rows[0][1]:
            print(f"  order in {name.split()[0]} of {key}: {order(*(found[key] for _, found in rows)):.2f}")


if __name__ == "__main__":
    main(float(sys.argv[1]) if len(sys.argv) > 1 else END)
