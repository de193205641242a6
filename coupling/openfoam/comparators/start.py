"""Grains of a run at its start, cell by cell."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from coupling.openfoam import poly_mesh


@dataclass(frozen=True)
class Start:
    """C cells of D dimensions: centres (C, D) [m], alpha_p (C,) [-], velocity (C, 3) [m/s], temperature (C,) [K].

    mesh   OpenFOAM case with the mesh that two fluids run on; without it that of the case's box is made
    """

    centres: np.ndarray
    alpha_p: np.ndarray
    velocity: np.ndarray
    temperature: np.ndarray
    mesh: Path | None = None

    def at(self, places: np.ndarray) -> Start:
        """The same at other places (M, D) [m]: of the nearest cell each."""
        nearest = cKDTree(self.centres).query(places)[1]
        return Start(places, self.alpha_p[nearest], self.velocity[nearest], self.temperature[nearest])

    @property
    def digest(self) -> str:
        """Hash of all values, and of the mesh."""
        own = hashlib.sha256()
        for values in (self.centres, self.alpha_p, self.velocity, self.temperature):
            own.update(np.ascontiguousarray(values).tobytes())
        return own.hexdigest() + digest_of_mesh(self.mesh)


def digest_of_mesh(case: Path | None) -> str:
    """Hash of the mesh of an OpenFOAM case; empty without one."""
    if case is None:
        return ""
    own = hashlib.sha256()
    for path in sorted((case / poly_mesh.FOLDER).iterdir()):
        own.update(path.name.encode() + b"\0" + path.read_bytes())
    return own.hexdigest()
