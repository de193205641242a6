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
    """Particles of both runs from the side, by temperature and by size, and the vapour in the middle."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(2, 3, figsize=(9, 12), constrained_layout=True)
    for row, (name, run) in zip(axes, runs.items()):
        _, particles, gas = run.fields(run.summary["time_s"])
        x, z = 1e3 * particles.points[:, 0], 1e3 * particles.points[:, 2]
        panels = (1e6 * particles["diameter"], "mean diameter [um]", "viridis"), (
            particles["temperature"], "droplets [K]", "inferno",
        )  # fmt: skip
        for panel, (values, label, colours) in zip(row, panels):
            dots = panel.scatter(x, z, c=values, s=5, cmap=colours)
            figure.colorbar(dots, ax=panel, label=label, shrink=0.6)
        centres = gas.cell_centers().points
        planes = np.unique(np.round(centres[:, 1], 9))
        near = np.abs(centres[:, 1] - planes[len(planes) // 2]) < 1e-6
        vapour = row[2].tripcolor(1e3 * centres[near, 0], 1e3 * centres[near, 2], gas["vapour_mass_fraction"][near])
        figure.colorbar(vapour, ax=row[2], label="vapour mass fraction", shrink=0.6)
        for panel in row:
            size = run.case.domain.size
            panel.set(xlim=(0, 1e3 * size[0]), ylim=(0, 1e3 * size[2]), aspect="equal", title=LABELS[name])
    figure.savefig(file, dpi=80)
    pyplot.close(figure)


if __name__ == "__main__":
    main(Path(sys.argv[1]), tuple(sys.argv[2:]))
