"""Accelerations that hold over a window, and the work and impulse of each of them."""

from __future__ import annotations

import numpy as np

from sdph.engine.ledger import vector


class Pushes:
    """Accelerations of the particles of a `state` over `dt` [s]: impulse (N, 3) [kg m/s] of the exchange with the gas,
    that of contact with other methods; gravity (3,), pressure gradient and electric field (N, 3) [m/s2]. Of particles
    upstream of a nozzle they are undone by the inflow (sdph.methods.grains.account.kick)."""

    def __init__(self, state, dt: float, impulse, touched, gravity, pressed, driven):
        self.impulse, self.touched = impulse, touched
        mass = state.mass[:, None] * dt
        self.pressed, self.weight, self.driven = mass * pressed, mass * gravity, mass * driven
        pushed = np.divide(impulse + touched, mass, out=np.zeros_like(impulse), where=mass > 0.0)
        self.push, self.dt = gravity + pressed + driven + pushed, dt

    def columns(self, way) -> dict[str, float]:
        """Ledger columns [kg m/s], [J] once each particle has gone its `way` (N, 3) [m]."""
        works = {"work_of_drag_J": self.impulse, "work_of_pressure_J": self.pressed, "work_of_contact_J": self.touched,
                 "work_of_electric_field_J": self.driven}  # fmt: skip
        found = {name: float(np.einsum("ij,ij->", own, way) / self.dt) for name, own in works.items()}
        found |= vector("impulse_of_body_forces", np.einsum("ij->j", self.weight + self.pressed + self.driven))
        return found | vector("impulse_of_contact", self.touched.sum(axis=0))
