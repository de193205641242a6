"""Space cut among processes by recursive bisection: each cut halves, across the longest way, what weighs on its ranks
(Berger & Bokhari 1987, IEEE Trans. Comput. C-36, 570)."""

from __future__ import annotations

import numpy as np

BINS, ROUNDS = 256, 2  # of the search for a cut: a 65536th of the way is as near as it gets; our choice
ROUND_OFF = 16.0 * np.finfo(float).eps  # of the largest place, more than four sums of places lose


def cut(world, places: np.ndarray, weight: np.ndarray, ranks: range | None = None):
    """Tree of cuts for places (N, d) [m] of weight (N,) that the processes of a world have together: the number of a
    rank, or (axis, value [m], what lies below, what does not)."""
    ranks = range(world.number) if ranks is None else ranks
    if len(ranks) == 1:
        return ranks[0]
    low = world.least(places.min(axis=0, initial=np.inf))
    high = world.most(places.max(axis=0, initial=-np.inf))
    axis, half = int(np.argmax(high - low)), len(ranks) // 2
    value = _quantile(world, places[:, axis], weight, (low[axis], high[axis]), half / len(ranks))
    below = places[:, axis] < value
    sides = (below, ranks[:half]), (~below, ranks[half:])
    return axis, value, *(cut(world, places[side], weight[side], own) for side, own in sides)


def owner(tree, places: np.ndarray) -> np.ndarray:
    """Rank (N,) whose part of space each of the places (N, d) [m] is in."""
    if isinstance(tree, int):
        return np.full(len(places), tree)
    axis, value, below, above = tree
    out, under = np.empty(len(places), int), places[:, axis] < value
    out[under], out[~under] = owner(below, places[under]), owner(above, places[~under])
    return out


def near(places: np.ndarray, low, high, reach: float, period) -> np.ndarray:
    """Mask (N,) of the places (N, d) [m] within `reach` [m] of a box, whatever the turn where `period` [m] is not 0; of
    a box that holds nothing, whose ends are infinite, none are."""
    found = np.full(len(places), bool((low <= high).all()))
    for a in range(places.shape[1] if found.any() else 0):
        off, width = places[:, a] - (low[a] - reach), high[a] - low[a] + 2.0 * reach
        found &= (np.mod(off, period[a]) if period[a] else off) <= width
        found &= (off >= 0.0) | (period[a] > 0.0)
    return found


def beside(ends: np.ndarray, rank: int, reach: float, period) -> np.ndarray:
    """Mask (P,) of the other boxes, of ends (P, 2, d) [m], that come within `reach` [m] of that of a rank; a box that
    holds nothing has infinite ends."""
    found = np.isfinite(ends).all(axis=(1, 2))
    ends = np.where(found[:, None, None], ends, 0.0)
    reach = reach + ROUND_OFF * np.abs(ends).max()
    found &= found[rank] & (np.arange(len(ends)) != rank)
    low, width = ends[:, 0], ends[:, 1] - ends[:, 0] + 2.0 * reach
    for a in range(ends.shape[2]):
        there, here = low[:, a] - low[rank, a] + reach, low[rank, a] - low[:, a] + reach
        if period[a]:
            there, here = np.mod(there, period[a]), np.mod(here, period[a])
        ours, theirs = (there >= 0.0) & (there <= width[rank, a]), (here >= 0.0) & (here <= width[:, a])
        found &= ours | theirs  # the same for both of a pair, to the last digit: each waits for the other
    return found


def _quantile(world, along: np.ndarray, weight: np.ndarray, ends: tuple[float, float], share: float) -> float:
    """Place [m] below which lies that share of the weight."""
    low, high = ends
    if not low < high:  # all are at one place, or there are none
        return float(high) if np.isfinite(high) else 0.0
    wanted, before = share * world.sum(float(weight.sum())), 0.0
    for _ in range(ROUNDS):
        if high - low < 2.0 * BINS * np.spacing(max(abs(low), abs(high))):
            break  # as near as numbers are
        inside = (along >= low) & (along <= high)
        bins, edges = np.histogram(along[inside], BINS, (low, high), weights=weight[inside])
        sums = before + np.cumsum(world.sum(bins))
        chosen = min(int(np.searchsorted(sums, wanted)), BINS - 1)
        before = float(sums[chosen - 1]) if chosen else before
        low, high = float(edges[chosen]), float(edges[chosen + 1])
    return high
