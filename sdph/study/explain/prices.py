"""Prices of a run in time: of a particle and its sub-step, of a cell and its window, as they were measured."""

from __future__ import annotations

import json
from typing import NamedTuple

import numpy as np

from sdph.engine import device as environment

MEASURED = environment.CACHE / "speed.json"  # of this machine, by `sdph explain --measure`

# Time of a particle in space over that of one in a plane: 113 neighbours in place of 28; measured in a round bed. So
# much more a cell of the embedded gas takes, too: 3.6 to 5 us in place of 0.8 to 1.4
IN_SPACE = 2.5


class Priced(NamedTuple):
    """A gas solver, its cells, its time for each window and for each cell of it [us], and, of a mesh that the case
    brings, shortest and longest edge [m] of the cells where grains stand and the shortest of each (C,), how often in a
    second [1/s] gas crosses one there, at most, and the largest speed [m/s] of gas that flows through it alone."""

    name: str
    cells: int
    window: float
    cell: float
    edges: tuple[float, float, np.ndarray] | None = None
    crossed: float = 0.0
    fastest: float = 0.0


def by_openfoam(cells: int) -> Priced:
    """Time of sdphGasFoam: 3 ms of each window go into messages and tables, however few cells (measured with 160), and
    2 us into each cell of it (1.4 to 1.9 with 5000 to 80 000)."""
    return Priced("OpenFOAM gas", cells, 3000.0, 2.0)


class Speed(NamedTuple):
    """Time of one particle and sub-step, moving or at rest, of a liquid, of a solid, of one cell and window of the
    embedded gas, of a window of it and of the exchange however few cells there are, of a sub-step that nozzles feed,
    and of a window of one particle of droplets that evaporate, all of one size or of several [us]."""

    moving: float
    resting: float
    liquid: float
    solid: float
    cell: float
    window: float
    fed: float
    alike: float
    several: float
    measured: str


OF_GRAINS = ("moving", "resting", "cell", "window", "fed", "alike", "several")  # measured together, by a bed
# One core of the machine the shipped numbers were made on; `sdph explain --measure` replaces them by yours. What
# nozzles and droplets take is of three sprays of 200 to 560 particles (two of several sizes, evaporating_jet)
OTHER = "another machine; `sdph explain SCENE --measure` measures this one"
SHIPPED = Speed(2.5, 0.4, 1.0, 1.0, 2.0, 3500.0, 2000.0, 15.0, 50.0, OTHER)


def speed() -> Speed:
    """Speeds last measured on this machine, else the shipped numbers."""
    kept = json.loads(MEASURED.read_text()) if MEASURED.is_file() else {}
    return SHIPPED._replace(**kept)


def of_liquid(case) -> float:
    """Time [us] of a particle of a liquid and a step."""
    return speed().liquid * (IN_SPACE if case.dimensions == 3 else 1.0)
