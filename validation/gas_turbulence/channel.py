"""A channel that turbulent gas flows through, at Re_tau = 395 where it is developed, against pimpleFoam's."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np

from coupling.openfoam.patches import types
from sdph.study.compare import check

from . import stock

SAME = 0.01  # the bar of the issue, of the mean velocity
DEVELOPED, STEADY = 0.1, 1e-4  # of Re_tau, and m/s in a step: our choice
HALF, LONG, CELL = 1.0, 20.0, 0.1  # m: half height, length, width of cells (first centre at y+ = 20)
SPEED, REYNOLDS = 1.0, 395.0  # m/s in the mean, and u_tau HALF/nu
DEAN = 17.5  # mean speed over u_tau at that: Dean 1978, J. Fluids Eng. 100, 215, c_f = 0.073 Re_b^(-1/4)
VISCOSITY = stock.DENSITY * SPEED / DEAN * HALF / REYNOLDS  # Pa s
STEP, STEPS = 0.1, 500  # s and number: gas passes two and a half times
PLACE = 0.9  # of the length, where the profile is taken
TURBULENCE = {"mixing_length_m": 0.07 * 4.0 * HALF, "intensity": 0.05}
BOUNDARIES = {
    "inlet": {"kind": "velocity_inlet", "side": "left", "velocity_m_s": [SPEED, 0.0]},
    "outlet": {"kind": "pressure_outlet", "side": "right", "pressure_Pa": 0.0},
    "middle": {"kind": "slip_wall", "side": "top"},
    "floor": {"kind": "wall", "side": "bottom"},
}


class Profiles(NamedTuple):
    """Height (N,) [m] of the cells of a column, velocity along the channel there of ours and of pimpleFoam [m/s], our
    u_tau HALF/nu at the wall of that column, and our last change of velocity in a step [m/s]."""

    height: np.ndarray
    ours: np.ndarray
    theirs: np.ndarray
    reynolds: float
    change: float


def profiles(model: str, folder: Path, steps: int = STEPS, long: float = LONG) -> Profiles:
    """A model's channel by both solvers, from gas that moves as it comes in."""
    own = stock.case((long, HALF), CELL, BOUNDARIES, {"model": model} | TURBULENCE, VISCOSITY)
    count = round(long / CELL) * round(HALF / CELL)
    with stock.started(own, folder, {"U": np.tile([SPEED, 0.0, 0.0], (count, 1))}) as gas:
        gas.start(None, ())
        for _ in range(steps - 1):
            before = gas.advance(STEP, {})
        state = gas.advance(STEP, {})
        floor = list(types(gas.case_folder)).index("floor")
        nut = stock.remembered(gas, folder / "kept", (f"nut.{floor}",))[f"nut.{floor}"]
        theirs = stock.pimple(gas, own, folder / "stock", STEP, steps)["U"]
        x, y = gas.mesh.centres[:, 0], gas.mesh.centres[:, 1]
    column = np.abs(x - x[np.abs(x - PLACE * long).argmin()]) < 0.5 * CELL
    lowest = np.flatnonzero(column)[y[column].argmin()]
    kinematic = VISCOSITY / stock.DENSITY + nut[round(x[lowest] / CELL - 0.5)]  # m2/s, at the wall by its function
    friction = np.sqrt(kinematic * state.fields["velocity"][lowest, 0] / y[lowest])
    change = np.abs(state.fields["velocity"] - before.fields["velocity"]).max()
    return Profiles(
        y[column], state.fields["velocity"][column, 0], theirs[column, 0],
        float(friction * HALF * stock.DENSITY / VISCOSITY), float(change),
    )  # fmt: skip


def checks(folder: Path, _=(), reporter=None) -> list[dict]:
    """Checks of both models of the mean flow."""
    rows = []
    for model in ("kEpsilon", "kOmegaSST"):
        found = profiles(model, folder / "channel" / model)
        rows += [
            check(f"{model}, velocity of a channel over pimpleFoam's, furthest from 1", _furthest(found), 1.0, SAME),
            check(f"{model}, Re_tau of a channel", found.reynolds, REYNOLDS, DEVELOPED, True),
            check(f"{model}, change of velocity in the last step [m/s]", found.change, 0.0, STEADY),
        ]
    return rows


def _furthest(found: Profiles) -> float:
    ratios = found.ours / found.theirs
    return float(ratios[np.abs(ratios - 1.0).argmax()])
