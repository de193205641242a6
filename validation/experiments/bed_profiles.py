"""Voidage and vertical velocity of the grains across a bubbling bed of poppy seeds, seen by magnetic resonance (Mueller
et al. 2008, 2009), from runs in three dimensions and, beside them, in two; of each the mean over several that differ by
how their lattice was drawn at random, as one run of this bed differs from the next by more than the bars.

What is settled, before any result: grains and gas are those of the head of the data. Seeds rub each other (0.1 there),
and kinetic theory knows smooth grains, so their restitution is that of `granular_piles.alone`. They rub all walls as
much (`walls.friction`). They begin at the onset of lasting contacts, off their lattice by chance, so that the bed has
no mirror. Cells are three grains wide, the finest that `sdph explain` calls safe, and particles two grains, which 11 s
of can be borne. Everything else is as it comes.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np

from sdph.case import read as cases
from sdph.running import driver
from sdph.study import sampling
from sdph.study.compare import check

from . import measured

VOIDAGE, SPEED, SHARE = 0.05, 0.05, 0.30  # bars: -, m/s, or that share of the speed where it is more (head of table)
SIZE = (0.044, 0.12, 0.01)  # m: across, up, through (head of the data)
HIGHER = 0.24  # m: up in two dimensions, where the first slug throws grains out at 0.12 m; our choice
SEEDS, DIAMETER, DENSITY = 9240, 1.2e-3, 1000.0  # -, m, kg/m3
RESTITUTION, RUBBING = 0.98, 0.1  # -
AIR = 1.2, 1.8e-5  # kg/m3, Pa s
BLOWN = 0.9  # m/s
PACKED = 0.6  # the default onset of friction
SPACING, CELL = 2.0 * DIAMETER, 3.0 * DIAMETER  # m
BEGIN, END, EVERY = 1.0, 11.0, 0.02  # s: means are from the first to the second, of outputs so far apart; our choice
DRAWN = 1, 2, 3  # seeds of the chance that grains stand off their lattice by; as many runs as time bears, our choice
EFFECTS = (
    "drag", "gas_pressure", "gravity", "granular_pressure", "friction", "granular_viscosity", "granular_temperature",
    "artificial_viscosity", "walls",
)  # fmt: skip
QUANTITIES = {"voidage": "voidage [-]", "uy_particle": "velocity of the grains, up [m/s]"}


class Profile(NamedTuple):
    """Places x (P,) [m] on the left half; values there, the mean of both halves, as measured; and `lean`, half of what
    the right one has more, which this mean does not see: a vortex that turns one way has nothing else."""

    x: np.ndarray
    values: np.ndarray
    lean: np.ndarray


def case(dimensions: int, end: float = END, spacing: float = SPACING, drawn: int = DRAWN[0]):
    """The bed with as many dimensions, until `end` [s]; `drawn` is the seed of its chance."""
    size = SIZE if dimensions == 3 else (SIZE[0], HIGHER)
    solid = SEEDS * math.pi / 6.0 * DIAMETER**3
    height = solid / (PACKED * SIZE[0] * SIZE[2])
    inlet = {"kind": "velocity_inlet", "side": "bottom", "velocity_m_s": [0.0, BLOWN, 0.0][:dimensions]}
    outlet = {"kind": "pressure_outlet", "side": "top", "pressure_Pa": 0.0}
    return cases.from_table({
        "title": "Bed of poppy seeds", "dimensions": dimensions, "effects": list(EFFECTS),
        "run": {"end_time_s": end, "output_interval_s": min(EVERY, end), "metrics": ["column"]},
        "domain": {"size_m": list(size), "gravity_m_s2": [0.0, -measured.GRAVITY, 0.0][:dimensions]},
        "resolution": {"spacing_mm": 1e3 * spacing, "cell_mm": 1e3 * CELL},
        "gas": {"density_kg_m3": AIR[0], "viscosity_Pa_s": AIR[1], "temperature_K": 293.0,
                "conductivity_W_m_K": 0.0256, "heat_capacity_J_kg_K": 1006.0},  # no heat is exchanged
        "grains": {"density_kg_m3": DENSITY, "diameter_mm": 1e3 * DIAMETER, "restitution": restitution(),
                   "heat_capacity_J_kg_K": 1000.0, "conductivity_W_m_K": 0.2},
        "particles": {"bed": {"shape": "box", "lower_m": [0.0] * dimensions,
                              "upper_m": [size[0], height, *size[2:]], "volume_fraction": PACKED,
                              "temperature_K": 293.0, "disorder": 0.1, "seed": drawn}},
        "boundaries": {"distributor": inlet, "outlet": outlet, "walls": {"kind": "wall"}},
        "walls": {"friction": RUBBING},
        "coupling": {"gas": "embedded"},
    })  # fmt: skip


def restitution() -> float:
    """Restitution of smooth grains that lose as much as seeds that rub: validation/granular_piles/alone.py."""
    return RESTITUTION - 1.5 * RUBBING * math.exp(-3.0 * RUBBING)


def checks(folder: Path, overrides=(), reporter=None, end: float = END) -> list[dict]:
    """Means of the profiles of all runs against what was measured."""
    told, shown = [], {}
    for dimensions in (3, 2):
        parts = shown[dimensions] = []
        for drawn in DRAWN:
            own = folder / f"bed-profiles-{dimensions}d-{drawn}"
            driver.run(case(dimensions, end, drawn=drawn), "", own, None, reporter)
            parts.append(means(own, BEGIN, end))
        told += against(of_all(parts), f"bed of seeds, {dimensions}-D, {len(DRAWN)} runs")
    _figure(folder / "bed_profiles.png", shown)
    return told


def means(folder: Path, begin: float, end: float) -> dict[tuple[str, float], Profile]:
    """Profiles of a run, by quantity and height, of the mean over the time from `begin` to `end` [s]."""
    return profiles(sampling.averages(folder, begin, end, None))


def of_all(parts: list[dict]) -> dict[tuple[str, float], Profile]:
    """Means of the profiles of several runs."""
    return {key: Profile(*np.mean([own[key] for own in parts], axis=0)) for key in parts[0]}


def profiles(averages) -> dict[tuple[str, float], Profile]:
    """Ours at the heights and places of what was measured: through the depth, of both halves; voidage of the gas's
    cells, which know where walls are, velocity of the particles."""
    grid, gas = averages.particles, averages.gas
    cells, up = _layers(gas.cell_centers().points, np.asarray(gas.cell_data["alpha_p_mean"]))
    points, moving = _layers(np.asarray(grid.points), np.asarray(grid["velocity_mean"])[:, 1])
    known = {"voidage": (cells, 1.0 - up), "uy_particle": (points, moving)}
    return {(name, y): Profile(own.x, *_both(own.x, *_row(*known[name], y))) for (name, y), own in found().items()}


def _layers(places, values):
    """Axes (x, y) [m] and means (nx, ny) through the depth of values on a regular grid, of what is inside the box."""
    box = np.array((SIZE[0], HIGHER, SIZE[2]))
    inside = np.all((places >= 0.0) & (places <= box), axis=1) & np.isfinite(values)
    axes = [np.unique(places[:, a].round(9)) for a in (0, 1)]
    at = tuple(np.searchsorted(axis, places[inside, a].round(9)) for a, axis in enumerate(axes))
    sums, counts = np.zeros([len(axis) for axis in axes]), np.zeros([len(axis) for axis in axes])
    np.add.at(sums, at, values[inside])
    np.add.at(counts, at, 1.0)
    return axes, np.divide(sums, counts, out=np.full_like(sums, np.nan), where=counts > 0.0)


def _row(axes, values, y: float):
    """Places [m] and values of a row at height y [m]: linear between the rows below and above."""
    row = np.array([np.interp(y, axes[1][np.isfinite(own)], own[np.isfinite(own)]) for own in values
                    if np.isfinite(own).any()])  # fmt: skip
    return axes[0][np.isfinite(values).any(axis=1)], row


def _both(x, places, values) -> tuple[np.ndarray, np.ndarray]:
    """Mean at x (P,) [m] from the left and from the right wall, and half of what the right has more."""
    left, right = (np.interp(at, places, values) for at in (x, SIZE[0] - x))
    return 0.5 * (left + right), 0.5 * (right - left)


def found() -> dict[tuple[str, float], Profile]:
    """Measured profiles, by quantity and height [m], at the places of the left half: the mean of both halves, of the
    left alone where the right one was not measured as near to its wall."""
    rows, told = measured.table("mueller_2009"), {}
    for name in QUANTITIES:
        for y in np.unique(rows["y_m"][rows["quantity"] == name]):
            own = rows[(rows["quantity"] == name) & (rows["y_m"] == y)]
            left = own["x_m"][own["x_m"] < 0.5 * SIZE[0]]
            halves = [np.interp(x, own["x_m"], own["value"], np.nan, np.nan) for x in (left, SIZE[0] - left)]
            told[name, float(y)] = Profile(left, np.nanmean(halves, axis=0), 0.5 * (halves[1] - halves[0]))
    return told


def against(own, name: str) -> list[dict]:
    """Two checks of each profile in its bars: root mean square and the place farthest off."""
    told, known = [], found()
    for key in known:
        off = (own[key].values - known[key].values) / _bars(key)
        where = f"{name}, {key[0]} at {1e3 * key[1]:g} mm"
        told += [
            check(f"{where}: rms off, {len(off)} places, in bars [-]", np.sqrt(np.mean(off**2)), 0.0, 1.0),
            check(f"{where}: farthest, in bars [-]", off[np.argmax(np.abs(off))], 0.0, 1.0),
        ]
    return told


def _bars(key):
    """Bars at the places of a profile, in its unit."""
    return np.maximum(SPEED, SHARE * np.abs(found()[key].values)) if key[0] == "uy_particle" else VOIDAGE


def doubt(parts, key) -> float:
    """Standard error of the mean of several runs, rms over the places, in bars."""
    spread = np.std([own[key].values for own in parts], axis=0, ddof=1) / _bars(key)
    return float(np.sqrt(np.mean(spread**2) / len(parts)))


def leaning(own, key) -> float:
    """Distance of both halves of the width from their mean, rms in bars."""
    return float(np.sqrt(np.nanmean((own[key].lean / _bars(key)) ** 2)))


def _figure(file: Path, shown) -> None:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    keys, rows = list(found()), measured.table("mueller_2009")
    figure, axes = pyplot.subplots(1, len(keys), figsize=(3.1 * len(keys), 3.6), constrained_layout=True)
    for axis, key in zip(axes, keys):
        own = rows[(rows["quantity"] == key[0]) & (rows["y_m"] == key[1])]
        axis.plot(1e3 * own["x_m"], own["value"], "k.", ms=4, label="measured")
        for dimensions, parts in shown.items():
            whole, label = of_all(parts)[key], f"SDPH, {dimensions}-D, mean of {len(parts)}"
            line = axis.plot(1e3 * whole.x, whole.values, "-", label=label)[0]
            for own in parts:
                axis.plot(1e3 * own[key].x, own[key].values, ":", c=line.get_color(), lw=1)
        doubts = ", ".join(f"{doubt(parts, key):.1f}" for parts in shown.values())
        leans = ", ".join(f"{leaning(of_all(parts), key):.1f}" for parts in shown.values())
        axis.set(xlabel="x [mm]", ylabel=QUANTITIES[key[0]])
        axis.set_title(f"y = {1e3 * key[1]:g} mm\ndoubt {doubts}, lean {leans} bars", fontsize=8)
    axes[0].legend(fontsize=8)
    figure.savefig(file, dpi=80)
    pyplot.close(figure)
