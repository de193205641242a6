"""Updates of the particles of a liquid in place: velocity, place, density; and what is the most among them."""

from __future__ import annotations

from numba import prange

from sdph.laws.compiled import parallel, parallel_largest


@parallel
def kick(active, acceleration, dt, u, v, w):
    """v += a dt."""
    for n in prange(len(active)):
        i = active[n]
        u[i] += dt * acceleration[i, 0]
        v[i] += dt * acceleration[i, 1]
        if len(w):
            w[i] += dt * acceleration[i, 2]


@parallel
def wrap(axis, period):
    """Takes places along a periodic axis back into the box."""
    for i in prange(len(axis)):
        axis[i] = axis[i] % period


@parallel
def turn(active, frame_p, dt, acceleration):
    """a -= 2 omega x (a dt/2): Coriolis' acceleration of the velocity that the kick by dt/2 to come leads to.

    Taken of the velocity before that kick, it would add energy: a turning frame would be of first order in time.
    """
    for n in prange(len(active)):
        i = active[n]
        ax, ay, az = acceleration[i, 0], acceleration[i, 1], acceleration[i, 2]
        acceleration[i, 0] -= dt * (frame_p.wy * az - frame_p.wz * ay)
        acceleration[i, 1] -= dt * (frame_p.wz * ax - frame_p.wx * az)
        acceleration[i, 2] -= dt * (frame_p.wx * ay - frame_p.wy * ax)


@parallel
def drift(active, u, v, w, dt, x, y, z):
    """r += v dt."""
    for n in prange(len(active)):
        i = active[n]
        x[i] += dt * u[i]
        y[i] += dt * v[i]
        if len(z):  # of bodies in a plane liquid w has rows, and z has none
            z[i] += dt * w[i]


@parallel
def densify(active, rate, dt, density):
    """rho += rate dt."""
    for n in prange(len(active)):
        density[active[n]] += dt * rate[active[n]]


@parallel_largest
def fastest(s, active, acceleration):
    """Largest v^2 [m2/s2] and a^2 [m2/s4] of the liquid."""
    speed = force = 0.0
    for n in prange(len(active)):
        i = active[n]
        w = s.w[i] if len(s.w) else 0.0
        speed = max(speed, s.u[i] ** 2 + s.v[i] ** 2 + w * w)
        force = max(force, acceleration[i, 0] ** 2 + acceleration[i, 1] ** 2 + acceleration[i, 2] ** 2)
    return speed, force


@parallel
def momentum(s, active):
    """Momentum of the liquid [kg m/s], three components."""
    x = y = z = 0.0
    for n in prange(len(active)):
        i = active[n]
        x += s.mass[i] * s.u[i]
        y += s.mass[i] * s.v[i]
        z += s.mass[i] * s.w[i] if len(s.w) else 0.0
    return x, y, z


@parallel_largest
def travelled(x, y, z, x0, y0, z0):
    """Largest squared distance [m2] between two sets of places."""
    most = 0.0
    for i in prange(len(x)):
        dz = z[i] - z0[i] if len(z) else 0.0
        most = max(most, (x[i] - x0[i]) ** 2 + (y[i] - y0[i]) ** 2 + dz * dz)
    return most
