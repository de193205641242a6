"""Explicit transport of any field by given fluxes, bounded, in sub-steps of the window."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from coupling.embedded.linear import fill
from sdph.laws.by_reference import by_reference
from sdph.laws.compiled import serial

TURNOVER = 0.5  # of a cell's mass in one sub-step: up to here the scheme is bounded


@by_reference
class Nodes(NamedTuple):
    """Nodes of a field: rows of them and of the faces between them (see `Grid`); `shift` is 0 for cells, and for the
    velocity along an axis that axis' stride: a control volume then takes half of each neighbour's fluxes; `active`
    (S,): nodes that change; gap, reach (d, S) between nodes."""

    inner: tuple
    wide: tuple
    shift: np.uint64
    active: np.ndarray
    gap: np.ndarray
    reach: np.ndarray


@serial
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


@serial
def substeps(inner, flux, before, after, dt):
    """Sub-steps in which no cell lets more than `TURNOVER` of its mass out or in, and the Courant number of the
    window."""
    rows, run, steps = inner
    share, courant = 0.0, 0.0
    for row in rows:
        for c in range(row, row + run):
            gained, through = 0.0, 0.0
            for a in range(len(steps)):
                gained += flux[a, c] - flux[a, c + steps[a]]
                through += abs(flux[a, c]) + abs(flux[a, c + steps[a]])
            mass = before[c] if before[c] < after[c] else after[c]
            share = max(share, 0.5 * (through + abs(gained)) / mass)  # the larger of what goes in and out
            courant = max(courant, 0.5 * through / mass)
    return math.ceil(share * dt / TURNOVER), courant * dt


@serial
def _face_flux(nodes, a, field, mass, flux, sub, limited, face):
    """Flux of the field through each face of axis a, into face (S,)."""
    rows, run, steps = nodes.wide
    s, shift, gap, reach = steps[a], nodes.shift, nodes.gap[a], nodes.reach[a]
    for row in rows:
        for f in range(row, row + run):
            through = 0.5 * (flux[f - shift] + flux[f])
            courant = 2.0 * sub * abs(through) / (mass[f - s] + mass[f])
            values = (field[f - s - s], field[f - s], field[f], field[f + s])
            gaps = (gap[f - s], gap[f], gap[f + s])
            face[f] = through * carried(through, courant, values, gaps, reach[f], limited)


@serial
def _update(nodes, field, mass, flux, face, sub, follows):
    """Field and mass of every node after a sub-step."""
    rows, run, steps = nodes.inner
    shift, active = nodes.shift, nodes.active
    for row in rows:
        for c in range(row, row + run):
            content, gained = mass[c] * field[c], 0.0
            for a in range(len(steps)):
                s = steps[a]
                content += sub * (face[a, c] - face[a, c + s])
                gained += flux[a, c] + flux[a, c - shift] - flux[a, c + s] - flux[a, c + s - shift]
            gained *= 0.5 * sub
            content -= 0.0 if follows else gained * field[c]
            mass[c] += gained if follows else 0.0
            field[c] = content / mass[c] if active[c] else field[c]


@serial
def _ahead(field, exchange):
    """Field that faces carry: half a window's exchange on, with the (share kept, gain) of every node."""
    if len(exchange) == 0:
        return field
    return exchange[0] * field + exchange[1]


@serial
def convect(nodes, ghosts, field, mass, flux, dt, parts, limited, follows, exchange):
    """Transport `field` (S,) of nodes of `mass` (S,) [kg] by mass fluxes (d, S) [kg/s] over dt, in place.

    `follows`: the mass takes what the fluxes bring, and content is conserved; otherwise it stays, and a uniform
    field does too, whatever the fluxes. `exchange`, see `_ahead`, or (): with it transport and the exchange after it
    are second order in time together, as each of them is alone. Returns what was carried over each face (d, S) in all.
    """
    total, face = np.zeros_like(flux), np.zeros_like(flux)
    sub = dt / parts
    for _ in range(parts):
        ahead = _ahead(field, exchange)
        fill(ahead, ghosts)
        for a in range(flux.shape[0]):
            _face_flux(nodes, a, ahead, mass, flux[a], sub, limited, face[a])
        _update(nodes, field, mass, flux, face, sub, follows)
        total += sub * face
    return total
