"""Water that collapses against a box in its way, SPHERIC test 2 (Kleefsman et al. 2005), against the record of the
instruments: heights at four places, pressure at two on the front of the box and two on its top.

The box is a step in the floor of the tank's mesh. Numerics are those of the scene, its sound speed again ten times the
front's by Ritter; the spacing, a twelfth of the depth, is what some minutes pay for.
"""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

from sdph.engine.state import LIQUID
from sdph.study.compare import check

HERE = Path(__file__).parent
LENGTH, WIDTH, DEPTH = 3.22, 1.0, 0.55  # m: tank, water
PLACES = {"h_2638": 0.582, "h_1488": 1.732, "h_0992": 2.228, "h_0496": 2.724}  # m from the water's end
END = 2.0  # s
FRONT, BESIDE, HIGH = 2.3955, 0.471, 0.161  # m: the box's front; line of the sensors; height of the box
# m, of the record's head: two sensors on the front by their height, two on the top by how far they are behind its edge
SENSORS = {name: (FRONT, BESIDE, height) for name, height in (("P1", 0.021), ("P3", 0.101))}
SENSORS |= {name: (FRONT + behind, BESIDE, HIGH) for name, behind in (("P5", 0.021), ("P7", 0.101))}
PEAKS = {"P1": (11239.0, 0.415), "P3": (6564.0, 0.459), "P5": (2082.0, 1.742), "P7": (2031.0, 1.72)}  # Pa, s (record)
# m, s, -, -: head of the record, which has those of pressure for P1 alone; that they hold for all is our choice
HEIGHT, ARRIVAL, PEAK_BAR, IMPULSE = 0.03, 0.03, 0.25, 0.15
# s: head of the record; the top is dry before water comes back from the far wall, its span is our choice
STRUCK = {"P1": (0.4, 1.0), "P3": (0.4, 1.0), "P5": (1.0, END), "P7": (1.0, END)}
WET = 0.02  # m, from which on water has arrived; our choice
ALONG, ACROSS = 1.0, 3.0  # spacings to each side of a height's place that it is taken over; our choice
OVERRIDES = (
    f"run.end_time_s={END}",
    f"domain.size_m=[{LENGTH}, {WIDTH}, 1.0]",
    "domain.gravity_m_s2=[0.0, 0.0, -9.81]",
    f"resolution.spacing_mm={1e3 * DEPTH / 12.0!r}",
    "liquid.density_kg_m3=998.0",
    "liquid.sound_speed_m_s=46.5",
    f"tank={{shape='mesh', mesh={str(HERE / 'tank_with_box.off')!r}, slip='free_slip'}}",
    f"pools.column={{shape='box', lower_m=[0.0, 0.0, 0.0], upper_m=[1.228, {WIDTH}, {DEPTH}]}}",
    *(f"probes.{name}.at_m={list(place)!r}" for name, place in SENSORS.items()),
)


def record() -> dict[str, np.ndarray]:
    """Column -> values of spheric2.csv."""
    with open(HERE / "spheric2.csv", encoding="utf-8") as file:
        names, *rows = csv.reader(line for line in file if not line.startswith("#"))
    return dict(zip(names, np.array(rows, dtype=float).T))


def heights(run) -> dict[str, np.ndarray]:
    """Times [s] of the outputs, and by place the height of water there [m]: its volume over the area that it is taken
    over."""
    case, dx = run.case, run.case.resolution.spacing
    times = np.arange(0.0, run.summary["time_s"] + 1e-9, case.run.output_interval)
    found = {"t_s": times} | {name: np.zeros(len(times)) for name in PLACES}
    area = 4.0 * ALONG * ACROSS * dx**2
    for k, time in enumerate(times):
        _, particles, _ = run.fields(time)
        liquid = particles["kind"] == LIQUID
        x, y, _ = particles.points[liquid].T
        for name, place in PLACES.items():
            inside = _share((x - place) / dx, ALONG) * _share((y - 0.5 * WIDTH) / dx, ACROSS)
            found[name][k] = particles["mass"][liquid] @ inside / case.liquid.density / area
    return found


def _share(places, reach: float):
    """Share of a particle, a spacing wide, that lies within `reach` of 0, both in spacings."""
    return np.clip(reach + 0.5 - np.abs(places), 0.0, 1.0)


def checks(run) -> list[dict]:
    """Heights, arrivals, peak and impulse of the pressures; of what the run lasted."""
    known, ours, times = record(), heights(run), run.history["time_s"]
    pressures = {name: np.nan_to_num(run.history[f"{name}_pressure_Pa"]) for name in SENSORS}  # no water, no pressure
    _figures(run, known, ours, pressures)
    told = []
    for name in PLACES:
        apart = ours[name] - np.interp(ours["t_s"], known["t_s"], known[name])
        told.append(check(f"{name}, rms off [m]", np.sqrt(np.mean(apart**2)), 0.0, HEIGHT))
    for name in list(PLACES)[1:]:
        told.append(check(f"{name}, water arrives [s]", _arrival(ours, name), _arrival(known, name), ARRIVAL))
    for name, pressure in pressures.items():
        told += _struck(name, times, pressure, known)
    return told


def _struck(name: str, times, pressure, known) -> list[dict]:
    """Largest pressure of a sensor, when that is, and the impulse."""
    largest, at = PEAKS[name]
    begin, end = STRUCK[name]
    impulses = (_impulse(times, pressure, begin, end), _impulse(known["t_s"], known[name], begin, end))
    return [
        check(f"{name}, largest [Pa]", pressure.max(), largest, PEAK_BAR, True),
        check(f"{name}, largest at [s]", times[np.argmax(pressure)], at, ARRIVAL),
        check(f"{name}, impulse from {begin:g} to {end:g} s [Pa s]", *impulses, IMPULSE, True),
    ]


def _arrival(of, name: str) -> float:
    """Time [s] at which the height first passes WET; nan where it does not."""
    later = np.flatnonzero(of[name] > WET)
    if not len(later):
        return np.nan
    k = later[0]
    return float(np.interp(WET, of[name][k - 1 : k + 1], of["t_s"][k - 1 : k + 1])) if k else 0.0


def _impulse(times, pressure, begin: float, end: float) -> float:
    """Pa s, between two times [s]."""
    here = (times >= begin) & (times <= end)
    return float(np.trapezoid(pressure[here], times[here]))


def _figures(run, known, ours, pressures) -> None:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    drawn, axes = pyplot.subplots(
        len(PLACES) + len(SENSORS), 1, figsize=(6.5, 14.0), sharex=True, constrained_layout=True
    )
    for one, name in zip(axes, PLACES):
        one.plot(known["t_s"], known[name], "k-", lw=1, label="measured")
        one.plot(ours["t_s"], ours[name], "C3o-", ms=2, lw=1, label="SDPH")
        one.set_ylabel(f"{name} [m]")
    for one, (name, pressure) in zip(axes[len(PLACES) :], pressures.items()):
        one.plot(known["t_s"], 1e-3 * known[name], "k-", lw=1)
        one.plot(run.history["time_s"], 1e-3 * pressure, "C3-", lw=1)
        one.set_ylabel(f"{name} [kPa]")
    axes[-1].set(xlabel="t [s]", xlim=(0.0, END))
    axes[0].legend(fontsize=8)
    drawn.savefig(run.folder / "box.png", dpi=90)
    pyplot.close(drawn)
