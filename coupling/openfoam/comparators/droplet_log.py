"""Masses that the cloud of reactingParcelFoam tells in its log, step by step, and its fields do not."""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path

import numpy as np

from coupling.openfoam.comparators.reference import Reference

STEP = re.compile(r"^Time = (\S+)$", re.MULTILINE)
NUMBER = r"\s+= (\S+)"
COLUMNS = {  # column -> what the log calls it; injectors are told one by one
    "injected_kg": re.compile("- mass introduced" + NUMBER),
    "airborne_kg": re.compile("Current mass in system" + NUMBER),
    "evaporated_kg": re.compile("Mass transfer phase change" + NUMBER),
}


def history(log: Path) -> dict[str, np.ndarray]:
    """time_s, and since the start mass that came in, mass in the air and mass that evaporated, (N,) each [kg]."""
    parts = STEP.split(log.read_text(encoding="utf-8", errors="replace"))
    times, steps = parts[1::2], parts[2::2]
    columns = {
        name: np.array([sum(map(float, told.findall(step))) for step in steps]) for name, told in COLUMNS.items()
    }
    return {"time_s": np.array(times, float), **columns}


def by_the_metre(reference: Reference, depth: float) -> Reference:
    """A reference of a plane mesh of `depth` [m] with masses and volumes by the metre."""
    history = {name: values if name == "time_s" else values / depth for name, values in reference.history.items()}
    parcels = {when: own | {"count": own["count"] / depth} for when, own in reference.parcels.items()}
    return dataclasses.replace(reference, volumes=reference.volumes / depth, history=history, parcels=parcels)
