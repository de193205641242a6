"""Ladders of both codes with the closures alike, each setting refined on its own: how far either is from its limit.

    python validation/evaporating_jet/ladder.py FOLDER [--hot] [--until T] [--only WORD ...]

prints a row of each rung: evaporated mass [g] and heat that the droplets took up [kJ] at T. `--hot` is the jet whose
droplets are above the onset from the nozzle on (README.md).
"""

from __future__ import annotations

import argparse
import dataclasses
from pathlib import Path

from sdph import scenes
from sdph.case import read as cases
from sdph.running import driver
from sdph.running.progress import Reporter
from sdph.study import compare

JET = compare.scene_module("evaporating_jet")
DROPLETS = {  # rung -> gas cell [mm], Courant number of the droplets: steps of 0.4, 0.2, 0.1 ms in cells of 50 mm
    "droplets, step 0.4 ms": (50.0, 0.08),
    "droplets": (50.0, 0.04),
    "droplets, step 0.1 ms": (50.0, 0.02),
    "droplets, cells 100 mm": (100.0, 0.02),
    "droplets, cells 25 mm": (25.0, 0.08),
}
OURS = {
    "sdph": (),
    "sdph, window 0.5 ms": ("coupling.window_largest_s=5e-4",),
    "sdph, spacing 50 mm": ("resolution.spacing_mm=50.0",),
    "sdph, spacing 12.5 mm": ("resolution.spacing_mm=12.5",),
    "sdph, cells 100 mm": ("resolution.cell_mm=100.0",),
    "sdph, cells 25 mm": ("resolution.cell_mm=25.0",),
    "sdph, cells and spacing twice": ("resolution.cell_mm=100.0", "resolution.spacing_mm=50.0"),
    "sdph, cells and spacing half": ("resolution.cell_mm=25.0", "resolution.spacing_mm=12.5"),
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--hot", action="store_true")
    parser.add_argument("--until", type=float, default=0.1, metavar="T", help="end time [s]")
    parser.add_argument("--only", nargs="*", metavar="RUNG", help="rungs to run, by their names")
    options = parser.parse_args()
    variant = JET.VARIANTS["hot" if options.hot else "closures alike"][0]
    base = (*variant, f"run.end_time_s={options.until}", "coupling.gas='embedded'")
    for name in options.only or (*DROPLETS, *OURS):
        run = _droplets if name in DROPLETS else _ours
        mass, heat = run(name, base, options.folder / name.replace(" ", "_").replace(",", ""), options.until)
        print(f"{name:32s} {1e3 * mass:9.4f} g {1e-3 * heat:9.4f} kJ", flush=True)


def _case(overrides):
    return cases.load(scenes.find("evaporating_jet")[1], overrides)


def _droplets(name: str, base, folder: Path, until: float) -> tuple[float, float]:
    cell, courant = DROPLETS[name]
    case = _case(base)
    refined = dataclasses.replace(case, resolution=dataclasses.replace(case.resolution, cell=cell * 1e-3))
    found = JET._droplet_run(refined, folder, courant)
    return JET.evaporated_by(found, case, until), JET.heat_of(found, case, until)


def _ours(name: str, base, folder: Path, until: float) -> tuple[float, float]:
    driver.run(_case((*base, *OURS[name])), "evaporating_jet", folder, None, Reporter(quiet=True))
    run = compare.open_run(folder)
    return JET.evaporated(run, until), JET.heat(run, until)


if __name__ == "__main__":
    main()
