"""A sub-step of grains as one compiled call: what few particles cost is the way in and out of Python."""

from __future__ import annotations

import functools
from typing import NamedTuple

import numpy as np
from numba import prange

from sdph.effects import OFF
from sdph.effects.around import wall_heat, wall_parts, walls
from sdph.effects.grains import friction, grain_drag, granular_temperature
from sdph.engine import arrays
from sdph.engine.arrays import IN_MEMORY
from sdph.laws.by_reference import by_reference
from sdph.laws.compiled import in_turn, inner
from sdph.methods.grains import account, contacts, equations


class Terms(NamedTuple):
    """Parameters of the effects between grains, `OFF` of those that are; `shears`: one entry where a loop asks for
    their shear, else none."""

    viscous: tuple
    friction: tuple
    artificial: tuple
    temperature: tuple
    conduction: tuple
    slip: tuple
    shears: tuple
    wall_heat: tuple


def terms_of(parameters) -> Terms:
    """Parameters of the effects between grains; an algebraic theta asks for their shear too."""
    viscous, rubs, theta = (parameters[name] for name in ("granular_viscosity", "friction", "granular_temperature"))
    shears = (1.0,) if viscous or rubs or (theta and theta.model == 1) else OFF
    beside = (parameters[name] for name in ("conduction", "grain_drag"))
    heated = parameters["wall_heat"]
    return Terms(viscous, rubs, parameters["artificial_viscosity"], theta, *beside, shears, heated)


@by_reference
class Work(NamedTuple):
    """Arrays that a sub-step leaves to nobody: acceleration (N, 3) [m/s2] and of_walls (N, 7) as `account.kick` takes
    them, agitation and heating (N,) [W/kg], contact (5, N) [Pa]; theta (N,) after it and what went by bounds,
    collisions and gas (N,) [m2/s2]; of `grain_drag` stiff (N,) [-], moved (N, 3) [m/s] and lost (N,) [J/kg]."""

    acceleration: np.ndarray
    of_walls: np.ndarray
    agitation: np.ndarray
    heating: np.ndarray
    contact: np.ndarray
    theta: np.ndarray
    held: np.ndarray
    collided: np.ndarray
    damped: np.ndarray
    stiff: np.ndarray
    moved: np.ndarray
    lost: np.ndarray


def work(count: int, rubs: bool, drags: bool = False, like=IN_MEMORY) -> Work:
    """Room for `count` particles, with contacts where they rub, and drag between materials; beside the array `like`."""
    dragged, zeros = count if drags else 0, functools.partial(arrays.zeros, like=like)
    contact = zeros((len(friction.ARRAYS), count if rubs else 0))
    return Work(
        zeros((count, 3)), zeros((count, 7)), zeros(count), zeros(count), contact, *(zeros(count) for _ in range(4)),
        zeros(dragged), zeros((dragged, 3)), zeros(dragged),
    )  # fmt: skip


@in_turn
def advance(
    kernel, s, rows, box, scratch, terms, walls_p, wall, facing, unheld, heated, work, gravity, steps, heat_capacity,
    sums,
):  # fmt: skip
    """Stress, walls, rates, then velocity, theta, temperature and place after the sub-step; sums of `account`.

    heated: as `wall_heat.exchange` takes it; steps: its length and that of its window [s].
    """
    strain_grains(
        kernel, s, rows, box, scratch, terms.shears, terms.friction, terms.viscous, walls_p, wall, work, steps[0]
    )
    push(kernel, s, s, rows, box, scratch, terms, walls_p, wall, facing, unheld, work, gravity, steps[0], sums)
    stiffen(terms.slip, kernel, s, rows, box, scratch, work, steps[0])
    slip(terms.slip, terms.temperature, kernel, s, s, rows, box, scratch, work, steps[0], sums.slowed)
    settle(kernel, s, s, box, scratch, terms, heated, work, steps, heat_capacity, sums)


def advance_own(domain, own, given: tuple) -> None:
    """The same, as `given` to `advance`, for the `own` particles of a process: they need what those of others are
    strained by, and what brakes them."""
    kernel, s, rows, box, scratch, terms, walls_p, wall, facing, unheld, heated, work, gravity, steps, *rest = given
    (heat_capacity, sums), dt, walled = rest, steps[0], (walls_p, wall)
    strain_grains(kernel, s, rows, box, scratch, terms.shears, terms.friction, terms.viscous, *walled, work, dt)
    domain.refresh(scratch.bearing)
    push(kernel, s, own, rows, box, scratch, terms, *walled, facing, unheld, work, gravity, dt, sums)
    if terms.slip:
        domain.refresh(s.u, s.v, s.w)
        stiffen(terms.slip, kernel, s, rows, box, scratch, work, dt)
        domain.refresh(work.stiff)
        slip(terms.slip, terms.temperature, kernel, s, own, rows, box, scratch, work, dt, sums.slowed)
    settle(kernel, s, own, box, scratch, terms, heated, work, steps, heat_capacity, sums)


@in_turn
def push(kernel, s, own, rows, box, scratch, terms, walls_p, wall, facing, unheld, work, gravity, dt, sums):
    """Rates, and velocities after dt [s], of `own`: the particles of s that are of this process."""
    if len(walls_p):
        walls.extrapolate(
            kernel, box, wall, facing, s, scratch.pressure, wall.pressure, unheld, wall.velocity
        )  # fmt: skip
    if len(terms.conduction) == 3:
        equations.pack(terms.conduction, s, scratch.packed)
    equations.rates(
        kernel, s, rows, box, scratch, terms.viscous, terms.friction, terms.artificial, terms.temperature,
        terms.conduction, walls_p, wall, work.acceleration, work.of_walls, work.agitation, work.heating,
    )  # fmt: skip
    wall_parts.tell(sums.felt, walls_p, kernel, box, wall, facing, s, scratch, terms.friction, dt)
    found = account.kick(own, work.acceleration, work.of_walls, work.agitation, work.heating, gravity, dt)
    account.add(sums.impulses[account.WALLS], found[:3])
    account.add(sums.impulses[account.INLET], found[3:6])
    account.add(sums.works, found[6:])


@in_turn
def settle(kernel, s, own, box, scratch, terms, heated, work, steps, heat_capacity, sums):
    """theta, temperature and place of `own` after the sub-step."""
    dt, window = steps
    agitate(terms.temperature, own, scratch, work, dt)
    wall_heat.exchange(terms.wall_heat, terms.conduction, kernel, box, heated, s, dt, sums.gave)
    account.add(sums.heats, account.warm(terms.temperature, own, work, dt, window, heat_capacity))
    account.drift(own, dt)


@in_turn
def strain_grains(kernel, s, rows, box, scratch, shears, friction_p, viscous_p, walls_p, wall, work, dt):
    """Shear of the grains, where somebody asks for it; where there is friction contacts are strained over dt [s]."""
    if len(shears):
        contacts.shear(
            kernel, s, rows, box, scratch, walls_p, wall, friction_p, viscous_p, dt, work.contact, scratch.traction,
            scratch.rubbing, scratch.bearing, scratch.works, scratch.strain,
        )  # fmt: skip
        if len(friction_p):
            strained(s, work.contact)


@inner
def strained(s, contact):
    """Put contact (5, N) [Pa] into the state."""
    for i in prange(len(s.x)):
        s.contact_xx[i], s.contact_yy[i], s.contact_xy[i] = contact[0, i], contact[1, i], contact[2, i]
        if len(s.z):
            s.contact_yz[i], s.contact_zx[i] = contact[3, i], contact[4, i]


@in_turn
def stiffen(p, kernel, s, rows, box, scratch, work, dt):
    """Put into `work` by how much drag between materials is stiff over dt [s]."""
    if len(p):
        grain_drag.stiffen(p, kernel, s, rows, box, scratch.crowd, dt, work.stiff)


@in_turn
def slip(p, temperature_p, kernel, s, own, rows, box, scratch, work, dt, slowed):
    """Velocities of `own` after materials have braked each other for dt [s]; what their motion loses goes into
    `work`."""
    if len(p):
        grain_drag.exchange(p, kernel, s, rows, box, scratch.crowd, dt, work.stiff, work.moved, work.lost)
        slowed[0] += account.brake(temperature_p, own, work, dt)


@in_turn
def agitate(p, s, scratch, work, dt):
    """theta after dt [s], where it is followed, and what it lost to whom, into `work`."""
    if len(p):
        granular_temperature.advance_all(
            p, s, work.agitation, s.damping, scratch.strain, scratch.crowd, dt, work.theta, work.held, work.collided,
            work.damped,
        )  # fmt: skip


def loops(
    kernel, s, rows, box, scratch, terms, walls_p, wall, facing, unheld, heated, work, gravity, steps, heat_capacity,
    sums,
) -> dict[str, tuple]:  # fmt: skip
    """Loops over particles of `advance`, by name, each with its arguments: for who times one or looks into it."""
    head = kernel, s, rows, box, scratch
    found = {}
    if len(terms.shears):
        found["shear"] = (
            contacts.shear,
            (*head, walls_p, wall, terms.friction, terms.viscous, steps[0], work.contact, *scratch.shearing),
        )
    if len(walls_p):
        found["extrapolate"] = (
            walls.extrapolate,
            (kernel, box, wall, facing, s, scratch.pressure, wall.pressure, unheld, wall.velocity),
        )
    found["rates"] = (
        equations.rates,
        (*head, *terms[:5], walls_p, wall, work.acceleration, work.of_walls, work.agitation, work.heating),
    )
    return found
