"""Levitated water drops of 44 and 57 um in dry air at rest, Taflin et al. 1988: rate at which the square of the
diameter falls, from runs."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from sdph.study.compare import check

from . import lone_drops, measured

BAR = 0.08  # of K (head of the data)
AIR = {"43.9um_20C": 20.0, "56.6um_10C": 10.0}  # C; the drop begins as warm, and is at its wet bulb in 10 ms
MICRO = 1e6  # um in a m


def checks(folder: Path, overrides=(), reporter=None, laws=lone_drops.LAWS) -> list[dict]:
    """K of each law and drop."""
    rows, told, ours = measured.table("taflin_1988"), [], {}
    for law in laws:
        for name in AIR:
            times, squares = _measured(rows, name)
            own = drop(name, rows)
            ours[law, name] = lone_drops.course(own, law, folder / f"micro-{law}-{name}", overrides, reporter)
            scale = (MICRO * own.diameter) ** 2
            found, K = (scale * lone_drops.slope(*curve) for curve in ((times, squares), ours[law, name][:2]))
            told.append(check(f"micrometric drop, {law}, {name}: K [um2/s]", K, found, BAR, True))
    _figure(folder / "micro_drops.png", rows, ours)
    return told


def _measured(rows, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Times [s] and squares over the first."""
    own = rows[rows["case"] == name]
    return own["t_s"], (own["d_um"] / own["d_um"][0]) ** 2


def drop(name: str, rows) -> lone_drops.Drop:
    own, air = rows[rows["case"] == name], AIR[name] + lone_drops.ICE
    return lone_drops.Drop("water", "air", float(own["d_um"][0]) / MICRO, air, air, float(own["t_s"][-1]))


def _figure(file: Path, rows, ours) -> None:
    with measured.figure(file, "t [s]", "(d/d_0)^2 [-]") as axes:
        for colour, name in zip(("C0", "C1"), AIR):
            axes.plot(*_measured(rows, name), "o", ms=4, c=colour, label=f"measured, {name}")
            for law, style in (("linear", "--"), ("spalding", "-")):
                if (law, name) in ours:
                    axes.plot(*ours[law, name][:2], style, c=colour, lw=1)
        for law, style in (("linear", "k--"), ("spalding", "k-")):
            axes.plot([], [], style, lw=1, label=f"SDPH, {law}")
