"""Explicit transport of any field by given fluxes, bounded, in sub-steps of the window."""

from __future__ import annotations

import numpy as np
from numba import njit

from coupling.embedded.linear import fill

OUTFLOW = 0.5  # of a cell's mass that may leave in one sub-step; the scheme is bounded up to 1/2


@njit(error_model="numpy")
def carried(through, courant, values, gaps, reach, limited):
    """Value that `through` carries over a face, from the values far below, below, above and far above it, the three
    distances between them, and that from below to the face: upwind, or with van Leer's slope (J. Comput. Phys. 14,
    361, 1974), the harmonic mean of those on both sides of the upwind value, at the time half a step on.
    Without branches, so that the loop becomes vector code."""
    far_below, below, above, far_above = values
    middle = (above - below) / gaps[1]
    upwards = through >= 0.0
    behind = (below - far_below) / gaps[0] if upwards else (far_above - above) / gaps[2]
    distance = reach if upwards else reach - gaps[1]
    product = middle * behind
    slope = 2.0 * product / (middle + behind) if product > 0.0 else 0.0
    rise = slope * distance * (1.0 - courant) if limited and courant < 1.0 else 0.0
    most = abs(above - below)  # the next value bounds it, where cells differ in width
    rise = most if rise > most else -most if rise < -most else rise
    return (below if upwards else above) + rise


@njit(cache=True, error_model="numpy")
def substeps(inner, flux, before, after, dt):
    """Sub-steps for which no cell loses more than `OUTFLOW` of its mass, and the Courant number of the window."""
    rows, run, steps = inner
    share, courant = 0.0, 0.0
    for row in rows:
        for c in range(row, row + run):
            out, through = 0.0, 0.0
            for a in range(len(steps)):
                lower, upper = flux[a, c], flux[a, c + steps[a]]
                out += (upper if upper > 0.0 else 0.0) - (lower if lower < 0.0 else 0.0)
                through += abs(lower) + abs(upper)
            mass = before[c] if before[c] < after[c] else after[c]
            share = max(share, out / mass)
            courant = max(courant, 0.5 * through / mass)
    return int(np.ceil(share * dt / OUTFLOW)), courant * dt


@njit(error_model="numpy")
def _face_flux(wide, a, shift, field, mass, flux, gap, reach, sub, limited, face):
    """What each face of axis a lets through, into face (S,)."""
    rows, run, steps = wide
    s = steps[a]
    for row in rows:
        for f in range(row, row + run):
            through = 0.5 * (flux[f - shift] + flux[f])
            courant = 2.0 * sub * abs(through) / (mass[f - s] + mass[f])
            values = (field[f - s - s], field[f - s], field[f], field[f + s])
            gaps = (gap[f - s], gap[f], gap[f + s])
            face[f] = through * carried(through, courant, values, gaps, reach[f], limited)


@njit(error_model="numpy")
def _update(inner, shift, active, field, mass, flux, face, sub):
    """Content and mass of every node after a sub-step."""
    rows, run, steps = inner
    for row in rows:
        for c in range(row, row + run):
            content, gained = mass[c] * field[c], 0.0
            for a in range(len(steps)):
                s = steps[a]
                content += sub * (face[a, c] - face[a, c + s])
                gained += flux[a, c] + flux[a, c - shift] - flux[a, c + s] - flux[a, c + s - shift]
            mass[c] += 0.5 * sub * gained
            field[c] = content / mass[c] if active[c] else field[c]


@njit(cache=True, error_model="numpy")
def convect(inner, wide, shift, active, field, mass, flux, gap, reach, ghosts, dt, parts, limited):
    """Transport `field` (S,) by mass fluxes (d, S) [kg/s] over dt, in place, with `mass` (S,) [kg] that follows.

    `shift` is 0 for cells; for the velocity along axis a it is that axis' stride, and a control volume then
    takes half of each neighbour's fluxes. Returns what was carried over each face (d, S) in all.
    """
    total, face = np.zeros_like(flux), np.zeros_like(flux)
    sub = dt / parts
    for _ in range(parts):
        fill(field, ghosts)
        for a in range(flux.shape[0]):
            _face_flux(wide, a, shift, field, mass, flux[a], gap[a], reach[a], sub, limited, face[a])
        _update(inner, shift, active, field, mass, flux, face, sub)
        total += sub * face
    return total
