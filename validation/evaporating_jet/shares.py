"""Worth of each difference between the two models: the jet with one model switched at a time, and all of them.

    python validation/evaporating_jet/shares.py FOLDER [--gas openfoam]

makes a run of each in FOLDER and prints the evaporated mass, and its change from the case as it is.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from sdph import scenes
from sdph.case import read as cases
from sdph.running import driver
from sdph.running.progress import Reporter
from sdph.study import compare

SWITCHES = {
    "as it is (Gunn, Gidaspow, voidage)": (),
    "Ranz-Marshall for Gunn": ("heat.law='ranz_marshall'",),
    "one-sphere drag for Gidaspow": ("drag.law='schiller_naumann'",),
    "gas that ignores the liquid's volume": ("coupling.voidage=false",),
    "gas around a droplet as in its film": ("coupling.film=true",),
    "Spalding's law for the linear one": ("evaporation.law='spalding'",),
}
ALIKE = compare.scene_module("evaporating_jet").VARIANTS["closures alike"][0]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--gas", choices=("openfoam", "embedded"), default="embedded")
    parser.add_argument("--until", type=float, default=0.2, metavar="T", help="end time [s]")
    options = parser.parse_args()
    base = (f"coupling.gas='{options.gas}'", f"run.end_time_s={options.until}")
    first = None
    for number, (name, switched) in enumerate((SWITCHES | {"closures alike": ALIKE}).items()):
        case = cases.load(scenes.find("evaporating_jet")[1], (*base, *switched))
        summary = driver.run(case, "evaporating_jet", options.folder / str(number), None, Reporter(quiet=True))
        first = first or summary["evaporated_kg"]
        columns = f"{1e3 * summary['evaporated_kg']:8.4f} g  {100 * (summary['evaporated_kg'] / first - 1):+7.2f} %"
        print(
            f"{name:40s} {columns}  Y_max {summary['vapour_mass_fraction_max']:.4f}  front {summary['front_m']:.4f} m",
            flush=True,
        )


if __name__ == "__main__":
    main()
