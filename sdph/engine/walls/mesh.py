"""Sides of a mesh that particles stand on: thin walls part the grains on their two sides from each other.

A mesh closes off what lies behind it, so that of a plate thinner than the kernel's reach both faces are near every
particle. Rows of neighbours are cleared of what a particle cannot meet when they are built; no kernel asks again.
Contact has put every particle in front of its surface by then, a quarter of a spacing or more.
"""

from __future__ import annotations

import numpy as np

from sdph.engine.rows import entry, place, shorten
from sdph.laws.compiled import serial

AROUND = 0.75  # spacings about a surface point that count as its own: points stand one spacing apart or closer


def three(axes) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """x, y, z of places in two or three dimensions."""
    return (*axes, np.zeros(len(axes[0])))[:3]


@serial
def height(dummies, w, x, y, z):
    """Height [m] of a place over the surface that dummy w is behind."""
    along = (x - dummies.x[w]) * dummies.normal_x[w] + (y - dummies.y[w]) * dummies.normal_y[w]
    return along + (z - dummies.z[w]) * dummies.normal_z[w] - dummies.depth[w]


@serial
def keep_in_front(dummies, of_mesh, places, rows):
    """Take the dummies of a mesh out of the rows of particles that stand behind its surface."""
    x, y, z = places
    for i in range(len(x)):
        kept = 0
        for k in range(rows.number[i]):
            w = entry(rows, i, k)
            if not of_mesh[w] or height(dummies, w, x[i], y[i], z[i]) > 0.0:
                rows.entries[place(rows, i, kept)] = w
                kept += 1
        rows.number[i] = kept


@serial
def part(dummies, of_mesh, spacing, places, wall_rows, rows):
    """Take the neighbours out of the particles' rows that stand on the other side of a mesh."""
    for i in range(len(places[0])):
        kept = 0
        for k in range(rows.number[i]):
            j = entry(rows, i, k)
            if not (
                parted(dummies, of_mesh, spacing, places, wall_rows, i, j)
                or parted(dummies, of_mesh, spacing, places, wall_rows, j, i)
            ):
                rows.entries[place(rows, i, kept)] = j
                kept += 1
        shorten(rows, i, kept)


@serial
def parted(dummies, of_mesh, spacing, places, wall_rows, i, j):
    """True where the way from i, in front of a surface, to j, behind it, goes through one of its points."""
    x, y, z = places
    for k in range(wall_rows.number[i]):
        w = entry(wall_rows, i, k)
        if not of_mesh[w] or dummies.depth[w] > spacing:  # the first layer alone: it stands for the surface
            continue
        before, behind = height(dummies, w, x[i], y[i], z[i]), height(dummies, w, x[j], y[j], z[j])
        if before <= 0.0 or behind >= 0.0:
            continue
        share, depth = before / (before - behind), dummies.depth[w]
        dx = x[i] + share * (x[j] - x[i]) - dummies.x[w] - depth * dummies.normal_x[w]
        dy = y[i] + share * (y[j] - y[i]) - dummies.y[w] - depth * dummies.normal_y[w]
        dz = z[i] + share * (z[j] - z[i]) - dummies.z[w] - depth * dummies.normal_z[w]
        if dx * dx + dy * dy + dz * dz <= (AROUND * spacing) ** 2:
            return True
    return False
