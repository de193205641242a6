"""Places that grains and gas get to within a run: which inlet's gas meets the grains, how far grains come towards each
side."""

from __future__ import annotations

import itertools
import math
from typing import NamedTuple

from sdph.effects.around.outflow import outlets_of
from sdph.effects.gas import reaction
from sdph.engine.geometry import PAIRS

CAVITY = 4.2  # a stream past a cavity of width w fades in it as exp(-4.2 y/w): Moffatt 1964, J. Fluid Mech. 18, 1
SETTLED = 0.95  # of the onset of lasting contacts, from which on grains lie on each other; our choice
FADED = 1e-3  # of an inlet's speed, below which gas is at rest; our choice


class Reach(NamedTuple):
    """The side that grains come nearest to: their way towards it [m], and that over the gap between them and it."""

    way: float
    over_gap: float


def strength(case, boundary, patches) -> float:
    """Share of an inlet's speed that its gas has at the grains: 1 where they lie in its stream or no span tells, less
    aside."""
    if boundary.span is None or boundary.side is None:
        return 1.0
    axis = next(a for a, pair in enumerate(PAIRS) if boundary.side in pair)
    spans = spans_of(boundary)
    tangential = [a for a in range(case.dimensions) if a != axis]
    asides = [max(_aside(patch, a, span) for a, span in zip(tangential, spans)) for patch in patches]
    share = math.exp(-CAVITY * min(asides, default=0.0) / case.domain.size[axis])
    return share if share > FADED else 0.0


def rush(s) -> float:
    """Speed [m/s] of gas that rushes in where grains cool it and out where they heat it, or burn in it; none at
    constant density. `s`: scales.

    At the start it is the change of volume of the patch in the time in which its gas takes the grains' temperature, the
    most it can be, or in which they strip it of its oxidant; of gas that is let in, its speed once it has that.
    """
    if s.gas.equation_of_state == "constant" or not s.alpha_p:
        return 0.0
    own, grains = s.gas.temperature, [patch.temperature for patch in s.patches]
    at_start = max(abs(own - each) for each in grains) / max(own, *grains) * s.length / s.still_heat_time
    burnt = 0.0
    if warmer := reaction.rise(s.case):
        hottest = max(s.case.temperatures) + warmer
        burnt = warmer / own * s.length * reaction.stripping(s, hottest, max(s.jet, s.thrown, s.falling, s.eddies))
    return max([at_start, burnt, *(speed * max(grains) / temperature for speed, temperature in s.fed)])


def spans_of(boundary) -> tuple:
    """(low, high) [m] of a boundary along each tangential axis of its side; none where it is the whole side."""
    if boundary.span is None:
        return ()
    return boundary.span if isinstance(boundary.span[0], tuple) else (boundary.span,)


def _aside(patch, axis: int, span) -> float:
    """Distance [m] between grains and a span along an axis; 0 where they overlap."""
    return max(patch.lower[axis] - span[1], span[0] - patch.upper[axis], 0.0)


def reach(s, out: bool) -> Reach:
    """The farthest that grains get, relative to the gap, towards sides that are open (`out`), in part or whole, or
    closed; those that stand within walls of their own are at them. `s`: scales."""
    found, spacing = [Reach(0.0, 0.0)], s.case.resolution.spacing
    within = not out and enclosed(s.case)
    for patch, axis, side, room, outward in _sides(s):
        if within or (outlets_of(s.case, side) if out else not opened(s.case, side)):
            way = towards(s, patch, axis, outward)
            if out and room < spacing:
                way = max([way, _slumps(s.case, patch, axis, side)])
            found.append(Reach(way, way / max(0.0 if within else room, 0.5 * spacing)))
    return max(found, key=lambda row: row.over_gap)


def _slumps(case, patch, axis: int, side: str) -> float:
    """Way [m] through an open side of a bed that leans on it: as far as it is high, as a column of grains that is let
    go (Lube et al. 2005: its run-out is one to two heights); 0 aside of it, and of what no floor carries."""
    up, tangential = upright(case), [a for a in range(case.dimensions) if a != axis]
    if axis == up or not lie(case, [patch]):
        return 0.0
    asides = [
        max((_aside(patch, a, span) for a, span in zip(tangential, spans_of(outlet))), default=0.0)
        for _, outlet in outlets_of(case, side)
    ]
    return float(patch.upper[up] - patch.lower[up]) if min(asides, default=math.inf) == 0.0 else 0.0


def settles(s, onset: float) -> bool:
    """True where their weight takes grains, within the run, to a closed side, or a wall of their own, and on to the
    volume fraction `onset`; not where they are thrown, or gas lifts them. A bed on its floor comes back on itself where
    the slowest gas that is let in under it does not carry grains away."""
    lie_there = lie(s.case, s.patches)
    lifted = slowest(s.case) >= s.falling if lie_there else s.jet and not s.jet < s.minimum_fluidisation
    if s.thrown or lifted or not s.collides:
        return False
    for patch, axis, side, room, outward in _sides(s):
        within, down = enclosed(s.case), outward * s.case.domain.gravity[axis] > 0.0
        if down and (within or not opened(s.case, side)):
            closer = max(0.0, 1.0 - patch.alpha_p / onset) * (patch.upper[axis] - patch.lower[axis])
            if s.falling * s.end >= closer + (0.0 if within else room):
                return True
    return False


def _sides(s):
    """(patch, axis, name of the side, its distance [m] from the grains, -1 or 1: where it lies) of all patches."""
    domain = s.case.domain
    for patch, (axis, ends) in itertools.product(s.patches, enumerate(zip(domain.corner, domain.upper))):
        rooms = patch.lower[axis] - ends[0], ends[1] - patch.upper[axis]
        for side, room, outward in zip(PAIRS[axis], rooms, (-1.0, 1.0)):
            yield patch, axis, side, room, outward


def enclosed(case) -> bool:
    """True where grains fill what walls enclose, or walls have a mesh: nearer than the sides of the domain."""
    own = case.parameters["walls"] if "walls" in case.effects else None
    return any(region.shape == "walls" for region in case.particles.values()) or bool(own and own.mesh)


def slowest(case, pick=max) -> float:
    """Slowest gas [m/s] of those that are let in, as far as it goes against gravity; 0 where none does. Of gas whose
    velocity changes in time the `pick` of its rows."""
    up = upright(case)
    against = -math.copysign(1.0, case.domain.gravity[up])
    fed = [b for b in case.boundaries.values() if b.lets_in]
    given = [[row[1:] for row in b.velocities] if b.velocities else [b.velocity] for b in fed]
    return max(0.0, min((pick(row[up] * against for row in rows) for rows in given), default=0.0))


def belt(case) -> float:
    """Largest speed [m/s] of the walls that slide along under grains."""
    slides = [b.fastest for b in case.boundaries.values() if b.velocity and not b.lets_in]
    return max(slides, default=0.0) if "walls" in case.effects else 0.0


def rests(s) -> bool:
    """True where grains lie packed on a floor without an opening, and neither gas nor a wall that slides moves them."""
    own = s.case.parameters.get("friction")
    onset = own.onset if own else s.grains.packing_limit
    packed = s.alpha_p >= SETTLED * onset and not s.thrown and s.weight @ s.case.domain.gravity > 0.0
    held = lie(s.case, s.patches) and not pours(s.case, s.patches) and not belt(s.case)
    return packed and held and s.jet < s.minimum_fluidisation


def lie(case, patches) -> bool:
    """True where grains lie on a closed side that gravity points to."""
    axis = upright(case)
    end = int(case.domain.gravity[axis] > 0.0)
    low, high = case.domain.corner[axis], case.domain.upper[axis]
    rooms = [high - patch.upper[axis] if end else patch.lower[axis] - low for patch in patches]
    return not opened(case, PAIRS[axis][end]) and min(rooms, default=math.inf) < case.resolution.spacing


def pours(case, patches) -> bool:
    """True where grains lie on a side that is open under them, in part: they run out there."""
    axis = upright(case)
    side = PAIRS[axis][int(case.domain.gravity[axis] > 0.0)]
    tangential = [a for a in range(case.dimensions) if a != axis]
    asides = [
        max((_aside(patch, a, span) for a, span in zip(tangential, spans_of(outlet))), default=0.0)
        for patch in patches
        for _, outlet in outlets_of(case, side)
    ]
    return min(asides, default=math.inf) == 0.0


def poured_through(case, patches) -> float:
    """Narrowest width [m] of the outlets that grains pour through; 0 without any."""
    if not pours(case, patches):
        return 0.0
    side = PAIRS[upright(case)][int(case.domain.gravity[upright(case)] > 0.0)]
    return min((high - low for _, own in outlets_of(case, side) for low, high in spans_of(own)), default=0.0)


def upright(case) -> int:
    """The axis that gravity pulls along most."""
    return max(range(case.dimensions), key=lambda a: abs(case.domain.gravity[a]))


def opened(case, side: str) -> bool:
    """True where the whole of a side is a pressure outlet."""
    return any(outlet.span is None for _, outlet in outlets_of(case, side))


def towards(s, patch, axis: int, outward: float) -> float:
    """Way [m] that grains of a patch get along an axis within the run: thrown, spread, fallen, or blown along by the
    gas.

    Droplets of a cone part: sideways each is stopped by gas that the mouth has not loaded.
    """
    thrown = outward * patch.velocity[axis] * s.coasting
    alone = -s.drag_time * math.expm1(-s.end / s.drag_time)
    spread = math.hypot(*patch.velocity) * math.sin(patch.half_angle) * alone if not patch.velocity[axis] else 0.0
    fallen = s.falling * s.end if outward * s.weight[axis] > 0.0 else 0.0
    return max(0.0, thrown + spread + fallen + s.blown * s.end * _blows(s.case, axis, outward))


def _blows(case, axis: int, outward: float) -> bool:
    """True where gas that is let in may blow grains that way: a stream through a whole side goes straight on, one
    through part of it turns anywhere."""
    fed = [b for b in case.boundaries.values() if b.lets_in and any(b.strongest)]
    return any(b.span is not None or b.side is None or outward * b.strongest[axis] > 0.0 for b in fed)
