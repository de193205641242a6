"""Mass of each nozzle in the ledger, where grains or droplets come from more than one place: what came in, what of it
evaporated or burned, and what left. What is in the gas is the rest."""

from __future__ import annotations

import numpy as np


def names(case) -> tuple[str, ...]:
    """Ledger columns of a case; none where all grains come from one place."""
    if not case.grains or "inflow" not in case.effects or len(case.nozzles) + bool(case.particles) < 2:
        return ()
    what = ["injected", *_lost(case), *(["left"] if "outflow" in case.effects else [])]
    return tuple(_column(name, key) for name in case.nozzles for key in what)


def masses(case, nozzle, mass) -> np.ndarray:
    """(nozzles,) [kg] sum of the masses (N,) [kg] of grains by the nozzle (N,) that they are from, counted from 1."""
    return np.bincount(nozzle, mass, len(case.nozzles) + 1)[1:]


def columns(case, key: str, masses) -> dict[str, float]:
    """Ledger columns of a window: `masses` (nozzles,) [kg] that came in, left, ..."""
    found = {_column(name, key): float(mass) for name, mass in zip(case.nozzles, masses)}
    return {name: found[name] for name in names(case) if name in found}


def lost(case, state, loss) -> dict[str, float]:
    """The same of what evaporated or burned, `loss` as of `sdph.exchange.amounts`."""
    return {
        name: mass
        for key in (_lost(case) if loss and names(case) else ())
        for name, mass in columns(case, key, masses(case, state.nozzle, loss.vapour)).items()
    }


def _lost(case) -> list[str]:
    """Name of what grains lose to the gas."""
    return [word for effect, word in (("evaporation", "evaporated"), ("reaction", "reacted")) if effect in case.effects]


def _column(name: str, key: str) -> str:
    return f"nozzle_{name}_{key}_kg"
