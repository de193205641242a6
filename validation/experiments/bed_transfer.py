"""Transfer between particles and fluid in packed beds, the markers of Wakao & Funazkri 1978, against laws alone: the
Nusselt numbers that `heat.law` names, by analogy Sherwood numbers, Sc in the place of Pr. Evaporation has Ranz &
Marshall's.

Liquids are told as (Sh - 2)/Sc^(1/3) alone, and so all is compared. Of Gunn's law, whose Sh begins at 3.8 and not at 2,
the Schmidt number does not fall out: that of liquids is our choice.
"""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np

from sdph.laws import heat
from sdph.study.compare import check

from . import measured

VOIDAGE = 0.4  # head of the data
SCHMIDT = {"gas_evaporation_Sc0.6": 0.6, "liquid": 1000.0}  # of the liquids our choice
NAMES = {"gas_evaporation_Sc0.6": "gas", "liquid": "liquid"}
PLACES = (3.0, 30.0, 300.0, 3000.0)  # Re
BANDS = {
    "gas_evaporation_Sc0.6": 0.39,
    "liquid": 0.25,
}  # standard deviations about Wakao & Funazkri's law (as the head)
FEWER = 0.1  # of the markers that ours may hold less than that law; our choice


def wakao(reynolds):
    """(Sh - 2)/Sc^(1/3) of Wakao & Funazkri 1978; `reynolds` superficial."""
    return 1.1 * reynolds**0.6


def reduced(law, reynolds, schmidt: float) -> np.ndarray:
    """(Sh - 2)/Sc^(1/3) of a law of sdph.laws.heat, which takes Re of the gas between the grains."""
    return np.array([(law(VOIDAGE, Re / VOIDAGE, schmidt) - 2.0) / schmidt ** (1.0 / 3.0) for Re in reynolds])


def checks(folder: Path, overrides=(), reporter=None, laws=None) -> list[dict]:
    """Mean over the markers, and the share of them in its band, of each law, set and range of Re."""
    laws, markers = laws or heat.LAWS, measured.table("wakao_1978")
    _figure(folder / "bed_transfer.png", markers, laws)
    return [
        row
        for name, law in laws.items()
        for kind, schmidt in SCHMIDT.items()
        for low, high in pairwise(PLACES)
        for row in _of_range(f"{name}, {NAMES[kind]}, Re = {low:g} to {high:g}", law, schmidt, BANDS[kind],
                             markers[(markers["set"] == kind) & (markers["Re"] >= low) & (markers["Re"] < high)])
    ]  # fmt: skip


def _of_range(name: str, law, schmidt: float, band: float, markers) -> list[dict]:
    ours, theirs = reduced(law, markers["Re"], schmidt), wakao(markers["Re"])
    held, known = (_held(curve, markers, band) for curve in (ours, theirs))
    return [
        check(f"transfer in a bed, {name}: mean over {len(ours)} markers [-]", _mean(ours, markers), 1.0, band),
        {"name": f"transfer in a bed, {name}: share of markers within {100 * band:g} %, Wakao & Funazkri's [-]",
         "value": held, "reference": known, "tolerance": FEWER, "ok": held >= known - FEWER},
    ]  # fmt: skip


def _mean(curve, markers) -> float:
    """Geometric mean of a curve over the markers."""
    return float(np.exp(np.mean(np.log(curve / markers["reduced"]))))


def _held(curve, markers, band: float) -> float:
    """Share of the markers within `band` of a curve."""
    return float(np.mean(np.abs(markers["reduced"] / curve - 1.0) <= band))


def _figure(file: Path, markers, laws) -> None:
    with measured.figure(file, "Re, superficial [-]", "(Sh - 2)/Sc^(1/3) [-]") as axes:
        for kind, colour in zip(NAMES, ("k", "0.7")):
            rows = markers[markers["set"] == kind]
            axes.loglog(rows["Re"], rows["reduced"], ".", ms=3, c=colour, label=f"measured, {NAMES[kind]}")
        Re = np.geomspace(PLACES[0], PLACES[-1], 60)
        axes.plot(Re, wakao(Re), "k-", lw=1, label="Wakao & Funazkri, and 39 % either way")
        for share in (1.0 - max(BANDS.values()), 1.0 + max(BANDS.values())):
            axes.plot(Re, share * wakao(Re), "k:", lw=1)
        for colour, (name, law) in zip(("C0", "C1", "C3"), laws.items()):
            axes.plot(Re, reduced(law, Re, SCHMIDT["liquid"]), "-", c=colour, label=f"{name}, Sc = 1000")
            axes.plot(Re, reduced(law, Re, SCHMIDT["gas_evaporation_Sc0.6"]), "--", c=colour, label=f"{name}, Sc = 0.6")
