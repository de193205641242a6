"""Account of a window: impulses and work on the grains by cause, and where the energy of their motion goes.

A sub-step of dt moves particle i with the acceleration a by v' = v + a dt. Its kinetic energy grows by
m a.(v + v')/2 dt, to round-off, so the work of each part of a is counted with the mean of both velocities. What pairs
give to theta and to the temperature is counted at v, where the loops take it; the difference is `numerical_work`, first
order in dt.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import prange

from sdph.effects.around import wall_heat
from sdph.effects.grains import granular_temperature
from sdph.engine.ledger import vector
from sdph.engine.state import INFLOW
from sdph.laws.by_reference import by_reference
from sdph.laws.compiled import in_turn, inner

# of `Account.impulses` and `Account.works`, and their places there
IMPULSES, (WALLS, INLET) = ("walls", "inflow"), range(2)
WORKS = ("work_of_walls_J", "work_of_gravity_J", "work_of_inflow_J", "numerical_work_J")
BY_WALLS = 0
HEATS = (
    "mechanical_heat_J",  # of motion into the temperature of the grains: artificial viscosity, contacts
    "agitation_J",  # of motion into theta: pressure and viscosity of agitation
    "collision_heat_J",  # of theta into the temperature: inelastic collisions
    "damping_heat_J",  # of theta into the gas
    "bounds_work_J",  # into theta by its bounds, and by what holds it where it stands
)
BACK_PUT = ("contact_way_m", "contact_lift_J")  # by contact with walls: ways of all grains, energy that they got by it
SLOWED = ("grain_drag_J",)  # of motion by drag between materials; agitation_J or mechanical_heat_J have it too


@by_reference
class Account(NamedTuple):
    """Sums since the window began; felt holds what pushes and what rubs each dummy of the walls, (W, 6) [kg m/s], where
    somebody asks, else nothing; gave (F, 2) what faces of walls gave (sdph.effects.around.wall_heat)."""

    impulses: np.ndarray
    works: np.ndarray
    heats: np.ndarray
    back_put: np.ndarray
    slowed: np.ndarray
    felt: tuple
    gave: np.ndarray


def opened(dummies: int = 0, faces: int = 0) -> Account:
    """An account with nothing in it; with room for what so many `dummies` feel and so many `faces` give."""
    felt = (np.zeros((dummies, 6)),) if dummies else ()
    sums = (np.zeros(len(names)) for names in (WORKS, HEATS, BACK_PUT, SLOWED))
    return Account(np.zeros((len(IMPULSES), 3)), *sums, felt, np.zeros((faces, 2)))


def columns(account: Account) -> dict[str, float]:
    """Ledger columns [J], [kg m/s], [m]."""
    pairs = ((WORKS, account.works), (HEATS, account.heats), (BACK_PUT, account.back_put), (SLOWED, account.slowed))
    found = {name: float(value) for names, values in pairs for name, value in zip(names, values)}
    found["heat_of_walls_J"] = wall_heat.received(account.gave)
    for name, impulse in zip(IMPULSES, account.impulses):
        found |= vector(f"impulse_of_{name}", impulse)
    return found


@in_turn
def add(sums, found):
    """Add what a loop found (k numbers) to sums (k,)."""
    for n in range(len(found)):
        sums[n] += found[n]


@inner
def kick(s, acceleration, of_walls, agitation, heating, gravity, dt):
    """Velocities after dt [s]; what the sub-step adds to an account: impulses of walls and of the inflow, three numbers
    each, and the four works.

    acceleration (N, 3) [m/s2] is of pairs; of_walls (N, 7) of the push of walls and of their grip [m/s2], three columns
    each, and the power of the grip by the sliding of walls [W/kg]. What pairs and grip take from the motion is booked
    as `agitation` and `heating` (N,) [W/kg]. A particle upstream of a nozzle feels nothing: the inflow undoes what
    pairs and the push do to it, the grip of walls beside the mouth is not there, and nothing agitates nor heats it.
    """
    px = py = pz = qx = qy = qz = by_walls = by_gravity = by_inflow = numerical = 0.0
    for i in prange(len(s.x)):
        m, deep = s.mass[i] * dt, len(s.z) > 0
        u, v, w = s.u[i], s.v[i], s.w[i] if deep else 0.0
        ax, ay, az = acceleration[i, 0], acceleration[i, 1], acceleration[i, 2]
        if s.kind[i] == INFLOW:
            ax, ay, az = ax + s.push_x[i], ay + s.push_y[i], az + s.push_z[i] if deep else 0.0
            qx, qy, qz = qx - m * ax, qy - m * ay, qz - m * az
            gripped = of_walls[i, 3] * u + of_walls[i, 4] * v + of_walls[i, 5] * w - of_walls[i, 6]
            by_inflow -= m * (ax * u + ay * v + az * w + agitation[i] + heating[i] + gripped)
            agitation[i] = heating[i] = 0.0
            by_gravity += m * (gravity[0] * u + gravity[1] * v + gravity[2] * w)
            s.way_x[i] += u * dt
            s.way_y[i] += v * dt
            if deep:
                s.way_z[i] += w * dt
            continue
        wx, wy, wz = of_walls[i, 0], of_walls[i, 1], of_walls[i, 2]
        rx, ry, rz = of_walls[i, 3], of_walls[i, 4], of_walls[i, 5]
        ax, ay, az = ax + rx, ay + ry, az + rz
        gx = 0.5 * dt * (ax + wx + s.push_x[i])
        gy = 0.5 * dt * (ay + wy + s.push_y[i])
        gz = 0.5 * dt * (az + wz + s.push_z[i]) if deep else 0.0
        s.u[i], s.v[i] = u + 2.0 * gx, v + 2.0 * gy
        s.way_x[i] += (u + gx) * dt
        s.way_y[i] += (v + gy) * dt
        if deep:
            s.w[i] = w + 2.0 * gz
            s.way_z[i] += (w + gz) * dt
        px, py, pz = px + m * (wx + rx), py + m * (wy + ry), pz + m * (wz + rz)
        by_walls += m * (wx * (u + gx) + wy * (v + gy) + wz * (w + gz) + of_walls[i, 6])
        by_gravity += m * (gravity[0] * (u + gx) + gravity[1] * (v + gy) + gravity[2] * (w + gz))
        numerical += m * (ax * gx + ay * gy + az * gz)
    return px, py, pz, qx, qy, qz, by_walls, by_gravity, by_inflow, numerical


@inner
def warm(p, s, work, dt, window, heat_capacity):
    """theta and temperatures after dt [s] of a window [s], and their sums, HEATS [J]; `work` of
    sdph.methods.grains.sub_step.

    p are the parameters of the granular temperature: where the case has theta stand, what would raise it goes out by
    its bounds. A particle upstream of a nozzle keeps its theta.
    """
    rubbing = agitation = collisions = damping = bounds = 0.0
    for i in prange(len(s.x)):
        m, collided = s.mass[i], 0.0
        capacity = s.grain_capacity[i] if len(s.grain_capacity) else heat_capacity
        agitation += m * work.agitation[i] * dt
        rubbing += m * work.heating[i] * dt
        if len(p) == 0:
            bounds -= m * work.agitation[i] * dt
        elif s.kind[i] != INFLOW:
            collided = 1.5 * work.collided[i]
            s.theta[i] = work.theta[i]
            s.damped[i] += 1.5 * m * work.damped[i]
            bounds += 1.5 * m * work.held[i]
            collisions += 1.5 * m * work.collided[i]
            damping += 1.5 * m * work.damped[i]
        if len(s.temperature):
            s.temperature[i] += (collided + (work.heating[i] + s.warmth[i] / window / m) * dt) / capacity
    return rubbing, agitation, collisions, damping, bounds


@inner
def brake(p, s, work, dt):
    """Velocities after drag between materials over dt [s]; what the motion loses joins what viscosity gives theta, or
    heats the grains where there is none (p are the parameters of theta), and its sum [J] is returned."""
    slowed = 0.0
    for i in prange(len(s.x)):
        s.u[i] += work.moved[i, 0]
        s.v[i] += work.moved[i, 1]
        if len(s.z):
            s.w[i] += work.moved[i, 2]
        fed = granular_temperature.fed(p, work.lost[i])
        work.agitation[i] += fed / dt
        work.heating[i] += (work.lost[i] - fed) / dt
        slowed += s.mass[i] * work.lost[i]
    return slowed


@inner
def drift(s, dt):
    """Places after dt [s]."""
    for i in prange(len(s.x)):
        s.x[i] += s.u[i] * dt
        s.y[i] += s.v[i] * dt
        if len(s.z):
            s.z[i] += s.w[i] * dt
