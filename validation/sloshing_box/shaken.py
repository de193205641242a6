"""A tank shaken sideways off its first period, against the level measured near its wall (Faltinsen, Rognebakke,
Lukovsky & Timokha 2000, J. Fluid Mech. 407, 201, figure 7) and against an ideal liquid (`waves.py`).

Numerics are those of the scene, its sound speed again ten times sqrt(g h). The tank moves by A cos(w t), from rest.
"""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np

from sdph.engine.state import LIQUID
from sdph.study.compare import check

from .waves import level

HERE = Path(__file__).parent
LENGTH, DEPTH, HEIGHT, AMPLITUDE, PERIOD, G = (
    1.73,
    0.6,
    1.15,
    0.032,
    1.3,
    9.81,
)  # m, m, m, m, s, m/s2: head of the record
PLACE, REACH = 0.05, 0.05  # m from the wall: head of the record; to both sides, of the mean level: our choice
HIGH, HALF, FIRM = 0.06, 0.6, 4  # m, s: what is a crest; those that the theory has within 1 %
OFF, LIKE = 0.1, 0.95  # bars of the crests and of the correlation; our choice
SPACINGS = tuple(1e3 * LENGTH / n for n in (43, 87, 173))  # mm


def overrides(spacing: float) -> tuple[str, ...]:
    """Keys by which the scene becomes the tank, at a spacing [mm]."""
    omega = 2.0 * math.pi / PERIOD
    return (
        "run.end_time_s=10.0",
        "run.output_interval_s=0.04",
        f"domain.size_m=[{LENGTH}, {HEIGHT}]",
        f"resolution.spacing_mm={spacing}",
        f"liquid.sound_speed_m_s={10.0 * math.sqrt(G * DEPTH)!r}",
        f"frame={{shake=[[0, {AMPLITUDE}, {omega!r}, {0.5 * math.pi!r}]]}}",
        f"pools.water={{shape='box', lower_m=[0.0, 0.0], upper_m=[{LENGTH}, {DEPTH}]}}",
    )


def record() -> np.ndarray:
    """Times [s] and levels over the one at rest [m] of faltinsen_2000.csv, (2, rows)."""
    with open(HERE / "faltinsen_2000.csv", encoding="utf-8") as file:
        _, *rows = csv.reader(line for line in file if not line.startswith("#"))
    return np.array(rows, dtype=float).T


def theory(end) -> tuple[np.ndarray, np.ndarray]:
    """Times [s] and levels [m] at PLACE of an ideal liquid."""
    omega = 2.0 * math.pi / PERIOD
    return level(LENGTH, DEPTH, G, lambda t: -AMPLITUDE * omega**2 * math.cos(omega * t), end, PLACE)


def levels(run) -> tuple[np.ndarray, np.ndarray]:
    """Times [s] of the outputs and the mean level [m] within REACH of PLACE, over the one at rest."""
    case, dx = run.case, run.case.resolution.spacing
    times = np.arange(0.0, run.summary["time_s"] + 1e-9, case.run.output_interval)
    found = np.empty(len(times))
    for k, time in enumerate(times):
        _, particles, _ = run.fields(time)
        liquid = particles["kind"] == LIQUID
        inside = np.clip((REACH + 0.5 * dx - np.abs(particles.points[liquid, 0] - PLACE)) / dx, 0.0, 1.0)
        found[k] = particles["mass"][liquid] @ inside / case.liquid.density / (2.0 * REACH)
    return times, found - found[0]


def crests(times, level, about) -> np.ndarray:
    """The largest level within a quarter of a period of each of the times `about` [s]."""
    return np.array([level[np.abs(times - each) <= 0.25 * PERIOD].max() for each in about])


def checks(run) -> list[dict]:
    """Crests of the level over those of an ideal liquid and over what was measured, and its course."""
    (when, known), (times, ours) = record(), levels(run)
    ideal = theory(times[-1])
    _figure(run, (when, known), (times, ours), ideal)
    crest = [known[k] == known[np.abs(when - when[k]) < HALF].max() > HIGH for k in range(len(when))]
    about = when[crest & (when <= times[-1] - 0.25 * PERIOD)]
    own, measured, potential = (crests(*of, about) for of in ((times, ours), (when, known), ideal))
    for name, of in (("measured", measured), ("ideal liquid", potential)):
        print(f"crests over those of {name}: " + ", ".join(f"{one:.3f}" for one in own / of))
    seen = np.interp(when, times, ours)
    return [
        check("first four crests over those of an ideal liquid, mean", (own / potential)[:FIRM].mean(), 1.0, OFF),
        check("the worst of them", (own / potential)[:FIRM].min(), 1.0, OFF),
        check("crests over the measured, mean", (own / measured).mean(), 1.0, OFF),
        check("correlation with the measured level", np.corrcoef(seen, known)[0, 1], 1.0, 1.0 - LIKE),
    ]


def _figure(run, measured, ours, ideal) -> None:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    drawn, axes = pyplot.subplots(figsize=(7.5, 3.2), constrained_layout=True)
    axes.plot(measured[0], 100.0 * measured[1], "k.-", ms=3, lw=0.7, label="measured")
    axes.plot(ideal[0], 100.0 * ideal[1], "0.6", lw=1, label="ideal liquid")
    axes.plot(ours[0], 100.0 * ours[1], "C3", lw=1.2, label=f"SDPH, {1e3 * run.case.resolution.spacing:.3g} mm")
    axes.set(
        xlabel="t [s]", ylabel=f"level {100.0 * PLACE:g} cm from the wall [cm]", xlim=(0.0, ours[0][-1]), ylim=(-16, 26)
    )
    axes.legend(fontsize=8, ncol=3, loc="upper center")
    drawn.savefig(run.folder / "shaken.png", dpi=90)
    pyplot.close(drawn)
