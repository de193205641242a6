"""Explicit transport of any field by given fluxes, bounded, in sub-steps of the window."""

from __future__ import annotations

import numpy as np
from numba import njit

from coupling.embedded.linear import fill

OUTFLOW = 0.5  # of a cell's mass that may leave in one sub-step; the scheme is bounded up to 1/2


@njit(error_model="numpy")
def carried(field, f, step, flux, gap, reach, courant, limited):
    """Value at face f of what `flux` carries: upwind, or with van Leer's slope (J. Comput. Phys. 14, 361, 1974),
    the harmonic mean of the slopes ahead and behind, advanced by half the Courant number (second order in time)."""
    if flux >= 0.0:
        up, ahead, behind, distance = field[f - step], (field[f] - field[f - step]) / gap[f], (field[f - step] - field[f - 2 * step]) / gap[f - step], reach[f]
    else:
        up, ahead, behind, distance = field[f], (field[f - step] - field[f]) / gap[f], (field[f] - field[f + step]) / gap[f + step], gap[f] - reach[f]
    product = ahead * behind
    if not limited or product <= 0.0:
        return up
    rise = 2.0 * product / (ahead + behind) * distance * max(0.0, 1.0 - courant)
    most = ahead * gap[f]  # beyond the next value only where cells differ in width: bounded there too
    return up + (min(rise, most) if most > 0.0 else max(rise, most))


@njit(cache=True, error_model="numpy")
def substeps(rows, run, strides, flux, before, after, dt):
    """Sub-steps for which no cell loses more than `OUTFLOW` of its mass, and the Courant number of the window."""
    share, courant = 0.0, 0.0
    for row in rows:
        for c in range(row, row + run):
            out, through = 0.0, 0.0
            for s, f in zip(strides, flux):
                out += max(f[c + s], 0.0) - min(f[c], 0.0)
                through += abs(f[c + s]) + abs(f[c])
            mass = min(before[c], after[c])
            share = max(share, out * dt / mass)
            courant = max(courant, 0.5 * through * dt / mass)
    return int(np.ceil(share / OUTFLOW)), courant


@njit(cache=True, error_model="numpy")
def convect(rows, run, wide_rows, wide_run, strides, shift, active, field, mass, flux, gap, reach, ghosts, dt, parts, limited):
    """Transport `field` (S,) by mass fluxes (d, S) [kg/s] over dt, in place, with `mass` (S,) [kg] that follows.

    `shift` is 0 for cells; for the velocity along axis a it is that axis' stride, and a control volume then
    takes half of each neighbour's fluxes. Returns the mean flux (d, S) of what was carried.
    """
    mean, face = np.zeros_like(flux), np.zeros_like(flux)
    sub = dt / parts
    for _ in range(parts):
        fill(field, ghosts)
        for a in range(len(strides)):
            s = strides[a]
            for row in wide_rows:
                for f in range(row, row + wide_run):
                    through = 0.5 * (flux[a, f - shift] + flux[a, f])
                    courant = 2.0 * sub * abs(through) / max(mass[f - s] + mass[f], 1e-300)
                    face[a, f] = through * carried(field, f, s, through, gap[a], reach[a], courant, limited)
                    mean[a, f] += face[a, f] / parts
        for row in rows:
            for c in range(row, row + run):
                if active[c]:
                    content, gained = mass[c] * field[c], 0.0
                    for a in range(len(strides)):
                        s = strides[a]
                        content += sub * (face[a, c] - face[a, c + s])
                        gained += 0.5 * (flux[a, c] + flux[a, c - shift] - flux[a, c + s] - flux[a, c + s - shift])
                    mass[c] += sub * gained
                    field[c] = content / mass[c]
    return mean
