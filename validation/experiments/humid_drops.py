"""Suspended water drops in a stream of dry and of humid air, Fujita et al. 2010: rate at which the square of the
diameter falls, and temperature, from runs."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from sdph.study.compare import check

from . import lone_drops, measured

RATE, TEMPERATURE = 0.10, 0.5  # of K; K (head of the data)
SPEEDS = {"Re60": 0.813, "Re150": 2.03}  # m/s
HUMIDITY = {"RH0": 0.0, "RH30": 0.00806}  # mass fraction of vapour
CASES = tuple(f"{stream}_{air}" for stream in SPEEDS for air in HUMIDITY)
DIAMETER, COLD, HOT, TIME = 1.2e-3, 15.0 + lone_drops.ICE, 30.0 + lone_drops.ICE, 30.0  # m, K, K, s
MM2 = 1e6  # mm2 in a m2


def checks(folder: Path, overrides=(), reporter=None, laws=lone_drops.LAWS, names=CASES) -> list[dict]:
    """K and the last temperature of each law in each stream."""
    rows = measured.table("fujita_2010")
    ours = {(law, name): _course(law, name, folder, overrides, reporter) for law in laws for name in names}
    _figures(folder, rows, ours)
    return [row for (law, name), curves in ours.items() for row in _of_one(law, name, curves, rows)]


def _of_one(law: str, name: str, curves, rows) -> list[dict]:
    found = _rows(rows, name, "d2_over_d02")
    scale = MM2 * DIAMETER**2
    K = scale * lone_drops.slope(curves[0], curves[1])
    told = [check(f"water drop, {law}, {name}: K [mm2/s]", K, scale * lone_drops.slope(*found), RATE, True)]
    times, warmer = _rows(rows, name, "T_minus_T0_K")
    if len(times):
        own = float(np.interp(times[-1], curves[0], curves[2])) - COLD
        told.append(
            check(f"water drop, {law}, {name}: T - T_0 after {times[-1]:g} s [K]", own, warmer[-1], TEMPERATURE)
        )
    return told


def _rows(rows, name: str, quantity: str) -> np.ndarray:
    """Times and values that were measured."""
    here = (rows["case"] == name) & (rows["quantity"] == quantity)
    return np.array([rows["t_s"][here], rows["value"][here]])


def drop(name: str) -> lone_drops.Drop:
    stream, air = name.split("_")
    return lone_drops.Drop("water", "air", DIAMETER, COLD, HOT, TIME, speed=SPEEDS[stream], humidity=HUMIDITY[air])


def _course(law: str, name: str, folder: Path, overrides, reporter) -> np.ndarray:
    return lone_drops.course(drop(name), law, folder / f"humid-{law}-{name}", overrides, reporter)


def _figures(folder: Path, rows, ours) -> None:
    for file, quantity, label, of, room in (
        ("humid_drops.png", "d2_over_d02", "(d/d_0)^2 [-]", lambda curves: curves[1], (0.83, 1.01)),
        ("humid_drops_temperature.png", "T_minus_T0_K", "T - T_0 [K]", lambda curves: curves[2] - COLD, (-6.0, 8.0)),
    ):
        with measured.figure(folder / file, "t [s]", label) as axes:
            for colour, name in zip(("C0", "C1", "C2", "C3"), CASES):
                known = _rows(rows, name, quantity)
                axes.plot(*known, "o", ms=4, c=colour, label=f"{name}, {'' if known.size else 'not '}measured")
                for law, style in (("linear", "--"), ("spalding", "-")):
                    if (law, name) in ours:
                        axes.plot(ours[law, name][0], of(ours[law, name]), style, c=colour, lw=1)
            for law, style in (("linear", "k--"), ("spalding", "k-")):
                axes.plot([], [], style, lw=1, label=f"SDPH, {law}")
            axes.set_ylim(room)
