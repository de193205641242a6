"""What grains get from where in one window."""

from __future__ import annotations

import numpy as np

from sdph.engine import state as particles
from sdph.engine.ledger import vector
from sdph.engine.state import GRAIN


class Tally:
    """What the grains had before they moved, to tell afterwards what they got from where."""

    def __init__(self, simulation):
        self.momentum, self.heat = _momentum(simulation.state), simulation.stepper.mechanical_heat
        self.came = _came_in(simulation)

    def columns(self, simulation, body, exchanged, touched) -> dict[str, float]:
        """Ledger columns, given the impulses (3,) of body forces, from the gas and of contact with other methods; the
        rest is of walls."""
        mass, energy, momentum = (now - before for now, before in zip(_came_in(simulation), self.came))
        walls = _momentum(simulation.state) - self.momentum - body - exchanged - touched - momentum
        columns = {
            "injected_kg": mass,
            "injected_J": energy,
            "mechanical_heat_J": simulation.stepper.mechanical_heat - self.heat,
        }
        impulses = {"impulse_of_body_forces": body, "impulse_of_walls": walls, "impulse_of_inflow": momentum}
        impulses["impulse_of_contact"] = touched
        return columns | {
            key: value for name, impulse in impulses.items() for key, value in vector(name, impulse).items()
        }


def _came_in(simulation):
    """Mass [kg], enthalpy [J] and momentum [kg m/s] through the nozzles since the start."""
    source = simulation.source
    return (source.mass, source.energy, source.momentum) if source else (0.0, 0.0, np.zeros(3))


def _momentum(state) -> np.ndarray:
    return np.einsum("i,ij->j", state.mass * (state.kind == GRAIN), particles.velocities(state))


def of_those_that_left(case, left) -> dict[str, float]:
    """Ledger columns of the grains that left."""
    if left is None:
        return {"left_kg": 0.0, "left_J": 0.0} | vector("impulse_of_outflow", np.zeros(3))
    energy = float((left.mass * left.temperature).sum() * case.grains.heat_capacity) if len(left.temperature) else 0.0
    return {"left_kg": float(left.mass.sum()), "left_J": energy} | vector("impulse_of_outflow", -_momentum(left))
