"""The particles: a flat tuple of C-contiguous arrays, one row a particle.

Positions and velocities are separate arrays per axis. `z` and `w` have length zero in two dimensions, and every
array of an effect that is off has length zero: kernels decide by type or length, never by a flag per particle.
In two dimensions masses are per metre of depth [kg/m].

Compiled loops take the whole tuple, by reference. States are of five classes (`CLASSES`): each holds what its particles
can have, and a loop that names another array does not compile.
"""

from __future__ import annotations

from collections import namedtuple

import numpy as np

from sdph.engine import arrays
from sdph.laws.by_reference import by_reference

# values of `kind`, of all methods alike; INFLOW: still upstream of its nozzle. Files hold them: they stay as they are
GRAIN, WALL, LIQUID, GAS, INFLOW, SOLID = range(6)


# there within a window alone
HELD = (
    "warmth", "push_x", "push_y", "push_z", "damping", "damped", "way_x", "way_y", "way_z", "row",
)  # fmt: skip

# name -> (unit, meaning)
FIELDS = {
    "x": ("m", "position"), "y": ("m", "position"), "z": ("m", "position"),
    "u": ("m/s", "velocity"), "v": ("m/s", "velocity"), "w": ("m/s", "velocity"),
    "mass": ("kg", "mass, per metre of depth in two dimensions"),
    "density": ("kg/m3", "alpha_p of all grains times rho_p of its own, by summation"),
    "ident": ("1", "number that a particle keeps for life"),
    "kind": ("1", "0 grain, 1 wall, 2 liquid, 3 gas beside a liquid, 4 grain upstream of its nozzle, 5 solid"),
    "nozzle": ("1", "number of the nozzle that it comes from, counted from 1; 0: of none"),
    "entering": ("1", "1 until it is half a layer through its nozzle, then 0"),
    "entered": ("s", "start of the window in which it came in; 0 of those that were there"),
    "temperature": ("K", "temperature of the grains"),
    "diameter": ("m", "number mean of the grain diameters"),
    "diameter_variance": ("m2", "number variance of the grain diameters"),
    "material": ("1", "number of its material, counted from 0; of grains of several, as the next three"),
    "grain_density": ("kg/m3", "density rho_p of its material"),
    "grain_capacity": ("J/kg/K", "specific heat of its material"),
    "grain_conductivity": ("W/m/K", "conductivity of its material"),
    "theta": ("m2/s2", "granular temperature"),
    **{f"contact_{ab}": ("Pa", f"deviator of the stress of lasting contacts, {ab}") for ab in ("xx", "yy", "xy", "yz",
    "zx")},
    "evaporating": ("1", "1 once evaporation has started"),
    "born_mass": ("kg", "mass at the start or when it came in"),
    "born_diameter": ("m", "number mean of the grain diameters then"),
    "born_variance": ("m2", "number variance of the grain diameters then"),
    "lost_still": ("m2", "loss of d^2 as in still gas (sdph.laws.grain_loss)"),
    "lost_moving": ("m^(3/2)", "further loss by the flow around the grains (the same)"),
    "lost_kinetic": ("m3", "loss times the length by which a reaction is slow (sdph.laws.burn_off)"),
    "deformation": ("1", "shift of a drop's equator over half its radius; it breaks at 1 (sdph.laws.break_up)"),
    "deformation_rate": ("1/s", "its rate"),
    "weber": ("1", "Weber number of the radius in the last window"),
    **{f"eddy_{a}": ("1", "velocity of the eddy that it is in, over the mean fluctuation") for a in "xyz"},
    "wall_age": ("s", "time that it has been beside a wall that heats it; 0 elsewhere"),
    "begun_temperature": ("K", "temperature when the window began"),
    "warming": ("K/s", "rate of its temperature in the last window, but for what a bubble took"),
    "received": ("W", "heat from the gas in the last window"),
    "exchanged": ("1", "1 if it was in the gas in the last window"),
    "viscosity": ("Pa s", "viscosity of a liquid where it is not the same everywhere"),
    "depth": ("m", "how far a wall particle lies behind the surface of its wall; 0 of others"),
    "enclosure": ("1", "smallest eigenvalue of the renormalisation matrix of a liquid: 1 inside, 0 alone"),
    "pressure": ("Pa", "pressure that the next one is looked for from, where an equation gives it (mps)"),
    "sealed": ("1", "1 as long as the shell of a gel droplet holds vapour in, then 0"),
    "throwing": ("s", "time for which a torn droplet still throws vapour"),
    "bubble_void": ("m3", "bubble in each of its droplets; 0: none yet"),
    "bubble_temperature": ("K", "temperature of that bubble"),
    "bubble_heat": ("J", "heat in the bubbles of all its droplets"),
    "shell_flow": ("1", "plastic strain of the shell, with its sign"),
    "spot_flow": ("1", "the same of its flaw"),
    **{f"{part}_hard": ("1", "part of it that hardens") for part in ("shell", "spot")},
    **{f"{part}_harm": ("1", "damage (sdph.laws.strength)") for part in ("shell", "spot")},
    **{f"{part}_swell": ("1", "logarithm of the change of volume") for part in ("shell", "spot")},
    "spot_hoop": ("1", "hoop strain of the flaw"),
    # what holds over a window, and is there within it alone
    "warmth": ("J", "heat from the gas in the window"),
    **{f"push_{a}": ("m/s2", "acceleration by gas and gravity") for a in "xyz"},
    "damping": ("1/s", "rate at which the gas damps theta"),
    "damped": ("J", "energy of theta that went into the gas"),
    **{f"way_{a}": ("m", "mean velocity of every sub-step times its length") for a in "xyz"},
    "row": ("1", "row that the particle had when the window began"),
    "copy": ("1", "1 of a particle that another process has, of those that share a run (sdph.engine.domain)"),
}  # fmt: skip
ALWAYS = ("x", "y", "u", "v", "mass", "density", "ident", "kind")
IN_SPACE = {"z", "w", "contact_yz", "contact_zx", "eddy_z", "push_z", "way_z"}  # of length zero in two dimensions
OF_MATERIAL = ("material", "grain_density", "grain_capacity", "grain_conductivity")  # there where grains are of several
INTEGERS = {
    "ident": np.int64,
    "kind": np.int8,
    "material": np.int8,
    "nozzle": np.int32,
    "entering": np.int8,
    "exchanged": np.int8,
    "row": np.int64,
    "copy": np.int8,
}

# arrays that not every state holds, by who has them; `CLASSES` join them
OF_LIQUIDS = ("viscosity", "depth", "enclosure", "pressure")
OF_GRAINS = (
    "diameter", "diameter_variance", *OF_MATERIAL, "entered", "theta", "contact_xx", "contact_yy", "contact_xy",
    "contact_yz", "contact_zx", "wall_age", "begun_temperature", "warming", "received", "exchanged", "warmth",
    "damping", "damped", "way_x", "way_y", "way_z", "row",
)  # fmt: skip
OF_DROPLETS = (
    "evaporating", "born_mass", "born_diameter", "born_variance", "lost_still", "lost_moving", "lost_kinetic",
    "deformation", "deformation_rate", "weber", "eddy_x", "eddy_y", "eddy_z", "sealed", "throwing",
)  # fmt: skip
OF_GEL = (
    "bubble_void", "bubble_temperature", "bubble_heat", "shell_flow", "shell_hard", "shell_harm", "shell_swell",
    "spot_flow", "spot_hard", "spot_harm", "spot_swell", "spot_hoop",
)  # fmt: skip
NONE = {name: np.zeros(0, INTEGERS.get(name, np.float64)) for name in FIELDS}


class State:
    """All that particles carry, see `FIELDS` for units; an array that its class does not hold has length zero."""

    __slots__ = ()

    def __getattr__(self, name: str) -> np.ndarray:
        if name in FIELDS:
            return NONE[name]
        raise AttributeError(f"a state has no {name}")


def _class(name: str, doc: str, *without: str) -> type[State]:
    held = namedtuple(name, [field for field in FIELDS if field not in without])
    return by_reference(type(name, (held, State), {"__slots__": (), "__module__": __name__, "__doc__": doc}))


Plain = _class("Plain", "What particles of any kind carry.", *OF_LIQUIDS, *OF_GRAINS, *OF_DROPLETS, *OF_GEL)
Liquid = _class("Liquid", "The same, and what liquids carry.", *OF_GRAINS, *OF_DROPLETS, *OF_GEL)
Grains = _class("Grains", "What grains carry that stay as they are.", *OF_LIQUIDS, *OF_DROPLETS, *OF_GEL)
Droplets = _class("Droplets", "What grains carry that shrink, break up or are thrown about.", *OF_LIQUIDS, *OF_GEL)
Whole = _class("Whole", "All there is.")
CLASSES = Plain, Liquid, Grains, Droplets, Whole


def class_of(names) -> type[State]:
    """The narrowest class that holds arrays of these `names`."""
    names = set(names)
    return next(held for held in CLASSES if names.issubset(held._fields))


def empty(count: int, names=ALWAYS, dimensions: int = 2, least: type[State] = Plain) -> State:
    """A state of `count` particles, zero everywhere, of a class that holds what `least` holds; arrays not among `names`
    have length zero."""
    present = {*ALWAYS, *names, "z", "w"} - (set() if dimensions == 3 else IN_SPACE)
    held = class_of({*least._fields, *names})
    return held(*(np.zeros(count if name in present else 0, INTEGERS.get(name, np.float64)) for name in held._fields))


def _map(function, *states: State) -> State:
    held = class_of(name for state in states for name in state._fields)
    same = ([getattr(state, name) for state in states] for name in held._fields)
    return held(*(function(*arrays) if any(len(a) for a in arrays) else arrays[0] for arrays in same))


def take(state: State, rows: np.ndarray) -> State:
    """The given rows (indices or mask) of every array: sorting, removing, choosing."""
    rows = arrays.chosen(rows) if rows.dtype == bool else rows
    return _map(lambda array: arrays.taken(array, rows), state)


def first(state: State, count: int) -> State:
    """The first `count` particles: a view, so that what is written there is written in the state."""
    return state._make(array[:count] for array in state)


def join(first: State, second: State) -> State:
    """Both one after the other."""
    return _map(arrays.joined, first, second)


def brought(state: State) -> State:
    """The same in memory."""
    return state._make(map(arrays.brought, state))


def axes(state: State) -> tuple[np.ndarray, ...]:
    """The position arrays of the dimensions that there are."""
    return (state.x, state.y, state.z) if len(state.z) else (state.x, state.y)


def pushes(state: State) -> tuple[np.ndarray, ...]:
    """The accelerations that hold over a window, of the dimensions that there are."""
    return (state.push_x, state.push_y, state.push_z) if len(state.z) else (state.push_x, state.push_y)


def positions(state: State) -> np.ndarray:
    """(N, 3) positions [m]; z is zero in two dimensions."""
    return vectors(state.x, state.y, state.z)


def velocities(state: State) -> np.ndarray:
    """(N, 3) velocities [m/s]."""
    return vectors(state.u, state.v, state.w)


def lengths(vectors: np.ndarray) -> np.ndarray:
    """Lengths (N,) of vectors (N, 3), four times as fast as a sum along the last axis."""
    return np.sqrt(np.einsum("ij,ij->i", vectors, vectors))


def vectors(a, b, c) -> np.ndarray:
    """(N, 3) of three arrays; the last is zero in two dimensions."""
    return arrays.vectors(a, b, c)


def by_material(values: np.ndarray, common: float):
    """Values (N,) of each particle's own material, or the one of all grains where they are of one."""
    return values if len(values) else common


def energy_of_motion(state: State) -> float:
    """Kinetic energy and that of theta [J]."""
    velocity = velocities(state)
    agitated = float(1.5 * state.mass @ state.theta) if len(state.theta) else 0.0
    return float(0.5 * np.einsum("i,ij,ij->", state.mass, velocity, velocity)) + agitated


def born(state: State) -> State:
    """The same, with mass and sizes at birth set to those of now, and shells whole."""
    if len(state.born_mass):
        state.born_mass[:], state.born_diameter[:], state.born_variance[:] = (
            state.mass,
            state.diameter,
            state.diameter_variance,
        )
    if len(state.sealed):
        state.sealed[:] = 1.0
    return state


def wet(state: State) -> np.ndarray:
    """Mask of the particles that move by the equations of liquids."""
    return (state.kind == LIQUID) | (state.kind == GAS)


def forced(state: State, warmth, push, damping) -> State:
    """The same under what holds over a window: push (N, 3) [m/s2], and of grains warmth (N,) [J] and damping (N,)
    [1/s]."""
    x, y, z = arrays.columns(push)
    state = state._replace(push_x=x, push_y=y, push_z=z if len(state.z) else z[:0])
    return state._replace(warmth=warmth, damping=damping) if len(warmth) else state


def followed(state: State) -> State:
    """The same with the way of each particle and what its theta loses counted from now on, and its row remembered."""
    count = len(state.x)
    ways = {f"way_{a}": arrays.zeros(count if a != "z" or len(state.z) else 0, state.x) for a in "xyz"}
    return state._replace(**ways, damped=arrays.zeros(len(state.theta), state.x), row=arrays.counted(count, state.x))


def released(state: State) -> State:
    """The same with nothing held over a window."""
    kinds = {name: INTEGERS.get(name, np.float64) for name in HELD if name in state._fields}
    return state._replace(**{name: arrays.zeros(0, state.x, kind) for name, kind in kinds.items()})


def count(state: State) -> int:
    """Particles that there are, less those upstream of a nozzle."""
    return int((state.kind != INFLOW).sum())


def grains(state: State) -> State:
    """The particles that are in the gas: all but those upstream of a nozzle."""
    inside = state.kind != INFLOW
    return state if inside.all() else take(state, inside)
