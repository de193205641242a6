"""Drag of grains that something else pulls in the same window, so that they drift as fast as it lets them.

Drag over a window alone starts from the velocity at its start, and what pulls comes on top: grains would drift by
x/(1 - exp(-x)) too fast, x the window over their drag time. It starts from the velocity that the pull makes on the way
(sdph.laws.exchange.lead). The gas is handed the same velocity, so that it gives what the grains get.
"""

from __future__ import annotations

import numpy as np
from numba import prange

from coupling.transfer import gather
from sdph import effects
from sdph.effects.around import electric_field
from sdph.engine import arrays
from sdph.engine.state import GRAIN
from sdph.laws.compiled import parallel
from sdph.laws.exchange import lead


def steady(parameters, state) -> np.ndarray:
    """Weight and electric field (N, 3) [m/s2]."""
    gravity = np.asarray(parameters["gravity"] or (0.0, 0.0, 0.0))
    return gravity + electric_field.acceleration(parameters["electric_field"], state)


def ahead(case, parameters, state, weights, gas_state, rates, dt, against) -> np.ndarray:
    """Velocities (N, 3) [m/s] that drag starts from in a window of dt [s]: `against`, and on top what else pulls grains
    that are free to move. rates: beta/(alpha_p rho_p) (N,) [1/s] and force (N, 3) [N] that is held, no row where there
    is none. Where contacts last they carry what lies there: it does not follow its weight."""
    if not effects.moving(case):
        return against
    friction, found, pressed = parameters["friction"], arrays.copy(against), np.zeros((0, 3))
    if parameters["gas_pressure"]:
        pressed = gather(weights, gas_state.fields["pressure_gradient"])
    borne = friction.onset if friction else case.grains.packing_limit
    _run_ahead(state, steady(parameters, state), *rates, pressed, case.grains.density, borne, dt, found)
    return found


@parallel
def _run_ahead(s, pull, damping, force, gradient, grain_density, borne, dt, against):
    """Put that on `against`; gradient (N, 3) [Pa/m] of the gas's pressure, no row where grains do not feel it; borne:
    volume fraction from which contacts last."""
    for i in prange(len(s.x)):
        own = s.grain_density[i] if len(s.grain_density) else grain_density
        if s.kind[i] != GRAIN or damping[i] == 0.0 or s.density[i] >= borne * own:
            continue
        time = dt * lead(dt * damping[i])
        for a in range(3):
            rate = pull[i, a]
            if len(force):
                rate += force[i, a] / s.mass[i]
            if len(gradient):
                rate -= gradient[i, a] / own
            against[i, a] += time * rate
