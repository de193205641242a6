"""Gradients that are exact in linear fields: sums over neighbours, divided by the matrix of how the neighbours lie."""

from __future__ import annotations

from sdph.laws.compiled import inlined
from sdph.laws.matrices import solved

NO_MATRIX = (0.0,) * 6  # xx, yy, zz, xy, yz, zx of a symmetric one
NO_SUMS = (0.0,) * 9  # of u by x, y, z, then of v, of w


@inlined
def added(matrix, sums, share, dx, dy, dz, du, dv, dw):
    """Matrix and sums with those of a neighbour at (dx, dy, dz) [m] whose u, v, w differ by du, dv, dw; `share` is
    V_j times the kernel's slope."""
    xx, yy, zz, xy, yz, zx = matrix
    ux, uy, uz, vx, vy, vz, wx, wy, wz = sums
    xx, yy, zz = xx - share * dx * dx, yy - share * dy * dy, zz - share * dz * dz
    xy, yz, zx = xy - share * dx * dy, yz - share * dy * dz, zx - share * dz * dx
    ux, uy, uz = ux - share * du * dx, uy - share * du * dy, uz - share * du * dz
    vx, vy, vz = vx - share * dv * dx, vy - share * dv * dy, vz - share * dv * dz
    wx, wy, wz = wx - share * dw * dx, wy - share * dw * dy, wz - share * dw * dz
    return (xx, yy, zz, xy, yz, zx), (ux, uy, uz, vx, vy, vz, wx, wy, wz)


@inlined
def joined(matrix, other):
    """Sum of two matrices."""
    xx, yy, zz, xy, yz, zx = matrix
    a, b, c, d, e, f = other
    return xx + a, yy + b, zz + c, xy + d, yz + e, zx + f


@inlined
def in_plane(matrix, flat):
    """The matrix; in two dimensions (`flat`), where nothing lies along z, with 1 there."""
    xx, yy, zz, xy, yz, zx = matrix
    return xx, yy, 1.0 if flat else zz, xy, yz, zx


@inlined
def divided(matrix, sums):
    """Gradient, 9 numbers as `sums`; 0 where the matrix is close to singular (sdph.laws.matrices.solved)."""
    ux, uy, uz, vx, vy, vz, wx, wy, wz = sums
    ux, uy, uz = solved(*matrix, ux, uy, uz)
    vx, vy, vz = solved(*matrix, vx, vy, vz)
    wx, wy, wz = solved(*matrix, wx, wy, wz)
    return ux, uy, uz, vx, vy, vz, wx, wy, wz
