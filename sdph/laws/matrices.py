"""Small symmetric matrices: linear systems, eigenvalues."""

from __future__ import annotations

import math

from sdph.laws.compiled import serial

SINGULAR = 1e-3  # determinant of a renormalisation matrix; 1 inside, 0.1-0.5 at a surface; our choice
ROUND_OFF = 1e-32  # squared, of what is off the diagonal: round-off of float64


@serial
def solved(xx, yy, zz, xy, yz, zx, gx, gy, gz):
    """Solution of M x = g for a symmetric M; 0 where M is close to singular (a line of particles, or spray)."""
    a, b, c = yy * zz - yz * yz, zx * yz - xy * zz, xy * yz - zx * yy
    determinant = xx * a + xy * b + zx * c
    if determinant < SINGULAR:
        return 0.0, 0.0, 0.0
    e, f, g = xx * zz - zx * zx, zx * xy - xx * yz, xx * yy - xy * xy
    scale = 1.0 / determinant
    return scale * (a * gx + b * gy + c * gz), scale * (b * gx + e * gy + f * gz), scale * (c * gx + f * gy + g * gz)


@serial
def determinant(xx, yy, zz, xy, yz, zx):
    """Determinant of a symmetric matrix; below SINGULAR nothing is `solved`."""
    return xx * (yy * zz - yz * yz) + xy * (zx * yz - xy * zz) + zx * (xy * yz - zx * yy)


@serial
def smallest(xx, yy, zz, xy, yz, zx):
    """Smallest eigenvalue of a symmetric matrix, by its invariants (Smith 1961, Commun. ACM 4, 168)."""
    mean = (xx + yy + zz) / 3.0
    a, b, c = xx - mean, yy - mean, zz - mean
    spread = math.sqrt((a * a + b * b + c * c + 2.0 * (xy * xy + yz * yz + zx * zx)) / 6.0)
    if spread == 0.0:
        return mean
    half = (a * (b * c - yz * yz) - xy * (xy * c - yz * zx) + zx * (xy * yz - b * zx)) / (2.0 * spread**3)
    angle = math.acos(min(max(half, -1.0), 1.0)) / 3.0
    return mean + 2.0 * spread * math.cos(angle + 2.0 * math.pi / 3.0)


@serial
def turned(pp, qq, pq, pr, qr):
    """(pp, qq, pr, qr, cosine, sine) of a symmetric matrix after the turn in the plane of axes p and q that makes its
    element pq 0; r is the third axis. Jacobi 1846; Golub & Van Loan 2013, section 8.5."""
    if pq == 0.0:
        return pp, qq, pr, qr, 1.0, 0.0
    half = 0.5 * (qq - pp) / pq
    t = math.copysign(1.0, half) / (abs(half) + math.sqrt(half * half + 1.0))
    c = 1.0 / math.sqrt(t * t + 1.0)
    s = t * c
    return pp - t * pq, qq + t * pq, c * pr - s * qr, s * pr + c * qr, c, s


@serial
def spun(cosine, sine, a, b):
    """Vectors (3,) a and b turned in their plane."""
    return (
        (cosine * a[0] - sine * b[0], cosine * a[1] - sine * b[1], cosine * a[2] - sine * b[2]),
        (sine * a[0] + cosine * b[0], sine * a[1] + cosine * b[1], sine * a[2] + cosine * b[2]),
    )


@serial
def principal(xx, yy, zz, xy, yz, zx):
    """Eigenvalues (a, b, c) of a symmetric matrix and eigenvectors (ax, ay, az, bx, by, bz, cx, cy, cz), in no order:
    cyclic Jacobi turns until what is off the diagonal is round-off."""
    a, b, c = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
    small = ROUND_OFF * (xx * xx + yy * yy + zz * zz)
    while xy * xy + yz * yz + zx * zx > small:
        xx, yy, zx, yz, cosine, sine = turned(xx, yy, xy, zx, yz)
        a, b = spun(cosine, sine, a, b)
        yy, zz, xy, zx, cosine, sine = turned(yy, zz, yz, 0.0, zx)
        b, c = spun(cosine, sine, b, c)
        xx, zz, xy, yz, cosine, sine = turned(xx, zz, zx, xy, 0.0)
        a, c = spun(cosine, sine, a, c)
        zx = 0.0
    return xx, yy, zz, a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2]
