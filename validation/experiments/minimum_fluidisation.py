"""Minimum fluidisation of 22 powders, Geldart 1973, against laws alone: the scene fluidised_column holds a run against
the first of them."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from sdph import scenes
from sdph.case import read as cases
from sdph.laws import exact

from . import measured

BAR = 0.25  # of the velocity measured (README.md)
AIR = 1.2, 1.8e-5  # kg/m3 of air at 293 K and 1 atm, which hardly matters; Pa s as the paper has it
KINDS = ("Diakon", "Fresh catalyst", "Spent catalyst")


def ergun_at_onset(density: float, diameter: float) -> float:
    """U_mf [m/s] by Ergun of a bed as friction holds it, at the default of its onset."""
    onset = cases.load(scenes.find("fluidised_column")[1]).parameters["friction"].onset
    return exact.minimum_fluidisation(onset, density, measured.GRAVITY, diameter, *AIR)


def wen_yu(density: float, diameter: float) -> float:
    """U_mf [m/s] = (sqrt(33.7^2 + 0.0408 Ar) - 33.7) mu_g/(rho_g d). Wen & Yu 1966, AIChE J. 12, 610."""
    gas_density, viscosity = AIR
    archimedes = gas_density * (density - gas_density) * measured.GRAVITY * diameter**3 / viscosity**2
    return (math.sqrt(33.7**2 + 0.0408 * archimedes) - 33.7) * viscosity / (gas_density * diameter)


LAWS = {"Ergun at onset": ergun_at_onset, "Wen & Yu": wen_yu}


def checks(folder: Path, overrides=(), reporter=None) -> list[dict]:
    """Checks of each law over all powders and over each kind."""
    powders = measured.table("geldart_1973")
    powders = powders[np.isfinite(powders["U0_m_s"])]
    found, labels = powders["U0_m_s"], [f"{row['d_sv_um']:g} um [m/s]" for row in powders]
    ours = {
        name: np.array([law(float(row["rho_s_kg_m3"]), 1e-6 * row["d_sv_um"]) for row in powders])
        for name, law in LAWS.items()
    }
    _figure(folder / "minimum_fluidisation.png", powders, ours)
    rows = []
    for name, values in ours.items():
        for kind in KINDS:
            here = np.flatnonzero(powders["powder"] == kind)
            rows += measured.ratios(f"U_mf, {name}, {kind}", values[here], found[here], [labels[k] for k in here], BAR)
    return rows


def _figure(file: Path, powders, ours) -> None:
    with measured.figure(file, "U_mf measured [m/s]", "U_mf of the law [m/s]") as axes:
        for marker, (name, values) in zip("ox", ours.items()):
            for colour, kind in zip(("C0", "C1", "C2"), KINDS):
                here = powders["powder"] == kind
                axes.loglog(powders["U0_m_s"][here], values[here], marker, c=colour, label=f"{name}, {kind}")
        ends = np.array([powders["U0_m_s"].min(), powders["U0_m_s"].max()])
        axes.plot(ends, ends, "k-", lw=1, label="as measured, and 25 % either way")
        for share in (1.0 - BAR, 1.0 + BAR):
            axes.plot(ends, share * ends, "k:", lw=1)
