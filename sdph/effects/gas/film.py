"""Film of gas around a droplet, whose properties are those at (2 T_p + T_g)/3 where a case has `coupling.film`.

Third rule of Hubbard, Denny & Mills 1975, Int. J. Heat Mass Transfer 18, 1003. With r = T_g/T_film the density of the
film is r times that of the gas, viscosity and conductivity are the gas's over r (linear in T, as OpenFOAM's parcels
have it). Laws of drag and heat are a viscosity or a conductivity times a function of rho s d/mu: those of the gas with
its density times r^2, over r.
"""

from __future__ import annotations

from typing import NamedTuple

from sdph.laws.compiled import inlined, law
from sdph.schema import CaseError

GAS_SHARE = 1.0 / 3.0  # of the gas in the film's temperature: Hubbard, Denny & Mills 1975


class FilmP(NamedTuple):
    """Share [-] of the gas in the temperature of the film: GAS_SHARE."""

    gas_share: float


def kernel(case) -> tuple:
    if case.coupling.film and "heat" not in case.effects:
        raise CaseError("coupling.film = true: no droplet has a temperature; add heat to effects, or leave it out")
    return FilmP(GAS_SHARE) if case.coupling.film else ()


@law
def temperature(gas_temperature, grain_temperature):
    """Temperature [K] of the film; numbers or arrays."""
    return grain_temperature + GAS_SHARE * (gas_temperature - grain_temperature)


@inlined
def ratio(p, s, i, gas_temperature):
    """r [-] of particle i, 1 without a film."""
    if len(p) == 0:
        return 1.0
    return gas_temperature / temperature(gas_temperature, s.temperature[i])
