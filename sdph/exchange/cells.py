"""Cells of the gas as the exchange sees them."""

from __future__ import annotations

import numpy as np

from coupling.transfer import deposit, gather
from sdph.engine import world
from sdph.engine.state import by_material


class Cells:
    """Volumes (C,) [m3, or m2 per metre of depth] of the cells, and what particles are in them; `voidage`: the gas
    knows of their volume."""

    def __init__(self, mesh, grain_density: float, voidage: bool = True):
        self.volumes, self.grain_density, self.world = mesh.volumes / mesh.depth, grain_density, world.here()
        self.voidage = voidage

    def sums(self, weights, amounts) -> np.ndarray:
        """Extensive amounts (N,) or (N, m) of the particles, those of other processes too, in the cells."""
        return self.world.sum(deposit(weights, amounts))

    def room(self, weights, mass, densities=()) -> np.ndarray:
        """Gas volume fraction of the cells with grains of `mass` (N,) [kg] in them; `densities` (N,) [kg/m3] of their
        materials, where there are several."""
        return 1.0 - self.sums(weights, mass / (densities if len(densities) else self.grain_density)) / self.volumes

    def gas(self, weights, mass, densities=()) -> np.ndarray:
        """The same as the gas has it: all of a cell where it knows nothing of the volume of grains."""
        return self.room(weights, mass, densities) if self.voidage else np.ones(len(self.volumes))

    def density(self, weights, amounts) -> np.ndarray:
        """Extensive amounts (N,) or (N, m) of the particles per volume of the cells."""
        deposited = self.sums(weights, amounts)
        return deposited / (self.volumes if deposited.ndim == 1 else self.volumes[:, None])

    def around(self, weights, mass, velocity) -> np.ndarray:
        """Mean velocity (N, 3) [m/s] of the grains around each particle, as their cells have it."""
        cells = self.sums(weights, np.column_stack((mass, mass[:, None] * velocity)))
        there = cells[:, :1] > 0.0
        return gather(weights, np.divide(cells[:, 1:], cells[:, :1], out=np.zeros_like(cells[:, 1:]), where=there))


def capacity_of(case, state):
    """Specific heat [J/kg/K] of the particles (N,), or the one of all."""
    return by_material(state.grain_capacity, case.grains.heat_capacity)
