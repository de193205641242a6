"""Force of the viscous stress of grains, exact where their velocity is linear in space, however the particles lie.

Particle i takes from the motion the power [W/m3], with w_ij = -m_j (dW/dr)/r / rho_i and v_ij = v_i - v_j,

    mu (sum w |v_ij - G r_ij|^2 + 2 dev(D):dev(D)) + lambda (tr D)^2,    G = N M^-1,

D the symmetric part of its velocity gradient G, from N = sum w v_ij r_ij and M = sum w r_ij r_ij (Bonet & Lok 1999,
Comput. Methods Appl. Mech. Eng. 180, 97). The force of a pair is minus half of its gradient,

    m_j (dW/dr)/r ((mu_i/rho_i^2 + mu_j/rho_j^2) v_ij + (A_i/rho_i^2 + A_j/rho_j^2) r_ij),    A = tau M^-1 - mu G,

tau = 2 mu dev(D) + lambda tr(D). No power is negative, and none is taken by a rigid rotation: momentum, angular
momentum and energy are kept. The first sum is what no linear velocity has, damped as Morris, Fox & Zhu 1997 (J. Comput.
Phys. 136, 214) damp all: G does not see a velocity that alternates from particle to particle. That it has the
viscosity mu is our choice: A = 0 is their form, mu lap v. This stands beside walls, whose pull is of that form, and
where neighbours do not enclose a particle. Forces of pairs alone (Espanol & Revenga 2003, Phys. Rev. E 67, 026705) are
3 to 5 % weak on lattices that are sheared.
"""

from __future__ import annotations

from sdph.engine.geometry import deep
from sdph.laws.compiled import inlined
from sdph.laws.matrices import solved

# of det M, 1 inside: below it neighbours do not enclose a particle. Random clouds then decay at 5.9 nu/h^2 at most,
# where an explicit step bears 16 (DIFFUSIVE), and 6 % of the particles of clouds as thin as 0.3 of a bed are left out;
# our choice
ENCLOSED = 0.1
NO_GRADIENT = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)  # A where a velocity has only its differences


@inlined
def determinant(M):
    """Determinant of M (xx, yy, zz, xy, yz, zx) [-]."""
    return M[0] * (M[1] * M[2] - M[4] * M[4]) + M[3] * (M[5] * M[4] - M[3] * M[2]) + M[5] * (M[3] * M[4] - M[5] * M[1])


@inlined
def viscous(N, M, square, mu, bulk):
    """A [Pa] (9: xx, xy, xz, yx, ...) of viscosities mu and bulk [Pa s]; sheared and squeezed [1/s2]: power = mu
    sheared + bulk squeezed. N (9) [1/s]; M (6) [-]; square = sum w |v_ij|^2 [1/s2]."""
    a, b, c = solved(*M, N[0], N[1], N[2]), solved(*M, N[3], N[4], N[5]), solved(*M, N[6], N[7], N[8])
    rate = a[0] + b[1] + c[2]
    even = (bulk - 2.0 / 3.0 * mu) * rate
    xy, yz, zx = mu * (a[1] + b[0]), mu * (b[2] + c[1]), mu * (c[0] + a[2])
    x = solved(*M, 2.0 * mu * a[0] + even, xy, zx)
    y = solved(*M, xy, 2.0 * mu * b[1] + even, yz)
    z = solved(*M, zx, yz, 2.0 * mu * c[2] + even)
    A = (
        x[0] - mu * a[0], x[1] - mu * a[1], x[2] - mu * a[2],
        y[0] - mu * b[0], y[1] - mu * b[1], y[2] - mu * b[2],
        z[0] - mu * c[0], z[1] - mu * c[1], z[2] - mu * c[2],
    )  # fmt: skip
    linear = a[0] * N[0] + a[1] * N[1] + a[2] * N[2] + b[0] * N[3] + b[1] * N[4] + b[2] * N[5]
    linear += c[0] * N[6] + c[1] * N[7] + c[2] * N[8]
    twice = 2.0 * (a[0] * a[0] + b[1] * b[1] + c[2] * c[2] - rate * rate / 3.0)
    twice += (a[1] + b[0]) ** 2 + (b[2] + c[1]) ** 2 + (c[0] + a[2]) ** 2
    return A, square - linear + twice, rate * rate


@inlined
def bear(bearing, i, box, per, mu, A, tau):
    """Write what `pair` takes of particle i: mu, A and the elastic stress tau (xx, yy, zz, xy, yz, zx) [Pa], times
    per = 1/rho^2."""
    bearing[i, 0] = per * mu
    bearing[i, 1], bearing[i, 2] = per * (A[0] + tau[0]), per * (A[1] + tau[3])
    bearing[i, 3], bearing[i, 4] = per * (A[3] + tau[3]), per * (A[4] + tau[1])
    if deep(box):
        bearing[i, 5], bearing[i, 6] = per * (A[2] + tau[5]), per * (A[5] + tau[4])
        bearing[i, 7], bearing[i, 8] = per * (A[6] + tau[5]), per * (A[7] + tau[4])
        bearing[i, 9] = per * (A[8] + tau[2])


@inlined
def pair(viscous_p, friction_p, bearing, box, i, j, dx, dy, dz, du, dv, dw):
    """Force per mass of i by j over m_j (dW/dr)/r; off where there is no viscosity and no friction."""
    if len(viscous_p) + len(friction_p) == 0:
        return 0.0, 0.0, 0.0
    mu = bearing[i, 0] + bearing[j, 0]
    fx = mu * du + (bearing[i, 1] + bearing[j, 1]) * dx + (bearing[i, 2] + bearing[j, 2]) * dy
    fy = mu * dv + (bearing[i, 3] + bearing[j, 3]) * dx + (bearing[i, 4] + bearing[j, 4]) * dy
    if not deep(box):
        return fx, fy, 0.0
    fx += (bearing[i, 5] + bearing[j, 5]) * dz
    fy += (bearing[i, 6] + bearing[j, 6]) * dz
    fz = mu * dw + (bearing[i, 7] + bearing[j, 7]) * dx + (bearing[i, 8] + bearing[j, 8]) * dy
    return fx, fy, fz + (bearing[i, 9] + bearing[j, 9]) * dz
