"""Grains of several materials among each other: what a pair weighs by volume, in a kernel of its own type.

All grains share one space: alpha_p = sum V_j W_ij with V_j = m_j/rho_pj, and a particle's `density` is that alpha_p
times the rho_p of its own material. Stress acts by volume. The energy sum_i V_i e(alpha_i) has the gradient

    m_i a_i = -sum_j V_i V_j (p_i/alpha_i^2 + p_j/alpha_j^2) grad W,    p = alpha^2 de/dalpha,

so that momentum is kept pair by pair. With one rho_p that is m_j (p_i/rho_i^2 + p_j/rho_j^2) grad W (Monaghan 1992,
Annu. Rev. Astron. Astrophys. 30, 543); what differs is one number a pair, q_ij = rho_0^2/(rho_pi rho_pj), and p over
the square of rho_0 alpha. Of a gradient of pressure each material bears its share of the volume, alpha_m/alpha grad p,
as each bears that of the packed grains in Syamlal, Rogers & O'Brien 1993 (MFIX theory guide). Grains of one material
have a `Kernel` without rho_0, and the compiler drops all of this.
"""

from __future__ import annotations

from typing import NamedTuple

from sdph.laws.compiled import inlined


class Kernel(NamedTuple):
    """Cubic spline: h [m], sigma [1/m^d], divided by the lattice sum so that a perfect lattice has its own density."""

    h: float
    sigma: float


class MixedKernel(NamedTuple):
    """The same where grains are of several materials; reference rho_0 [kg/m3], that of the first."""

    h: float
    sigma: float
    reference: float


@inlined
def over(kernel, s, i, j):
    """rho_pi/rho_pj [-]."""
    if len(kernel) == 2:
        return 1.0
    return s.grain_density[i] / s.grain_density[j]


@inlined
def by_volume(kernel, s, i, j):
    """q_ij [-] of a pair."""
    if len(kernel) == 2:
        return 1.0
    return kernel.reference * kernel.reference / (s.grain_density[i] * s.grain_density[j])


@inlined
def heft_squared(kernel, s, i):
    """(rho_pi/rho_0)^2 [-] of a particle."""
    if len(kernel) == 2:
        return 1.0
    return (s.grain_density[i] / kernel.reference) ** 2
