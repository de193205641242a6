"""Grains or liquid that leave the domain through its open sides are taken out and counted."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from sdph.effects.effect import Effect, Judgement
from sdph.engine import arrays
from sdph.engine import state as particles
from sdph.engine.geometry import PAIRS, SIDES
from sdph.engine.state import GRAIN, LIQUID
from sdph.engine.walls import openings
from sdph.laws.kernels import SUPPORT
from sdph.schema import CaseError, record


@record
class Outflow:
    """Has no input of its own: grains leave through every pressure_outlet, into walls that catch them, and where no
    `walls` hold them; liquid every side of the domain on which no wall of a box stands."""


class OutflowP(NamedTuple):
    """1 where walls hold grains back at the other sides, else 0."""

    walls: int


def kernel(case) -> OutflowP:
    if not case.grains and not open_sides(case):
        raise CaseError("outflow: walls of the tank are all around; name a side in tank.open_sides, or leave it out")
    if case.gas_phase is not None:
        raise CaseError("outflow takes a liquid of one phase out, and there is [gas_phase]; leave one of the two out")
    return OutflowP(int("walls" in case.effects))


def leaving(case, state, foreseen: bool = False) -> np.ndarray:
    """Mask of the grains that are out of the domain through an open side, or behind an outlet of the mesh of the gas,
    and go outwards. `foreseen` places are those of grains that no wall has turned back yet: only outlets count then."""
    gone, places = behind(case, state) >= 0, particles.axes(state)
    for side, axis, out in _beyond(case, state):
        gone |= out & (_outlets if foreseen else _open)(case, side, axis, places)
    return gone & (state.kind == GRAIN)


def exits(case) -> list[str]:
    """Names of what grains can leave through: pressure outlets and walls that catch them, in a box those on sides, then
    sides as such, `left_side` and so on."""
    every = [name for name, own in case.boundaries.items() if own.lets_out]
    outlets = [name for name in every if case.boundaries[name].side or _of_patches(case)]
    return outlets + [f"{side}_side" for pair in PAIRS[: case.dimensions] for side in pair]


def through(case, state) -> np.ndarray:
    """Number among `exits` (N,) of what each of the grains that left went through: an outlet where it is beyond one."""
    names, places = exits(case), particles.axes(state)
    found = np.full(len(state.x), -1)
    for side, axis, out in _beyond(case, state):
        found[out & (found < 0) & _open(case, side, axis, places)] = names.index(f"{side}_side")
    for side, axis, out in _beyond(case, state):
        for name, outlet in outlets_of(case, side):
            found[out & _within(outlet, axis, places)] = names.index(name)
    patch = behind(case, state)
    for number, name in enumerate(case.boundaries):
        if name in names:
            found[patch == number] = names.index(name)
    return found


def behind(case, state):
    """(N,) number of the boundary of the gas's mesh, an outlet, that each particle is behind and goes on away from, no
    further than a window takes it; -1 of the others."""
    if not len(state.x) or not _of_patches(case):
        return arrays.zeros(len(state.x), state.x, np.int64) - 1
    found = openings.read(case.parameters["walls"].mesh, case.dimensions)
    moved = case.coupling.courant * case.resolution.cell  # by a window
    return openings.behind(found, state, moved + SUPPORT * case.smoothing_length)


def _beyond(case, state):
    """(side, its axis, mask (N,) of what is beyond it and goes outwards) of the sides of the domain that something is
    beyond. Who is beyond a periodic one for a moment is on its way round; who goes inwards comes from a mouth that
    leans."""
    if not len(state.x):
        return
    moves = zip(particles.axes(state), (state.u, state.v, state.w))
    ends = zip(moves, case.domain.corner, case.domain.upper, case.domain.period)
    for axis, ((place, speed), low, high, period) in enumerate(ends):
        out_of_either = (place < low) & (speed <= 0.0), (place > high) & (speed >= 0.0)
        for side, out in zip(PAIRS[axis], out_of_either):
            if not period and out.any():
                yield side, axis, out


def left(case, state) -> np.ndarray:
    """Mask of the liquid that is out of the domain through an open side and goes outwards."""
    gone = np.zeros(len(state.x), bool)
    low, high = case.domain.corner, case.domain.upper
    for axis, side in open_sides(case):
        place, speed = particles.axes(state)[axis], (state.u, state.v, state.w)[axis]
        gone |= (place > high[axis]) & (speed >= 0.0) if side else (place < low[axis]) & (speed <= 0.0)
    return gone & (state.kind == LIQUID)


def open_sides(case) -> list[tuple[int, int]]:
    """Axis and end (0 or 1) of the sides of the domain where no wall of the tank stands, so that liquid leaves."""
    periodic = case.liquid.periodic or (0,) * case.dimensions
    ends = [(axis, end) for axis in range(case.dimensions) if not periodic[axis] for end in (0, 1)]
    if "tank" not in case.effects:
        return ends
    own, domain = case.parameters["tank"], (case.domain.corner, case.domain.upper)
    if own.shape == "outline":  # whose sides there lie in those of the domain
        return [side for side in ends if side in without_wall(own)]
    if own.shape != "box":
        return []
    walls = own.lower or domain[0], own.upper or domain[1]
    away = {(axis, end) for axis, end in ends if walls[end][axis] != domain[end][axis]}
    return [side for side in ends if side in away | without_wall(own)]


def without_wall(own) -> set[tuple[int, int]]:
    """Axis and end of the sides of a box that have no wall: a wall within the domain closes its side."""
    named = [own.open_sides] if isinstance(own.open_sides, str) else own.open_sides
    return {SIDES[name] for name in named}


def refuse_to_leave(case, state, gone, time: float) -> None:
    """CaseError where grains left, mask (N,), at `time` [s] in a case without this effect: there is no gas outside."""
    first = int(np.flatnonzero(gone)[0])
    way, cure = exits(case)[through(case, state)[first]], "outflow"
    if way.endswith("_side") and "walls" not in case.effects:
        way, cure = f"{way}, where no wall holds grains without the effect walls", "walls, or outflow,"
    elif way.endswith("_side") and (patches := _rest(case)):
        way = f"{way} ({' or '.join(patches)})"
    place = ", ".join(f"{axis[first]:.4g}" for axis in particles.axes(state))
    number = int(gone.sum())
    raise CaseError(
        f"{number} {'particle has' if number == 1 else 'particles have'} left the domain at t = {time:.6g} s, the "
        f"first is {state.ident[first]} at ({place}) m, through {way}; begin anew and add {cure} to effects = "
        f"{list(case.effects)}{_larger(case)}"
    )


def _rest(case) -> list[str]:
    """Names of the outlets without a side: patches of a mesh, or all of a box that is left over."""
    return [name for name, own in case.boundaries.items() if own.lets_out and not own.side]


def _larger(case) -> str:
    if _of_patches(case):  # the domain is the box around a mesh that is given
        return ""
    return f"; or give a larger domain.size_m = {list(case.domain.size)}"


def _of_patches(case) -> bool:
    own = case.parameters.get("walls")
    return own is not None and bool(own.mesh) and own.source == "gas"


def _open(case, side: str, axis: int, places) -> np.ndarray:
    if case.parameters.get("walls") is None or _of_patches(case):  # patches hold grains wherever they are no outlet
        return arrays.ones(len(places[0]), places[0]) > 0.0
    return _outlets(case, side, axis, places)


def _outlets(case, side: str, axis: int, places) -> np.ndarray:
    """Mask (N,) of what is beyond an outlet: one that names the side, or in a box one that has what no other names."""
    found, named = (arrays.zeros(len(places[0]), places[0], np.bool_) for _ in range(2))
    for own in case.boundaries.values():
        if own.side == side:
            here = _within(own, axis, places)
            named |= here
            found |= here & own.lets_out
    first = next((own for own in case.boundaries.values() if own.side is None), None)
    return found | ~named if first and first.lets_out and not _of_patches(case) else found


def outlets_of(case, side: str) -> list:
    """(name, boundary) of what lets grains out on a side."""
    return [(name, b) for name, b in case.boundaries.items() if b.side == side and b.lets_out]


def _within(boundary, axis: int, places) -> np.ndarray:
    """Mask (N,) of what is within the span of a boundary whose side is across an axis."""
    tangential = [place for a, place in enumerate(places) if a != axis]
    spans = _spans(boundary.span, len(tangential))
    return np.logical_and.reduce([(t >= low) & (t <= high) for t, (low, high) in zip(tangential, spans)])


def _spans(span, count: int):
    if span is None:
        return ((-np.inf, np.inf),) * count
    return span if isinstance(span[0], tuple) else (span,)


def call(scales) -> Judgement:
    """Way of the grains within the run over their way to the nearest open side: past 1 they are out of the gas."""
    if not hasattr(scales, "to_outlets"):  # of a liquid; beside grains the openings are theirs
        down = np.array(scales.case.domain.gravity)
        own = scales.case.parameters["tank"] if "tank" in scales.case.effects and not scales.case.grains else None
        there = set(open_sides(scales.case)) & without_wall(own) if own else ()
        counts = sum((2 * end - 1) * down[a] >= 0.0 for a, end in there)
        return Judgement("open sides that are not above", float(counts), 1.0, "geometry", 1.0 if counts else 0.0)
    over_gap = scales.to_outlets.over_gap
    return Judgement(
        "way of the grains / gap to an open side", over_gap, 1.0, "geometry", 1.0 if over_gap >= 1.0 else 0.0
    )


EFFECT = Effect(
    name="outflow",
    summary="grains or liquid that leave through open sides",
    parameters=Outflow,
    kernel=kernel,
    moves=True,
    matter=("grains", "liquid"),
    sums=("injected_kg", "left_kg"),
    call=call,
)
