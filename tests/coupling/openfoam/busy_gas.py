"""Gas that is kept busy, for tests of sdphGasFoam as a process."""

import numpy as np

SOURCES = ("alpha_g", "momentum_coefficient", "momentum", "heat_coefficient", "heat")


def busy_sources(gas, step):
    x, y = gas.mesh.centres[:, 0], gas.mesh.centres[:, 1]
    alpha = 1.0 - 0.4 * np.exp(-((x - 0.04 - 0.001 * step) ** 2 + (y - 0.03) ** 2) / 0.01**2)
    drag, heat = 200.0 * (1 - alpha), 1e5 * (1 - alpha)
    pull = drag[:, None] * [0.3, 0.1, 0.0]
    return {
        "alpha_g": alpha,
        "momentum_coefficient": drag,
        "momentum": pull,
        "heat_coefficient": heat,
        "heat": heat * 290.0,
    }


def busy(gas, steps, begin=0):
    """Some steps with all that moves and heats; the states of each."""
    return [gas.advance(1e-3, busy_sources(gas, step)) for step in range(begin + 1, begin + steps + 1)]


def started(gas):
    gas.start(busy_sources(gas, 0)["alpha_g"], SOURCES)
    return gas
