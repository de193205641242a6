"""Viscosity of a Newtonian liquid, `liquid.viscosity_Pa_s`."""

from __future__ import annotations

from typing import NamedTuple

from numba import njit

from sdph.effects.effect import NO_LIMIT, Effect
from sdph.schema import record

DIFFUSIVE = 0.125  # of h^2/nu, Morris, Fox & Zhu 1997, J. Comput. Phys. 136, 214, Eq. 21


@record
class LaminarViscosity:
    """Has no input of its own."""


class LaminarP(NamedTuple):
    """Twice the viscosity [Pa s]."""

    twice: float


def kernel(case) -> LaminarP:
    return LaminarP(2.0 * case.liquid.viscosity)


def dt_limit(p, case, state) -> float:
    nu = case.liquid.viscosity / case.liquid.density
    return DIFFUSIVE * case.smoothing_length**2 / nu if nu else NO_LIMIT


@njit(cache=True, error_model="numpy")
def pair(p):
    """Over V_j (dW/dr)/r v_ij/rho_i: 2 mu [Pa s]. Morris, Fox & Zhu 1997, Eq. 22; of equal densities the form of
    Lo & Shao 2002, Appl. Ocean Res. 24, 275, which the sloshing paper takes (Eq. 8).

    Without their eta^2 in r^2 + eta^2: (dW/dr)/r is finite at r = 0, and eta = 0.1 h takes 2 % off the viscosity.
    """
    if len(p) == 0:
        return 0.0
    return p.twice


EFFECT = Effect(
    name="laminar_viscosity",
    summary="viscosity of a liquid (Morris)",
    parameters=LaminarViscosity,
    kernel=kernel,
    moves=True,
    matter=("liquid",),
    dt_limit=dt_limit,
)
