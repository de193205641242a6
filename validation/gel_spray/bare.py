"""The spray with shells that burst and without: `python validation/gel_spray/bare.py FOLDER [key=value ...]`.

Without the effect droplets are bare: they evaporate by the d^2 law from the start. Prints what has evaporated of what
came in, sizes and temperatures, and draws both sprays (spray.png).
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from sdph import scenes
from sdph.case import read as cases
from sdph.running import driver
from sdph.running.progress import Reporter
from sdph.study import compare

TOLD = ("evaporated_kg", "thrown_kg", "injected_kg", "grain_temperature_max_K", "gas_temperature_min_K")
LEAST = 1e-3  # of a particle's mass
SHOWN = (
    ("diameter", "mean diameter [um]", 1e6, "viridis", (10.0, 75.0)),
    ("temperature", "droplets [K]", 1.0, "inferno", (300.0, 580.0)),
)
LABELS = {"bursting": "shells that burst", "bare": "bare droplets"}


def cases_of(overrides: tuple[str, ...]) -> dict[str, cases.Case]:
    """The case of the scene, and the same without shells."""
    table = cases.parsed(scenes.find("gel_spray")[1])
    table["coupling"]["gas"] = "embedded"
    for text in overrides:
        cases.put(table, text)
    found = {"bursting": cases.from_table(table)}
    del table["micro_explosion"]
    table["effects"].remove("micro_explosion")
    table["run"]["metrics"] = ["jet"]
    return found | {"bare": cases.from_table(table)}


def main(folder: Path, overrides: tuple[str, ...]) -> None:
    runs = {}
    for name, case in cases_of(overrides).items():
        if not (folder / name / "summary.json").is_file():
            driver.run(case, "gel_spray", folder / name, None, Reporter())
        runs[name] = compare.open_run(folder / name)
        own = runs[name].summary
        print(name, {key: own[key] for key in TOLD if key in own})
        print(name, "evaporated share", own["evaporated_kg"] / own["injected_kg"])
    draw(runs, folder / "spray.png")


def draw(runs, file: Path) -> None:
    """Particles of both runs from the side, by size and by temperature, and the vapour in the middle; those with less
    than a thousandth of their mass are left out."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(3, 2, figsize=(13, 9), constrained_layout=True)
    for column, (name, run) in zip(axes.T, runs.items()):
        _, particles, gas = run.fields(run.summary["time_s"])
        left = particles["mass"] > LEAST * particles["mass"].max()
        width, length = 1e3 * run.case.domain.size[0], 1e3 * run.case.domain.size[2]
        along, aside = length - 1e3 * particles.points[left, 2], 1e3 * particles.points[left, 0]
        for panel, (key, label, factor, colours, ends) in zip(column, SHOWN):
            dots = panel.scatter(
                along, aside, c=factor * particles[key][left], s=7, cmap=colours, vmin=ends[0], vmax=ends[1]
            )
            figure.colorbar(dots, ax=panel, label=label)
        centres = gas.cell_centers().points
        planes = np.unique(np.round(centres[:, 1], 9))
        near = np.abs(centres[:, 1] - planes[len(planes) // 2]) < 1e-6
        shown = length - 1e3 * centres[near, 2], 1e3 * centres[near, 0], gas["vapour_mass_fraction"][near]
        filled = column[2].tricontourf(*shown, levels=np.linspace(0.0, 0.12, 13))
        figure.colorbar(filled, ax=column[2], label="vapour mass fraction")
        for panel in column:
            panel.set(xlim=(0, length), ylim=(0, width), aspect="equal", title=LABELS[name])
            panel.set(xlabel="from the nozzle [mm]", ylabel="x [mm]")
    figure.savefig(file, dpi=75)
    pyplot.close(figure)


if __name__ == "__main__":
    main(Path(sys.argv[1]), tuple(sys.argv[2:]))
