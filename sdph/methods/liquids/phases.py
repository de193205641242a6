"""Two phases: what a pair of particles of different density shares, and what single phases leave out.

riemann: the pair's pressure is that of the Riemann problem between two densities with one sound speed, which is the
average of Hu & Adams 2006, J. Comput. Phys. 213, 844; the velocity in the continuity equation is weighted likewise
(Rezavand, Zhang & Hu 2020, J. Comput. Phys. 402, 109092, Eq. 14-20). plain: Colagrossi & Landrini 2003, J. Comput.
Phys. 191, 448.
"""

from __future__ import annotations

from typing import NamedTuple

from sdph.effects.effect import OFF
from sdph.engine.state import LIQUID
from sdph.laws.compiled import serial


class PhasesP(NamedTuple):
    """1 for riemann, 0 for plain; density of the liquid [kg/m3]; its sound speed over that of the gas."""

    weighted: float
    density: float
    slowness: float


def kernel(case) -> PhasesP | tuple:
    """Parameters for the loops; OFF where there is one phase, so that its terms are compiled away."""
    gas, liquid = case.gas_phase, case.liquid
    if gas is None:
        return OFF
    return PhasesP(float(gas.interaction == "riemann"), liquid.density, liquid.sound_speed / gas.speed_of_sound(liquid))


@serial
def pressure(p, p_i, p_j, rho_i, rho_j):
    """Twice the pressure [Pa] between two particles: p_i + p_j, or 2 (rho_j p_i + rho_i p_j)/(rho_i + rho_j)."""
    if len(p) == 0:
        return p_i + p_j
    if p.weighted == 0.0:
        return p_i + p_j
    return 2.0 * (rho_j * p_i + rho_i * p_j) / (rho_i + rho_j)


@serial
def behind(p, signed, p_j, mirrored):
    """Pressure [Pa] of a neighbour: of a wall among two phases what particle i itself would have there."""
    if len(p) == 0:
        return p_j
    return p_j if signed > 0.0 else mirrored


@serial
def density(p, signed, rho_i, rho_j):
    """Density [kg/m3] of a neighbour; a wall takes that of particle i."""
    if len(p) == 0:
        return rho_i
    return rho_j if signed > 0.0 else rho_i


@serial
def kind(p, signed, kind_i, kind_j):
    """Phase of a neighbour; a wall takes that of particle i."""
    if len(p) == 0:
        return kind_i
    return kind_j if signed > 0.0 else kind_i


@serial
def harmonic(p, rho_i, rho_j):
    """Harmonic mean of two densities over that of the liquid."""
    if len(p) == 0:
        return 1.0
    return 2.0 * rho_i * rho_j / ((rho_i + rho_j) * p.density)


@serial
def share(p, rho_i, rho_j):
    """Share of v_ij that the continuity equation of i takes: 1, or 2 rho_j/(rho_i + rho_j): a light particle yields to
    a heavy one."""
    if len(p) == 0:
        return 1.0
    return 2.0 * rho_j / (rho_i + rho_j) if p.weighted > 0.0 else 1.0


@serial
def like(p, kind_i, kind_j):
    """1 between particles of one phase, else 0."""
    if len(p) == 0:
        return 1.0
    return 1.0 if kind_i == kind_j else 0.0


@serial
def slowness(p, kind_i):
    """Sound speed of the liquid over that of a particle's phase."""
    if len(p) == 0:
        return 1.0
    return 1.0 if kind_i == LIQUID else p.slowness
