"""Scales of each of several materials."""

from __future__ import annotations

from sdph.laws import exact
from sdph.methods.grains.scales import Scales


def fluidising(case) -> list[float]:
    """U_mf [m/s] of each material alone, packed as the densest patch of the case (Ergun 1952)."""
    s, gas = Scales(case), case.gas
    around = gas.density, gas.viscosity
    return [exact.minimum_fluidisation(s.capped, g.density, s.gravity, g.sauter_diameter, *around) for g in case.kinds]
