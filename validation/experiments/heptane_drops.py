"""Drops of n-heptane in hot nitrogen without weight, Nomura et al. 1996: the rate at which the square of the diameter
falls, from runs."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from sdph.case import fluids
from sdph.study.compare import check

from . import drop_balance, lone_drops, measured

DIAMETER, COLD = 0.7e-3, 300.0  # m, K (head of the data)
PLACES = {(1.0, 471.0): 0.15, (1.0, 741.0): 0.10, (10.0, 466.0): 0.15, (10.0, 765.0): 0.15}  # atm, K: bar of K
FROM, TO = 0.8, 0.2  # squares between which K is taken, as far as they were measured (head of the data)
LONGER = 4.0  # a run goes on so many times as long, or until the drop is gone: it has to come to TO; our choice
SCALE = 1e6 * DIAMETER**2  # s that a s/mm2 stands for


def checks(folder: Path, overrides=(), reporter=None, laws=lone_drops.LAWS, places=tuple(PLACES)) -> list[dict]:
    """K of each law at each pressure and temperature."""
    rows = measured.table("nomura_1996")
    found = {place: rows[(rows["p_atm"] == place[0]) & (rows["T_gas_K"] == place[1])] for place in places}
    ours = {
        (law, place): _course(law, place, found[place], folder, overrides, reporter) for law in laws for place in places
    }
    _figure(folder / "heptane_drops.png", found, ours)
    return [
        check(f"heptane, {law}, {_name(place)}: K [mm2/s]", constant(*curve, _least(found[place])),
              _measured(found[place]), PLACES[place], True)
        for (law, place), curve in ours.items()
    ]  # fmt: skip


def constant(times, squares, least: float) -> float:
    """K = -d(d^2)/dt [mm2/s] of times over d_0^2 [s/mm2] and squares over d_0^2."""
    return lone_drops.slope(times, squares, FROM, least)


def _measured(rows) -> float:
    return constant(rows["t_over_d02_s_mm2"], rows["d2_over_d02"], _least(rows))


def _least(rows) -> float:
    return max(TO, float(rows["d2_over_d02"].min()))


def _course(law: str, place, rows, folder: Path, overrides, reporter):
    """Times over d_0^2 [s/mm2] and squares over d_0^2 of a run."""
    own = folder / f"heptane-{law}-{place[0]:g}-{place[1]:g}"
    times, squares, _ = lone_drops.course(_drop(place, rows), law, own, overrides, reporter, LONGER)
    return times / SCALE, squares


def _drop(place, rows) -> lone_drops.Drop:
    time = SCALE * float(rows["t_over_d02_s_mm2"][-1])
    return lone_drops.Drop("n-Heptane", "nitrogen", DIAMETER, COLD, place[1], time, place[0] * fluids.ATMOSPHERE)


def _name(place) -> str:
    return f"{place[0]:g} atm, {place[1]:g} K"


def _figure(file: Path, found, ours) -> None:
    colours = {place: f"C{k}" for k, place in enumerate(found)}
    with measured.figure(file, "t/d_0^2 [s/mm2]", "(d/d_0)^2 [-]") as axes:
        for place, rows in found.items():
            axes.plot(*np.array([rows["t_over_d02_s_mm2"], rows["d2_over_d02"]]), ".", c=colours[place],
                      label=f"measured, {_name(place)}")  # fmt: skip
        for (law, place), curve in ours.items():
            axes.plot(*curve, "--" if law == "linear" else "-", c=colours[place], lw=1)
            if law == "spalding":
                whole = drop_balance.course(_drop(place, found[place]), drop_balance.WHOLE)
                axes.plot(whole[0] / SCALE, whole[1], ":", c=colours[place], lw=1)
        for label, style in (
            ("SDPH, linear", "--"),
            ("SDPH, spalding", "-"),
            ("balance: Stefan flow, numbers that follow T", ":"),
        ):
            axes.plot([], [], f"k{style}", lw=1, label=label)
        axes.set(xlim=(0.0, 14.0), ylim=(0.0, 1.1))
