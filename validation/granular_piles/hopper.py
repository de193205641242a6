"""Grains out of a slot in the floor of a bin, against Beverloo's law in a plane.

Beverloo, Leniger & van de Velde 1961, Chem. Eng. Sci. 15, 260: W = 0.58 rho_b sqrt(g) (D - k d)^(5/2), k = 1.4, out of
a round hole. Per area and sqrt(g times hydraulic diameter) that is 0.58 4/pi; the hydraulic diameter of a long slot is
twice its width D: W = 0.58 4 sqrt(2)/pi rho_b sqrt(g) (D - k d)^(3/2) per length, with 1.04 for 0.58 (Nedderman 1992,
Statics and Kinematics of Granular Materials, gives 1.03 for slots).
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from sdph.study.compare import check
from sdph.study.validate import part

from . import alone

measured = part("experiments", "measured")

C, K = 0.58, 1.4  # -, Beverloo et al. 1961
SLOTS, SPACINGS = (0.04, 0.06, 0.08), (5e-3, 2.5e-3)  # m: 40 to 80 grains, 8 to 32 particles
WIDE, HIGH = 2.5, 2.5  # slots: narrower than 0.4 of the bin, and filled to more than the bin's width; our choice
STARTED, MEASURED = 0.15, 0.35  # of what was filled in that has left; between them the rate is taken; our choice
LONGEST = 5.0  # times Beverloo's time for it; our choice
PARTS = 60  # that what is measured comes out in, about; our choice
BAR = 0.10  # issue 18


def checks(folder: Path, *_, slots=SLOTS, spacings=SPACINGS) -> list[dict]:
    rates = {(D, dx): rate(D, dx) for D in slots for dx in spacings}
    _figure(folder / "hopper.png", rates)
    return [
        check(f"slot of {1e3 * D:g} mm, {1e3 * dx:g} mm: rate [kg/s/m]", found, beverloo(D), BAR, True)
        for (D, dx), found in rates.items()
    ]


def beverloo(slot: float) -> float:
    """Rate per length of a slot [kg/s/m] that is `slot` [m] wide."""
    free = slot - K * alone.DIAMETER
    return 4.0 * math.sqrt(2.0) / math.pi * C * alone.ALPHA_P * alone.DENSITY * math.sqrt(alone.GRAVITY * free) * free


def rate(slot: float, spacing: float) -> float:
    """Rate [kg/s/m] of both halves of a bin; 0 where grains stop to flow."""
    run, gone, times = filled(slot, spacing), 0.0, []
    whole = float(run.state.mass.sum())
    part = STARTED * 2.0 * whole / beverloo(slot) / PARTS
    for _ in range(round(LONGEST * PARTS * MEASURED / STARTED)):
        gone += run.go(part) / whole
        if gone >= STARTED:
            times.append((run.time, gone))
        if gone >= MEASURED:
            (first, before), (last, after) = times[0], times[-1]
            return 2.0 * whole * (after - before) / (last - first)
    return 0.0


def filled(slot: float, spacing: float):
    """Half of a bin of grains, beside its plane of symmetry; the slot opens at once."""
    size = [math.ceil(share * slot / spacing) * spacing for share in (0.5 * WIDE, HIGH)]
    exit = {"kind": "pressure_outlet", "side": "bottom", "span_m": [0.0, 0.5 * slot], "pressure_Pa": 0.0,
            "temperature_K": 293.0}  # fmt: skip
    sides = {"axis": {"kind": "slip_wall", "side": "left"}, "exit": exit, "rest": {"kind": "wall"}}
    domain = (size[0], size[1] + 4.0 * spacing)
    return alone.Alone(alone.case(domain, ((0.0, 0.0), size), spacing, boundaries=sides))


def _figure(file: Path, rates: dict[tuple[float, float], float]) -> None:
    """Rates [kg/s/m] by slot and spacing [m], over the width of the slot, beside the law and its bar."""
    slots, law = np.linspace(0.75 * SLOTS[0], 1.1 * SLOTS[-1]), np.vectorize(beverloo)
    with measured.figure(file, "D [mm]", "W [kg/s/m]") as axes:
        axes.fill_between(
            1e3 * slots, (1 - BAR) * law(slots), (1 + BAR) * law(slots), color="0.88", label=f"+-{100.0 * BAR:g} %"
        )
        axes.plot(1e3 * slots, law(slots), "k-", lw=1, label="Beverloo et al. 1961, in a plane")
        for dx, mark in zip(sorted({dx for _, dx in rates}, reverse=True), "os^v"):
            own = {D: found for (D, spacing), found in rates.items() if spacing == dx}
            places = 1e3 * np.array(list(own))
            axes.plot(places, list(own.values()), mark, mfc="none", label=f"SDPH, {1e3 * dx:g} mm")
