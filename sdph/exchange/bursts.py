"""Vapour that torn droplets throw in a window, before they exchange anything else with the gas in it.

Their superheat falls to nothing along a straight line in the time `throwing`, in which they fall apart; what boils
follows from it exactly (sdph.laws.bursting.flashed_share): flash keeps up with the surface that opens (our choice). All
droplets of a particle shrink alike, their number stays. The energy of what is thrown is what the particle loses, to
round-off: m c T before, less m' c T' after, less L (m - m').
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from sdph.laws import bursting


class Thrown(NamedTuple):
    """Throw of each particle: vapour (N,) [kg], that times its temperature (N,) [kg K]; `after`, arrays of the
    state by name as they are then; rows of those that have thrown all, which evaporate from the next window on."""

    mass: np.ndarray
    warmth: np.ndarray
    after: dict[str, np.ndarray]
    opened: np.ndarray


def throw(own, state, dt: float) -> Thrown | None:
    """Vapour that particles of a state throw in dt [s], None where none does; `own` is `Own` of
    sdph.effects.gas.micro_explosion."""
    rows = np.flatnonzero(state.throwing)
    if not len(rows):
        return None
    left, mass, temperature = state.throwing[rows], state.mass[rows], state.temperature[rows]
    superheat = np.where(temperature > own.boiling, temperature - own.boiling, 0.0)
    ended = left <= dt
    cooling = superheat * np.where(ended, 1.0, dt / left)
    share = np.array([bursting.flashed_share(own.heat_capacity, one, own.latent_heat) for one in cooling])
    thrown, cold = mass * share, temperature - cooling
    warmth = mass * temperature - (mass - thrown) * cold - own.latent_heat / own.heat_capacity * thrown
    scale = np.cbrt(1.0 - share)
    factors = {"diameter": scale, "born_diameter": scale}
    factors |= {"diameter_variance": scale**2, "born_variance": scale**2}
    after = {name: _put(getattr(state, name), rows, getattr(state, name)[rows] * by) for name, by in factors.items()}
    after["mass"] = _put(state.mass, rows, mass - thrown)
    after["born_mass"] = _put(state.born_mass, rows, mass - thrown)
    after["temperature"] = _put(state.temperature, rows, cold)
    after["throwing"] = _put(state.throwing, rows, np.where(ended, 0.0, left - dt))
    nothing = np.zeros(len(state.x))
    return Thrown(_put(nothing, rows, thrown), _put(nothing, rows, warmth), after, rows[ended])


def take(state, thrown: Thrown) -> None:
    """Take from the particles what they threw, and open those that are done."""
    for name, values in thrown.after.items():
        getattr(state, name)[:] = values
    state.sealed[thrown.opened] = 0.0


def _put(array, rows, values) -> np.ndarray:
    """A copy of an array with values in some of its rows."""
    out = array.copy()
    out[rows] = values
    return out
