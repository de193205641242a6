"""The particles: a flat tuple of C-contiguous arrays, one row a particle.

Positions and velocities are separate arrays per axis. `z` and `w` have length zero in two dimensions, and every
array of an effect that is off has length zero: kernels decide by type or length, never by a flag per particle.
In two dimensions masses are per metre of depth [kg/m].
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from sdph.engine import arrays

# values of `kind`, of all methods alike; INFLOW: still upstream of its nozzle. Files hold them: they stay as they are
GRAIN, WALL, LIQUID, GAS, INFLOW, SOLID = range(6)


class State(NamedTuple):
    """All that a particle carries; see `FIELDS` for units."""

    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    u: np.ndarray
    v: np.ndarray
    w: np.ndarray
    mass: np.ndarray
    density: np.ndarray
    ident: np.ndarray
    kind: np.ndarray
    nozzle: np.ndarray
    entering: np.ndarray
    temperature: np.ndarray
    diameter: np.ndarray
    diameter_variance: np.ndarray
    material: np.ndarray
    grain_density: np.ndarray
    grain_capacity: np.ndarray
    grain_conductivity: np.ndarray
    theta: np.ndarray
    contact_xx: np.ndarray
    contact_yy: np.ndarray
    contact_xy: np.ndarray
    contact_yz: np.ndarray
    contact_zx: np.ndarray
    evaporating: np.ndarray
    born_mass: np.ndarray
    born_diameter: np.ndarray
    born_variance: np.ndarray
    lost_still: np.ndarray
    lost_moving: np.ndarray
    lost_kinetic: np.ndarray
    deformation: np.ndarray
    deformation_rate: np.ndarray
    weber: np.ndarray
    eddy_x: np.ndarray
    eddy_y: np.ndarray
    eddy_z: np.ndarray
    wall_age: np.ndarray
    begun_temperature: np.ndarray
    warming: np.ndarray
    received: np.ndarray
    exchanged: np.ndarray
    viscosity: np.ndarray
    depth: np.ndarray
    enclosure: np.ndarray
    pressure: np.ndarray
    sealed: np.ndarray
    throwing: np.ndarray
    bubble_void: np.ndarray
    bubble_temperature: np.ndarray
    bubble_heat: np.ndarray
    shell_flow: np.ndarray
    shell_hard: np.ndarray
    shell_harm: np.ndarray
    shell_swell: np.ndarray
    spot_flow: np.ndarray
    spot_hard: np.ndarray
    spot_harm: np.ndarray
    spot_swell: np.ndarray
    spot_hoop: np.ndarray
    warmth: np.ndarray
    push_x: np.ndarray
    push_y: np.ndarray
    push_z: np.ndarray
    damping: np.ndarray
    damped: np.ndarray
    way_x: np.ndarray
    way_y: np.ndarray
    way_z: np.ndarray
    row: np.ndarray
    copy: np.ndarray


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


def empty(count: int, names=ALWAYS, dimensions: int = 2) -> State:
    """A state of `count` particles, zero everywhere; arrays not among `names` have length zero."""
    present = {*ALWAYS, *names, "z", "w"} - (set() if dimensions == 3 else IN_SPACE)
    return State(*(np.zeros(count if name in present else 0, INTEGERS.get(name, np.float64)) for name in State._fields))


def _map(function, *states: State) -> State:
    return State(*(function(*same) if any(len(a) for a in same) else same[0] for same in zip(*states)))


def take(state: State, rows: np.ndarray) -> State:
    """The given rows (indices or mask) of every array: sorting, removing, choosing."""
    rows = arrays.chosen(rows) if rows.dtype == bool else rows
    return _map(lambda array: arrays.taken(array, rows), state)


def first(state: State, count: int) -> State:
    """The first `count` particles: a view, so that what is written there is written in the state."""
    return State(*(array[:count] for array in state))


def join(first: State, second: State) -> State:
    """Both one after the other."""
    return _map(arrays.joined, first, second)


def brought(state: State) -> State:
    """The same in memory."""
    return State(*map(arrays.brought, state))


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
    """The same under what holds over a window: warmth (N,) [J], push (N, 3) [m/s2], damping (N,) [1/s]."""
    x, y, z = arrays.columns(push)
    return state._replace(warmth=warmth, push_x=x, push_y=y, push_z=z if len(state.z) else z[:0], damping=damping)


def followed(state: State) -> State:
    """The same with the way of each particle and what its theta loses counted from now on, and its row remembered."""
    count = len(state.x)
    ways = {f"way_{a}": arrays.zeros(count if a != "z" or len(state.z) else 0, state.x) for a in "xyz"}
    return state._replace(**ways, damped=arrays.zeros(len(state.theta), state.x), row=arrays.counted(count, state.x))


def released(state: State) -> State:
    """The same with nothing held over a window."""
    kinds = {name: INTEGERS.get(name, np.float64) for name in HELD}
    return state._replace(**{name: arrays.zeros(0, state.x, kind) for name, kind in kinds.items()})


def count(state: State) -> int:
    """Particles that there are, less those upstream of a nozzle."""
    return int((state.kind != INFLOW).sum())


def grains(state: State) -> State:
    """The particles that are in the gas: all but those upstream of a nozzle."""
    inside = state.kind != INFLOW
    return state if inside.all() else take(state, inside)
