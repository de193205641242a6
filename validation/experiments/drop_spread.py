"""Largest spread of a drop on a dry smooth wall that it hits, from runs in three dimensions, against two laws that
others fitted to their drops: Pasandideh-Fard et al. 1996 and Roisman 2009.

What is settled, before any result: the drop is of water, whose diameter and speed Weber and Reynolds number give. The
scene drop_on_plate in space, with its numerics. Walls slip, by the rule of docs/liquid-numerics.md: in the time of the
run the wall's layer, sqrt(nu t), stays below two spacings. The whole drop is run, since a pool that reaches out of its
tank is not cut off. Weight is left out, as the laws do.

What is run by default ends within 40 minutes of a core: We 20 at 90 degrees with 12 spacings in the diameter. Not run:
We 20 with 16 spacings and We 50 with 12, 60 and 110 degrees, and beyond We 50 (the faster the drop, the thinner it
gets).

The table has Roisman's second term over We, as the documents that it was found in have it; his paper, as we remember it
(it was not at hand), has it over the root of We. Spans of both are checked.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from sdph import scenes
from sdph.case import read as cases
from sdph.engine.state import LIQUID
from sdph.running import driver
from sdph.show import timeline
from sdph.study.compare import check

from . import measured

BAR = 0.10  # of the laws' span, either way (head of the data)
DENSITY, VISCOSITY, TENSION = 1000.0, 1e-3, 0.072  # kg/m3, Pa s, N/m: water at 20 C, rounded
AIR = 1.2, 1.8e-5  # kg/m3, Pa s
ANGLE = 90.0  # degrees
RUNS = ((20.0, 12),)  # We, and spacings in the diameter: what ends within 40 minutes; our choice
TIME, EVERY = 3.0, 0.05  # of D_0/U: end, and between outputs; drops of We 20 to 100 are widest at 2 to 3; our choice
ROOM = 0.5  # D_0 of air beyond the widest drop of the laws, and above the drop; our choice
# spacings of a film that is resolved, and of one through which wall and air just do not see each other, the reach of a
# kernel of h = 1.5 spacings; thinner ones tear where they should not. Our choice
FILM, THINNEST = 6.0, 3.0
SECTORS = 24  # of the circle, in each of which the outermost liquid counts; our choice


def row(weber: float):
    """The row of the table at a Weber number and the angle."""
    rows = measured.table("drop_spread_laws")
    return rows[(rows["We"] == weber) & (rows["theta_adv_deg"] == ANGLE)][0]


def scales(own) -> tuple[float, float]:
    """Diameter [m] and speed [m/s] of the drop of water with We and Re of a row."""
    diameter = (VISCOSITY * own["Re"]) ** 2 / (DENSITY * own["We"] * TENSION)
    return float(diameter), float(VISCOSITY * own["Re"] / (DENSITY * diameter))


def checks(folder: Path, overrides=(), reporter=None, runs=RUNS) -> list[dict]:
    """Largest spread of each run against the span of both laws, widened by the bar: the middle and half of it."""
    told, drawn = [], []
    for weber, fine in runs:
        curve = course(weber, fine, folder / f"drop-spread-{weber:g}-{fine}", overrides, reporter)
        drawn.append((weber, fine, curve))
        name = f"spread of a drop, We {weber:g}, Re {row(weber)['Re']:g}, D_0/dx = {fine}:"
        for laws, (low, high) in spans(row(weber)).items():
            middle, half = 0.5 * (low + high), 0.5 * (high - low)
            told.append(check(f"{name} largest D/D_0, middle of {laws} [-]", curve[1].max(), middle, half))
        film = 2.0 / 3.0 * fine / curve[1].max() ** 2  # of a disc as wide, with the volume of the drop
        told.append(check(f"{name} film when widest [spacings]", film, FILM, FILM - THINNEST))
    _figure(folder / "drop_spread.png", drawn)
    return told


def roisman(weber: float, reynolds: float) -> float:
    """Largest D/D_0 of Roisman 2009, Phys. Fluids 21, 052104, for We and Re that are large."""
    return 0.87 * reynolds**0.2 - 0.40 * reynolds**0.4 / math.sqrt(weber)


def spans(own) -> dict[str, tuple[float, float]]:
    """Least and largest D_max/D_0 that a row accepts, by the laws of the table and with Roisman's as he has it."""
    first, told = own["beta_PasandidehFard"], {}
    for name, second in {"the table": own["beta_Roisman"], "laws over root We": roisman(own["We"], own["Re"])}.items():
        told[name] = (1.0 - BAR) * float(min(first, second)), (1.0 + BAR) * float(max(first, second))
    return told


def course(weber: float, fine: int, folder: Path, overrides=(), reporter=None, time: float = TIME) -> np.ndarray:
    """Times [D_0/U] and D/D_0 of a run."""
    own = row(weber)
    case = cases.load(scenes.find("drop_on_plate")[1], (*given(own, fine, time), *overrides))
    driver.run(case, "drop_on_plate", folder, None, reporter)
    diameter, speed = scales(own)
    frames = timeline.read(folder)
    times = np.array(frames.time_values)
    return np.array([times * speed / diameter, [width(folder, t, case) / diameter for t in times]])


def given(own, fine: int, time: float) -> list[str]:
    """Overrides of the scene for a row."""
    (diameter, speed), spacing = scales(own), scales(own)[0] / fine
    half = spacing * math.ceil(fine * (0.5 * spans(own)["the table"][1] + ROOM))
    top = spacing * math.ceil(fine * (1.0 + ROOM))
    middle, box = [half, half, 0.5 * diameter], [2.0 * half, 2.0 * half, top]
    return [
        "dimensions=3",
        f"run.end_time_s={time * diameter / speed!r}",
        f"run.output_interval_s={EVERY * diameter / speed!r}",
        f"domain.size_m={box!r}",
        "domain.gravity_m_s2=[0.0, 0.0, 0.0]",
        f"resolution.spacing_mm={1e3 * spacing!r}",
        f"liquid.density_kg_m3={DENSITY}",
        f"liquid.viscosity_Pa_s={VISCOSITY}",
        f"liquid.sound_speed_m_s={10.0 * speed!r}",
        f"liquid.history_interval_s={EVERY * diameter / speed!r}",
        f"gas_phase.density_kg_m3={AIR[0]}",
        f"gas_phase.viscosity_Pa_s={AIR[1]}",
        f"surface_tension.coefficient_N_m={TENSION}",
        f"surface_tension.contact_angle_deg={ANGLE}",
        "tank.slip='free_slip'",
        f"pools.drop={{shape='sphere', centre_m={middle!r}, radius_m={0.5 * diameter!r}, "
        f"velocity_m_s=[0.0, 0.0, {-speed!r}]}}",
        f"pools.air={{phase='gas', shape='box', lower_m=[0.0, 0.0, 0.0], upper_m={box!r}}}",
    ]


def width(folder: Path, time: float, case) -> float:
    """Diameter [m] of the drop: twice the mean over sectors of where the outermost liquid in each ends, half a spacing
    beyond its particle."""
    cloud = timeline.state_at(timeline.read(folder), time).particles
    places = np.asarray(cloud.points)[np.asarray(cloud["kind"]) == LIQUID]
    x, y = (places[:, :2] - 0.5 * np.array(case.domain.size[:2])).T
    sector = np.floor((np.arctan2(y, x) / (2.0 * math.pi) + 0.5) * SECTORS).astype(int) % SECTORS
    ends = np.zeros(SECTORS)
    np.maximum.at(ends, sector, np.hypot(x, y))
    return 2.0 * float(ends.mean() + 0.5 * case.resolution.spacing)


def _figure(file: Path, drawn) -> None:
    """D/D_0 over time of each run, with both laws, and what the table accepts shaded."""
    with measured.figure(file, "t U/D_0 [-]", "D/D_0 [-]") as axes:
        for k, weber in enumerate(dict.fromkeys(weber for weber, *_ in drawn)):
            own = row(weber)
            laws = {"Pasandideh-Fard": own["beta_PasandidehFard"], "Roisman, table": own["beta_Roisman"],
                    "Roisman, root We": roisman(own["We"], own["Re"])}  # fmt: skip
            axes.axhspan(*spans(own)["the table"], color=f"C{k}", alpha=0.15)
            for (law, value), style in zip(laws.items(), ("--", ":", "-.")):
                axes.axhline(value, c=f"C{k}", ls=style, lw=1, label=f"{law}, We {weber:g}")
            for _, fine, curve in (one for one in drawn if one[0] == weber):
                axes.plot(*curve, c=f"C{k}", lw=fine / 8.0, label=f"SDPH, We {weber:g}, D_0/dx {fine}")
        axes.set_ylim(0.0)
