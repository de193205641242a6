"""Heat from a staggered bank of tubes to a fluidised bed: its Nusselt number from a run, against a correlation.

Five tubes of the scene bed_with_tube, two, one and two above each other, in a wider bed of the same grains and gas at
the same velocity, in squares and rings of cells as the scene has around its tube. As for one tube (`hot_tube`), heat
from the tubes straight to the gas is not in it.
"""

from __future__ import annotations

import itertools
import math
import shutil
from pathlib import Path

import numpy as np

from coupling.openfoam.programs import installation
from sdph.scenes import paths
from sdph.study import compare

from . import hot_tube, measured

SPEED, END = 0.45, 2.0  # m/s, s: those of the single tube
SQUARE, CELL, RADIUS, AROUND = 0.08, 0.01, 0.5 * hot_tube.TUBE, 4  # m, m, m; cells across a ring: those of the scene
ACROSS = (0.0, 0.04, 0.12, 0.20, 0.28, 0.32)  # m: where blocks meet; a tube's mirror image is a row's pitch away
UP = (0.0, 0.06, 0.14, 0.22, 0.30, 0.80)
TUBES = ((1, 1), (3, 1), (2, 2), (1, 3), (3, 3))  # blocks with one, counted across and up
PITCH = math.sqrt(2.0) * SQUARE  # m, between the nearest axes
HEIGHT = 0.36  # m, of grains at rest: a square above the upper tubes; our choice


def checks(folder: Path, overrides=(), reporter=None, end: float = END) -> list[dict]:
    """The Nusselt number of all tubes against Grewal's law; none without OpenFOAM, which is told."""
    if installation.find() is None:
        if reporter:
            reporter.status("the tube bank is left out: it needs OpenFOAM; get it with: sdph openfoam setup --install")
        return []
    own = run(folder / "tube-bank", overrides, reporter, end)
    reference = grewal(own.case, SPEED, hot_tube.inside(own))
    _figure(folder / "tube_bank.png", own, reference)
    name = f"tube bank, staggered, {len(TUBES)} tubes at {SPEED} m/s, Grewal: Nu [-]"
    return [compare.check(name, hot_tube.number(own), reference, hot_tube.BAR, True)]


def run(folder: Path, overrides, reporter, end: float):
    """The bed around the bank."""
    gas = folder.with_name(f"{folder.name}-gas")
    shutil.copytree(paths.data("openfoam_case_templates") / hot_tube.SCENE / "gas", gas)
    (gas / "system" / "blockMeshDict").write_text(mesh(), encoding="utf-8")
    vessel = f"domain.size_m=[{ACROSS[-1]!r}, {UP[-1]!r}]", f"particles.bed.height_m={HEIGHT!r}"
    return hot_tube.run(SPEED, folder, (*vessel, *overrides), reporter, end, gas)


def grewal(case, speed: float, alpha_p: float) -> float:
    """Nu of a staggered array of tubes: that of a single one times 1 - 0.21 (pitch/D)^-1.75, Grewal 1981, Powder
    Technol. 30, 145."""
    return hot_tube.grewal_saxena(case, speed, alpha_p) * (1.0 - 0.21 * (PITCH / hot_tube.TUBE) ** -1.75)


def mesh() -> str:
    """The blockMeshDict: a lattice of blocks, and rings of four in those with a tube."""
    places = [(x, y) for y in UP for x in ACROSS]
    across, up = len(ACROSS), len(UP)
    numbers = [[round((b - a) / CELL) for a, b in itertools.pairwise(edges)] for edges in (ACROSS, UP)]
    blocks, arcs, tube = [], [], []
    back = len(places) + 4 * len(TUBES)
    for j in range(up - 1):
        for i in range(across - 1):
            corners = [i + j * across, i + 1 + j * across, i + 1 + (j + 1) * across, i + (j + 1) * across]
            if (i, j) not in TUBES:
                blocks.append((corners, numbers[0][i], numbers[1][j]))
                continue
            centre = 0.5 * (ACROSS[i] + ACROSS[i + 1]), 0.5 * (UP[j] + UP[j + 1])
            ring = [len(places) + n for n in range(4)]
            places += [_around(centre, 225.0 + 90.0 * n) for n in range(4)]
            for n in range(4):
                m = (n + 1) % 4
                blocks.append(([corners[n], corners[m], ring[m], ring[n]], numbers[0][i], AROUND))
                arcs.append((ring[n], ring[m], _around(centre, 270.0 + 90.0 * n)))
                tube.append((ring[n], ring[m]))
    sides = [(j * across + i, (j + 1) * across + i) for j in range(up - 1) for i in (0, across - 1)]
    level = {"inlet": 0, "outlet": (up - 1) * across}
    patches = {name: [(first + i, first + i + 1) for i in range(across - 1)] for name, first in level.items()}
    return _text(places, back, blocks, arcs, patches | {"wall": sides, "tube": tube})


def _around(centre: tuple[float, float], angle: float) -> tuple[float, float]:
    """A place on a tube, at an angle [deg]."""
    turned = math.radians(angle)
    return centre[0] + RADIUS * math.cos(turned), centre[1] + RADIUS * math.sin(turned)


def _text(places, back: int, blocks, arcs, patches: dict[str, list[tuple[int, int]]]) -> str:
    """A plane blockMeshDict, its back 1 m away from its front, whose vertices are counted on from `back`."""
    depths = 0.0, 1.0
    lines = [
        "FoamFile { version 2.0; format ascii; class dictionary; object blockMeshDict; }",
        "scale 1;",
        "vertices (",
    ]
    lines += [f"({x!r} {y!r} {z!r})" for z in depths for x, y in places]
    lines += [");", "blocks ("]
    for corners, along, through in blocks:
        eight = " ".join(map(str, [*corners, *(back + corner for corner in corners)]))
        lines.append(f"hex ({eight}) ({along} {through} 1) simpleGrading (1 1 1)")
    lines += [");", "edges ("]
    for side, z in enumerate(depths):
        lines += [f"arc {a + side * back} {b + side * back} ({x!r} {y!r} {z!r})" for a, b, (x, y) in arcs]
    lines += [");", "defaultPatch { name frontAndBack; type empty; }", "boundary ("]
    for name, faces in patches.items():
        kind = "patch" if name in ("inlet", "outlet") else "wall"
        sides = " ".join(f"({a} {b} {back + b} {back + a})" for a, b in faces)
        lines.append(f"{name} {{ type {kind}; faces ({sides}); }}")
    return "\n".join([*lines, ");", ""])


def _figure(file: Path, own, reference: float) -> None:
    """Nu of all tubes over time beside the law's band, and the bed at the end."""
    from matplotlib.patches import Circle

    _, grains, _ = own.fields(own.case.run.end_time)
    places, half = np.asarray(grains.points)[:, :2], (1.0 - hot_tube.BAR, 1.0 + hot_tube.BAR)
    with measured.figure(file, "time [s]", "Nu of the tubes, grains' part [-]") as axes:
        axes.plot(*hot_tube.course(own), "-", c="C0", lw=1, label="SDPH, mean of the five tubes")
        axes.axhline(hot_tube.number(own), c="C0", ls="--", lw=1, label="its mean over the last three fifths")
        axes.axhline(reference, c="k", ls="--", label="Grewal, and 25 % either way")
        axes.axhspan(*(share * reference for share in half), color="0.85")
        axes.set_ylim(0.0, None)
        bed = axes.inset_axes((1.03, 0.0, 0.4, 1.0))
        bed.scatter(*places.T, c=np.asarray(grains["alpha_p"]), s=1, cmap="viridis")
        for i, j in TUBES:
            centre = 0.5 * (ACROSS[i] + ACROSS[i + 1]), 0.5 * (UP[j] + UP[j + 1])
            bed.add_patch(Circle(centre, RADIUS, fc="w", ec="r"))
        bed.set(xlim=(0.0, ACROSS[-1]), ylim=(0.0, UP[-1]), aspect="equal", xticks=(), yticks=())
        bed.set_title(f"grains at {own.case.run.end_time:g} s", fontsize=8)
