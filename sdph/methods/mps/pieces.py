"""Pieces of a liquid: particles that hang together, sheets, ligaments, drops."""

from __future__ import annotations

import numpy as np
from numba import prange

from sdph.engine import arrays
from sdph.engine import state as particles
from sdph.engine.cells import solid_of
from sdph.engine.geometry import OPEN
from sdph.engine.neighbours import Neighbours
from sdph.engine.rows import entry
from sdph.laws.compiled import parallel
from sdph.laws.sheets import diameter_of

RESOLVED = 10  # particles of a piece whose size is told by more than one spacing; swirl-sheet.md, section 7
# of the mass of all drops, that may be in smaller ones: beyond it the median by volume is that of drops whose size is
# the spacing's, and so are the mean that has the largest drops in it and all quantiles below; our choice
COARSE = 0.5


def labels(domain, state, rows, distance: float, period=(OPEN, OPEN, OPEN)) -> tuple[np.ndarray, int]:
    """Number (n,) of the piece of each of the particles in `rows` (n,), own ones and copies, and how many pieces there
    are: two are of one where they are nearer than `distance` [m], through a periodic side too. Pieces of all processes
    of a domain are counted by the least number that a particle of them has."""
    local = joined(tuple(axis[rows] for axis in domain.axes(state)), distance, period)
    label, changed = state.ident.copy(), True
    while changed:  # the least that a process knows of a piece goes on to those that have another part of it
        before, least = label[rows], label[rows]
        np.minimum.at(least, local, before)
        label[rows] = least[local]
        domain.refresh(label)
        changed = domain.world.any(bool((label[rows] != before).any()))
    names = np.unique(np.concatenate(domain.world.everywhere(np.unique(label[rows]))))
    return np.searchsorted(names, label[rows]), len(names)


def joined(axes, distance: float, period=(OPEN, OPEN, OPEN)):
    """The least row (N,) of the piece of each place, arrays (N,) [m] by axis.

    Each takes the least that it knows of its neighbours, and so does the row that it had taken before; then all take
    what that row has, until nothing changes (Shiloach & Vishkin 1982, J. Algorithms 3, 57).
    """
    count, near = len(axes[0]), Neighbours(distance, period, skin=0.0)
    kind = arrays.zeros(count, axes[0], np.int8)
    order = near.by_cell(axes, solid_of(kind))
    near.built = tuple(arrays.taken(axis, order) for axis in axes)
    rows, label = near.relist(kind), arrays.copy(order)
    place, found = (arrays.empty(count, order, np.int64) for _ in range(2))
    invert(order, place)
    while hook(rows, place, label):
        jump(place, label)
    put_back(order, label, found)
    return found


@parallel
def invert(order, place):
    """place (N,): where each row stands in an order (N,)."""
    for n in prange(len(order)):
        place[order[n]] = n


@parallel
def put_back(order, label, found):
    """found (N,): label (N,) of what stands in an order (N,), row by row."""
    for n in prange(len(order)):
        found[order[n]] = label[n]


@parallel
def hook(rows, place, label):
    """label (N,): the least among its neighbours, and so for the row that it was; the number of those that changed.
    Threads may be late to know of each other: that takes another round."""
    changed = 0.0
    for i in prange(len(label)):
        own = least = label[i]
        for k in range(rows.number[i]):
            least = min(least, label[entry(rows, i, k)])
        if least < own:
            label[i] = least
            label[place[own]] = min(least, label[place[own]])
            changed += 1.0
    return changed


@parallel
def jump(place, label):
    """label (N,): that of the row which it is, and so on, until it is its own."""
    for i in prange(len(label)):
        own, over = label[i], label[place[label[i]]]
        while over != own:
            own, over = over, label[place[over]]
        label[i] = own


def of(state, label, case) -> list[dict]:
    """Nozzle, particles, mass [kg], diameter [m], middle [m] and velocity [m/s] of each piece, label (N,), and the
    energy of motion in it [J]."""
    _, own = np.unique(label, return_inverse=True)
    mass = np.bincount(own, weights=state.mass)
    places, velocities = particles.positions(state), particles.velocities(state)
    middle, mean = (
        np.stack([np.bincount(own, weights=state.mass * column) for column in values.T], axis=1) / mass[:, None]
        for values in (places, velocities)
    )
    inner = 0.5 * np.bincount(own, weights=state.mass * ((velocities - mean[own]) ** 2).sum(axis=1))
    size = diameter_of(mass / case.liquid.density, case.dimensions)
    number, nozzle = np.bincount(own), _nozzles(state, own, case)
    return [
        {"nozzle": nozzle[k], "particles": int(number[k]), "mass_kg": float(mass[k]), "diameter_m": float(size[k])}
        | {f"{a}_m": float(value) for a, value in zip("xyz", middle[k])}
        | {f"velocity_{a}_m_s": float(value) for a, value in zip("xyz", mean[k])}
        | {"inner_J": float(inner[k])}
        for k in range(len(mass))
    ]


def _nozzles(state, own, case) -> list[str]:
    """Name of the nozzle that most of the mass of each piece is from, pieces own (N,); "" of what was there at the
    start."""
    names, found = ("", *case.nozzles), np.zeros((int(own.max(initial=-1)) + 1, len(case.nozzles) + 1))
    np.add.at(found, (own, state.nozzle if len(state.nozzle) else 0), state.mass)
    return [names[k] for k in found.argmax(axis=1)]


def sauter(diameters) -> float:
    """D32 = sum d^3/sum d^2 [m]; nan of nothing."""
    d = np.asarray(diameters, float)
    return float((d**3).sum() / (d**2).sum()) if len(d) else float("nan")


def mean(diameters) -> float:
    """D10 = sum d/N [m], the mean by number; nan of nothing."""
    return float(np.mean(diameters)) if len(diameters) else float("nan")


def percentile(diameters, share: float) -> float:
    """Diameter [m] below which `share` of the volume is; nan of nothing."""
    d = np.sort(np.asarray(diameters, float))
    if not len(d):
        return float("nan")
    return float(d[np.searchsorted(np.cumsum(d**3), share * (d**3).sum())])


def unresolved(diameters, whole) -> float:
    """Share of the mass of drops of diameters (n,) [m] that is in those that are not `whole` (n,)."""
    volume = diameters**3
    return 1.0 - float(volume[whole].sum() / volume.sum())


def coarse(diameters, counts) -> list[str]:
    """A line where drops of diameters (n,) [m] and of so many particles (n,) have sizes of the spacing."""
    share = unresolved(diameters, counts >= RESOLVED) if len(diameters) else 0.0
    if share <= COARSE:
        return []
    return [
        f"unresolved_mass_share = {share:.2g}: more than half of the liquid that left is in drops of fewer than "
        f"{RESOLVED} particles, whose sizes are of the spacing and not of the liquid; a finer resolution.spacing_mm "
        "changes them"
    ]


def sizes(diameters, whole) -> dict[str, float]:
    """Summary of drops of diameters (n,) [m], `whole` (n,) where they are resolved: D10, D32 and the percentiles of
    volume of all, D32 of those that are resolved, and the share of the mass that is not."""
    if not len(diameters):
        return {}
    found = {"sauter_mean_diameter_m": sauter(diameters[whole])} if whole.any() else {}
    return found | {
        "unresolved_mass_share": unresolved(diameters, whole),
        "sauter_mean_diameter_of_all_m": sauter(diameters), "mean_diameter_of_all_m": mean(diameters),
        **{f"volume_{n}_percent_below_m": percentile(diameters, n / 100.0) for n in (10, 50, 90)},
    }  # fmt: skip
