"""A channel that turbulent gas flows through, at Re_tau = 395 where it is developed, against pimpleFoam's."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from sdph.study.compare import check

from . import stock

SAME = 0.01  # the bar of the issue, of the mean velocity
HALF, LONG, CELL = 1.0, 40.0, 0.1  # m: half height, length, width of cells (first centre at y+ = 20)
SPEED, REYNOLDS = 1.0, 395.0  # m/s in the mean, and u_tau HALF/nu
DEAN = 17.5  # mean speed over u_tau at that: Dean 1978, J. Fluids Eng. 100, 215, c_f = 0.073 Re_b^(-1/4)
VISCOSITY = stock.DENSITY * SPEED / DEAN * HALF / REYNOLDS  # Pa s
STEP, STEPS = 0.1, 1200  # s and number: gas passes three times
PLACE = 0.9  # of the length, where the profile is taken
TURBULENCE = {"mixing_length_m": 0.07 * 4.0 * HALF, "intensity": 0.05}
BOUNDARIES = {
    "inlet": {"kind": "velocity_inlet", "side": "left", "velocity_m_s": [SPEED, 0.0]},
    "outlet": {"kind": "pressure_outlet", "side": "right", "pressure_Pa": 0.0},
    "middle": {"kind": "slip_wall", "side": "top"},
    "floor": {"kind": "wall", "side": "bottom"},
}


def profiles(model: str, folder: Path, steps: int = STEPS, long: float = LONG) -> tuple[np.ndarray, ...]:
    """Height (N,) [m] of the cells of a column, velocity along the channel there of ours and of pimpleFoam [m/s], and our
    last change of velocity in a step [m/s]."""
    own = stock.case((long, HALF), CELL, BOUNDARIES, {"model": model} | TURBULENCE, VISCOSITY)
    with stock.started(own, folder) as gas:
        gas.start(None, ())
        for _ in range(steps - 1):
            before = gas.advance(STEP, {})
        state = gas.advance(STEP, {})
        theirs = stock.pimple(gas, own, folder / "stock", STEP, steps)["U"]
        x, y = gas.mesh.centres[:, 0], gas.mesh.centres[:, 1]
    chosen = np.flatnonzero(np.abs(x - PLACE * long) < 0.6 * CELL)
    chosen = chosen[x[chosen] == x[chosen].min()]
    change = np.abs(state.fields["velocity"] - before.fields["velocity"]).max()
    return y[chosen], state.fields["velocity"][chosen, 0], theirs[chosen, 0], change


def checks(folder: Path, _=(), reporter=None) -> list[dict]:
    """Checks of both models of the mean flow."""
    rows = []
    for model in ("kEpsilon", "kOmegaSST"):
        _, ours, theirs, change = profiles(model, folder / model)
        rows += [
            check(f"{model}, velocity of a channel over pimpleFoam's, furthest from 1", _furthest(ours / theirs), 1.0, SAME),
            check(f"{model}, change of velocity in the last step [m/s]", change, 0.0, 1e-5),
        ]
    return rows


def _furthest(ratios: np.ndarray) -> float:
    return float(ratios[np.abs(ratios - 1.0).argmax()])
