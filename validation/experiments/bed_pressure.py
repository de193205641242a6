"""Pressure drop of fluidised beds of glass beads, Toomey & Johnstone 1952, from runs of the scene fluidised_column with
their beads.

Which of the 41 are run was settled before their results, after runs of 0.2 s for their cost: of each bead the lowest
and the highest velocity, without those of 106 and 55 um, which take many minutes each. Drag is `gidaspow`, Ergun's
where grains are dense as in the scene, Wen & Yu's in bubbles. The bed holds the measured mass at the alpha_p of the
scene.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from sdph import scenes
from sdph.case import read as cases
from sdph.study import compare

from . import measured

BAR = 0.02  # of the pressure drop (README.md)
BEADS = {1: (848e-6, 175.0), 2: (376e-6, 179.0), 3: (219e-6, 178.0)}  # m, lb/ft3 (head of the data)
POUND_FOOT = 16.018463  # kg/m3 in a lb/ft3
AIR = 1.2, 1.8e-5  # kg/m3 (head of the data), Pa s at 293 K
STAGE = 3.0  # s, means are over the latter half; our choice
ROOM = 4.0  # height of the column over that of the bed; grains that get there are carried off (`outflow`); our choice
CELL = 0.01  # m, of the scene


def picked(rows, bead: int):
    """Rows of a bead with the lowest and the highest velocity."""
    own = rows[rows["bead"] == bead]
    own = own[np.argsort(own["U_m_s"], kind="stable")]
    return own[[0, -1]]


def checks(folder: Path, overrides=(), reporter=None, beads=tuple(BEADS)) -> list[dict]:
    """Mean pressure drop of each run against what was measured and against the weight of the grains."""
    chosen = [row for bead in beads for row in picked(measured.table("toomey_johnstone_1952"), bead)]
    found = [run(row, overrides) for row in chosen]
    _figure(folder / "bed_pressure.png", chosen, found)
    told = []
    for row, mean in zip(chosen, found):
        name = f"bed of beads of {1e6 * BEADS[int(row['bead'])][0]:g} um at {row['U_m_s']:.3g} m/s"
        drop = mean["pressure_drop_Pa"]
        told += [
            compare.check(f"{name}: pressure drop [Pa]", drop, row["dP_mf_Pa"], BAR, True),
            compare.check(f"{name}: pressure drop, weight [Pa]", drop, mean["weight_Pa"], BAR, True),
        ]
    return told


def run(row, overrides) -> dict[str, float]:
    """Means of the scene's metrics (`column`) over the latter half of a run."""
    case = cases.load(scenes.find("fluidised_column")[1], (*given(row), *overrides))
    ((_, mean),) = zip((0,), compare.scene_module("fluidised_column").stages(case, (float(row["U_m_s"]),), STAGE))
    return mean


def given(row) -> list[str]:
    """Overrides of the scene for a row."""
    diameter, density = BEADS[int(row["bead"])][0], POUND_FOOT * BEADS[int(row["bead"])][1]
    scene = cases.load(scenes.find("fluidised_column")[1])
    packed, width = scene.particles["bed"].volume_fraction, scene.domain.size[0]
    height = float(row["dP_mf_Pa"]) / (packed * (density - AIR[0]) * measured.GRAVITY)
    top = CELL * round(ROOM * height / CELL)
    return [
        "coupling.gas='embedded'",
        f"effects={[*scene.effects, 'outflow']!r}",
        "drag.law='gidaspow'",
        f"domain.size_m=[{width!r}, {top!r}]",
        f"particles.bed.upper_m=[{width!r}, {height!r}]",
        f"gas.density_kg_m3={AIR[0]}",
        f"gas.viscosity_Pa_s={AIR[1]}",
        f"grains.density_kg_m3={density!r}",
        f"grains.diameter_mm={1e3 * diameter!r}",
    ]


def _figure(file: Path, rows, found) -> None:
    with measured.figure(file, "superficial velocity [m/s]", "pressure drop over measured [-]") as axes:
        for bead, (diameter, _) in BEADS.items():
            own = [(row["U_m_s"], mean["pressure_drop_Pa"] / row["dP_mf_Pa"]) for row, mean in zip(rows, found)
                   if row["bead"] == bead]  # fmt: skip
            axes.semilogx(*np.array(own).reshape(-1, 2).T, "o", mfc="none", label=f"beads of {1e6 * diameter:g} um")
        axes.axhline(1.0, c="k", lw=1, label="as measured, and 2 % either way")
        for share in (1.0 - BAR, 1.0 + BAR):
            axes.axhline(share, c="k", ls=":", lw=1)
        axes.set_ylim(0.0, 1.2)
