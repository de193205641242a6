"""Pressure forces corrected for how neighbours lie around a particle.

p_i + p_j of a pair becomes p_i B_i + p_j B_j with B_i the inverse of M_i = sum V_j (r_j - r_i) grad W: what two
particles do to each other stays equal and opposite, but is no longer along the line between them (Oger, Doring,
Alessandrini & Ferrant 2007, J. Comput. Phys. 225, 1472). Where M is not 1, as in a lattice that is strained, pressure p
leaves the stress p (M - 1): a square lattice that is 1 + e times as long and 1/(1 + e) times as high resists like a
solid, with normal stresses that differ by 0.09 e p (h = 1.5 dx) or 0.04 e p (h = 2 dx), which at any spacing makes
shallow liquids slosh 2 or 1 % too fast and rising bubbles lag. Between two phases p_i and p_j have the weights of
`sdph.methods.liquids.phases`, and the continuity equation is corrected likewise, v_ij.B_i grad W: compression then
takes what the forces give. With the plain one an oil drop in water is given 65 % of its motion by nobody. At a free
surface kernels are cut off and B is left at 1 (SURFACE): corrected likewise, periods there are 2 to 3.5 % long at R/dx
= 12. One phase has the plain equation, and what that makes is told (`gradient_correction_J`). With the matrices a step
takes 1.4 times as long (bubble_rise).
"""

from __future__ import annotations

import math

from numba import prange

from sdph.engine import kernels as smoothing
from sdph.engine.geometry import apart
from sdph.engine.rows import entry, length
from sdph.laws.compiled import fast_parallel, serial

# of det M, 1 inside: below it a particle is left as it is. In a lattice 0.34 to 0.37 in the first layer at a free
# surface, 0.65 (h = 2 dx) or 0.82 (1.5 dx) in the second; our choice, made with the periods of boxes in view: at h = 2
# dx 0.75 leaves three quarters of their miss, 0.3 nine tenths
SURFACE = 0.5


def of_continuity(stepper) -> tuple:
    """`excess` of a stepper where its continuity equation is corrected as its forces are, else ()."""
    return stepper.excess if stepper.phases else ()


@fast_parallel
def surround(kernel, s, rows, box, active, volume, xx, yy, zz, xy, yz, zx):
    """B - 1 (six components, (N,) each) of the particles `active`; walls count among the neighbours."""
    for n in prange(len(active)):
        i = active[n]
        a = b = c = d = e = f = 0.0
        for k in range(length(rows, i)):
            j = entry(rows, i, k)
            dx, dy, dz = apart(s, box, i, j)
            share = abs(volume[j]) * smoothing.slope(kernel, math.sqrt(dx * dx + dy * dy + dz * dz))
            a -= share * dx * dx
            b -= share * dy * dy
            c -= share * dz * dz
            d -= share * dx * dy
            e -= share * dy * dz
            f -= share * dz * dx
        c = c if len(s.z) else 1.0
        first, second, third = b * c - e * e, f * e - d * c, d * e - b * f
        determinant = a * first + d * second + f * third
        inside = determinant > SURFACE
        scale = 1.0 / determinant if inside else 0.0
        own = 1.0 if inside else 0.0
        xx[i] = scale * first - own
        yy[i] = scale * (a * c - f * f) - own
        zz[i] = scale * (a * b - d * d) - own
        xy[i] = scale * second
        yz[i] = scale * (f * d - a * e)
        zx[i] = scale * third


@serial
def extra(excess, i, j, p_i, p_j, dx, dy, dz):
    """[p_i (B_i - 1) + p_j (B_j - 1)] r [Pa m], three components; `excess`: what `surround` gave, or () without
    correction."""
    if len(excess) == 0:
        return 0.0, 0.0, 0.0
    xx, yy, zz = (
        p_i * excess[0][i] + p_j * excess[0][j],
        p_i * excess[1][i] + p_j * excess[1][j],
        p_i * excess[2][i] + p_j * excess[2][j],
    )
    xy, yz, zx = (
        p_i * excess[3][i] + p_j * excess[3][j],
        p_i * excess[4][i] + p_j * excess[4][j],
        p_i * excess[5][i] + p_j * excess[5][j],
    )
    return xx * dx + xy * dy + zx * dz, xy * dx + yy * dy + yz * dz, zx * dx + yz * dy + zz * dz
