"""Grains in a vessel that is shaken by half its radius, five times a second: none gets through its walls of triangles.

    python validation/own_vessel/leaks.py PARTICLES SUB_STEPS     vessels of so many, so long; exits 1 if any is lost

In the frame of the vessel: what grains feel of the shaking is an acceleration besides gravity (that of
sdph.effects.around.frame), a turn along x, then one along y, then one along z. There is no gas: nothing but the walls
holds the grains.
"""

from __future__ import annotations

import math
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pyvista

from sdph.case import read as cases
from sdph.effects.around.frame import Frame, motion
from sdph.engine import state as particles
from sdph.engine.walls import facets
from sdph.methods.grains.grains import Grains
from sdph.study.compare import check

RADIUS, HEIGHT, WIDER = 0.1, 0.2, 0.15  # m; the upper radius of the cone
RATE = 5.0  # Hz
WINDOW = 1e-3  # s, over which the acceleration is held: a 200th of a turn
LEVEL = 0.6  # of the height that is filled
PARTICLES, STEPS = 1000, 10000  # of `sdph validate`: one minute each
GRAVITY = np.array([0.0, 0.0, -9.81])


class Shaken(NamedTuple):
    """Particles at the start; most that were behind the wall or gone at the end of a window; sub-steps; time [s]; least
    distance from the wall [spacings]; fastest [m/s]."""

    particles: int
    lost: int
    steps: int
    time: float
    nearest: float
    fastest: float


def vessel(top: float, sides: int = 48):
    """A closed cone or cylinder with its floor at z = 0 about z, normals inwards, of long thin triangles."""
    angle = 2.0 * math.pi * np.arange(sides) / sides
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    points = np.vstack(
        [np.pad(RADIUS * ring, ((0, 0), (0, 1))), np.pad(top * ring, ((0, 0), (0, 1)), constant_values=HEIGHT)]
    )
    points = np.vstack([points, [[0.0, 0.0, 0.0], [0.0, 0.0, HEIGHT]]])
    k, after = np.arange(sides), (np.arange(sides) + 1) % sides
    low, high = np.full(sides, 2 * sides), np.full(sides, 2 * sides + 1)
    faces = np.vstack([
        np.stack([k, k + sides, after], axis=1), np.stack([after, k + sides, after + sides], axis=1),
        np.stack([k, after, low], axis=1), np.stack([k + sides, high, after + sides], axis=1),
    ])  # fmt: skip
    return pyvista.PolyData(points, np.insert(faces, 0, 3, axis=1).ravel())


def case_of(path: str, count: int):
    """Grains up to LEVEL of a vessel, about `count` particles."""
    spacing = (math.pi * RADIUS**2 * LEVEL * HEIGHT / count) ** (1.0 / 3.0)
    return cases.from_table({
        "dimensions": 3, "effects": ["walls", "gravity", "granular_pressure", "granular_temperature", "friction"],
        "run": {"end_time_s": 1e3, "output_interval_s": 1e3},
        "domain": {"size_m": [2.0 * WIDER, 2.0 * WIDER, HEIGHT], "lower_m": [-WIDER, -WIDER, 0.0],
                   "gravity_m_s2": GRAVITY.tolist()},
        "resolution": {"spacing_mm": 1e3 * spacing, "cell_mm": 2e3 * spacing},
        "gas": {"density_kg_m3": 1.2, "viscosity_Pa_s": 1.8e-5, "conductivity_W_m_K": 0.026,
                "heat_capacity_J_kg_K": 1006.0, "temperature_K": 300.0},
        "grains": {"density_kg_m3": 2500.0, "diameter_mm": 1.0, "heat_capacity_J_kg_K": 800.0,
                   "conductivity_W_m_K": 1.0},
        "walls": {"source": "gas", "mesh": path}, "boundaries": {"wall": {"kind": "wall"}},
        "particles": {"bed": {"shape": "walls", "height_m": LEVEL * HEIGHT, "volume_fraction": 0.5,
                              "temperature_K": 300.0, "disorder": 0.1}},
    })  # fmt: skip


def shaken(folder: Path, top: float, count: int, steps: int) -> Shaken:
    """Shake a vessel for `steps` sub-steps: a turn along each axis, then the next."""
    path = str(folder / f"{top:g}.vtk")
    surface = vessel(top)
    corners = np.asarray(surface.points)[surface.regular_faces]
    no = np.zeros(len(corners), bool)
    facets.save(path, facets.Facets(corners, no, no, np.full(len(corners), -1)))
    case = case_of(path, count)
    grains, wall = Grains(case), facets.Surface(corners)
    grains.start()
    accelerations = [
        motion(Frame(shake=((axis, 0.5 * RADIUS, 2.0 * math.pi * RATE, 0.0),)), math.inf) for axis in range(3)
    ]
    born, lost, nearest, fastest = len(grains.state.x), 0, math.inf, 0.0
    while grains.steps < steps:
        middle = grains.time + 0.5 * WINDOW
        felt, _, _ = accelerations[int(middle * RATE) % 3](middle)
        grains.begin()
        grains.stepper.gravity = GRAVITY - felt
        count = len(grains.state.x)
        grains.force(np.zeros(count), np.tile(grains.stepper.gravity, (count, 1)), np.zeros(count))
        grains.advance(grains.time + WINDOW)
        grains.close()
        off = wall.distance(particles.positions(grains.state))
        nearest, lost = min(nearest, float(off.min())), max(lost, born - int((off > 0.0).sum()))
        fastest = max(fastest, grains.fastest())
        grains.renew(WINDOW)
    return Shaken(born, lost, grains.steps, grains.time, nearest / case.resolution.spacing, fastest)


def checks(folder: Path, _=(), reporter=None) -> list[dict]:
    """None lost, at the end or in between, of a cylinder and of a cone."""
    rows = []
    for name, top in (("cylinder", RADIUS), ("cone", WIDER)):
        found = shaken(folder, top, PARTICLES, STEPS)
        rows.append(
            check(f"{name}, shaken for {STEPS} sub-steps: lost of {found.particles} particles", found.lost, 0.0, 0.0)
        )
    return rows


def main(particles_: int, steps: int) -> int:
    with tempfile.TemporaryDirectory() as folder:
        found = {
            name: shaken(Path(folder), top, particles_, steps) for name, top in (("cylinder", RADIUS), ("cone", WIDER))
        }
    for name, row in found.items():
        print(name, row)
    return int(any(row.lost for row in found.values()))


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:])))
