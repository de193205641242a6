"""Drag of grains that something else pulls in the same window, so that they drift as fast as it lets them.

Drag over a window alone starts from the velocity at its start, and what pulls comes on top: grains would drift by
x/(1 - exp(-x)) too fast, x the window over their drag time. It starts from the velocity that the pull makes on the way
(sdph.laws.exchange.lead). The gas is handed the same velocity, so that it gives what the grains get.

Of weight counts what the pressure of an even suspension leaves of it. The gradient of the pressure itself is the
answer to what the gas was handed: to hand it back makes light grains unstable (measured).

Where contacts last they carry what lies there: it does not follow its weight. Below that its share falls linearly:
by a step, round-off would decide about a bed that starts right there (measured: 1e-16 of its density became 1e-10 of
its velocity).
"""

from __future__ import annotations

import numpy as np
from numba import prange

from sdph import effects
from sdph.effects.around import electric_field
from sdph.engine import arrays
from sdph.engine.state import GRAIN
from sdph.laws.compiled import parallel
from sdph.laws.exchange import lead

LOOSENING = 0.1  # of the volume fraction from which contacts last: so far below it grains are free; our choice, several
# times the few percent by which a summed density scatters


def steady(parameters, state) -> np.ndarray:
    """Weight and electric field (N, 3) [m/s2]."""
    gravity = np.asarray(parameters["gravity"] or (0.0, 0.0, 0.0))
    return gravity + electric_field.acceleration(parameters["electric_field"], state)


def ahead(case, parameters, state, rates, dt, against) -> np.ndarray:
    """Velocities (N, 3) [m/s] that drag starts from in a window of dt [s]: `against`, and on top what else pulls grains
    that are free to move. rates: beta/(alpha_p rho_p) (N,) [1/s] and force (N, 3) [N] that is held, no row where there
    is none."""
    if not effects.moving(case):
        return against
    friction, found = parameters["friction"], arrays.copy(against)
    borne = friction.onset if friction else case.grains.packing_limit
    gravity, own = tuple(parameters["gravity"] or (0.0, 0.0, 0.0)), case.coupling
    carried = float(bool(parameters["gas_pressure"])), float(own.voidage and not own.one_way)
    field = electric_field.acceleration(parameters["electric_field"], state)
    own = *carried, case.gas.density, case.grains.density, borne
    _run_ahead(state, gravity, field, *rates, *own, dt, found)
    return found


@parallel
def _run_ahead(s, gravity, field, damping, force, carried, knows, gas_density, grain_density, borne, dt, against):
    """Put that on `against`; gravity (3) and field (N, 3) [m/s2]; carried: 1 where grains feel the pressure of the gas,
    which carries 1 - alpha_g (1 - rho_g/rho_p) of an even suspension, else 0; knows: 1 where the gas knows of their
    volume, else 0; borne: volume fraction from which
    contacts last."""
    for i in prange(len(s.x)):
        own = s.grain_density[i] if len(s.grain_density) else grain_density
        free = (1.0 - s.density[i] / (borne * own)) / LOOSENING
        if s.kind[i] != GRAIN or damping[i] == 0.0 or free <= 0.0:
            continue
        left = 1.0 - carried * (1.0 - (1.0 - knows * s.density[i] / own) * (1.0 - gas_density / own))
        time = dt * lead(dt * damping[i]) * (free if free < 1.0 else 1.0)
        for a in range(3):
            rate = left * gravity[a] + field[i, a]
            if len(force):
                rate += force[i, a] / s.mass[i]
            against[i, a] += time * rate
