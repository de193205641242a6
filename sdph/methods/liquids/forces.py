"""Parts that the loops over liquids share: separations, acceleration from outside, small symmetric matrices."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from sdph.effects.around import frame, gravity
from sdph.laws.compiled import inlined, serial


class Moving(NamedTuple):
    """Velocities (N,) [m/s] of wall particles that are of bodies, 0 of all others; `()` where there are no bodies."""

    u: np.ndarray
    v: np.ndarray
    w: np.ndarray


@inlined
def velocity(wall_p, moving, j):
    """Velocity [m/s] (3 components) of wall particle j: of the walls all over, or of its own."""
    if len(moving) == 0:
        return wall_p.u, wall_p.v, wall_p.w
    return moving.u[j], moving.v[j], moving.w[j]


@serial
def held_off(wall_p, signed, rho, r):
    """Pressure [Pa] by which a wall particle holds off liquid of density rho that came nearer to it than it stands at
    rest.

    rho c^2 (1 - r/near), our choice. The wall's other pressure is extrapolated from the liquid around: it knows nothing
    of a particle that came closer than the rest, and what got in among the particles of a wall would lie there at rest.
    """
    over = rho * wall_p.stiffness * max(1.0 - r * wall_p.near, 0.0)
    return 0.0 if signed > 0.0 else over


@serial
def body(gravity_p, frame_p, s, i, still):
    """Acceleration [m/s2] from outside of particle i, or at its place of what stands `still` in the frame."""
    gx, gy, gz = gravity.acceleration(gravity_p)
    z = s.z[i] if len(s.z) else 0.0
    w = s.w[i] if len(s.z) else 0.0
    moving = 0.0 if still else 1.0
    fx, fy, fz = frame.acceleration(frame_p, s.x[i], s.y[i], z, moving * s.u[i], moving * s.v[i], moving * w)
    return gx + fx, gy + fy, gz + fz
