"""Eddy viscosity, k, epsilon and omega of a velocity that stands still, against pimpleFoam's, to round-off."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from sdph.study.compare import check

from . import stock

SAME = 1e-10  # the bar of the issue
SIZE, CELL = (0.12, 0.08, 0.06), 0.01  # m
STEP, STEPS = 2e-3, 5  # s and number; Courant number 0.4
LENGTH, INTENSITY, SPEED = 0.004, 0.1, 2.0  # m, -, m/s: of what flows in
MODELS = {"kEpsilon": "epsilon", "kOmegaSST": "omega", "WALE": None}  # model -> what it solves for beside k
BOUNDARIES = {
    "inlet": {"kind": "velocity_inlet", "side": "left", "velocity_m_s": [SPEED, 0.0, 0.0]},
    "outlet": {"kind": "pressure_outlet", "side": "right", "pressure_Pa": 0.0},
    "lid": {"kind": "wall", "side": "top", "velocity_m_s": [0.5, 0.0, 0.3]},
    "slide": {"kind": "slip_wall", "side": "front"},
    "walls": {"kind": "wall"},
}


def velocity(places: np.ndarray) -> np.ndarray:
    """A flow (C, 3) [m/s] that turns and shears in all directions."""
    x, y, z = (2.0 * np.pi * places / SIZE).T
    return SPEED * np.stack([
        1.0 + 0.4 * np.sin(y) * np.cos(z), 0.3 * np.sin(x + z) + 0.1 * np.cos(y), 0.2 * np.cos(x) * np.sin(y)
    ], axis=1)  # fmt: skip


def start(model: str, places: np.ndarray) -> dict[str, np.ndarray]:
    """Start fields at the centres of cells (C, 3)."""
    x, y, _ = (2.0 * np.pi * places / SIZE).T
    rates = {"epsilon": 0.8 * (1.0 + 0.4 * np.cos(x)), "omega": 90.0 * (1.0 + 0.4 * np.cos(x))}
    if MODELS[model] is None:
        return {"U": velocity(places)}
    return {"U": velocity(places), "k": 0.06 * (1.0 + 0.5 * np.sin(y)), MODELS[model]: rates[MODELS[model]]}


def centres() -> np.ndarray:
    """Centres (C, 3) [m] of the cells, x running fastest, as blockMesh numbers them."""
    z, y, x = np.meshgrid(*(np.arange(CELL / 2.0, length, CELL) for length in reversed(SIZE)), indexing="ij")
    return np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1)


def apart(model: str, folder: Path) -> dict[str, float]:
    """Field -> how far ours is from pimpleFoam's after STEPS, over its largest value."""
    given = {} if MODELS[model] is None else {"mixing_length_m": LENGTH, "intensity": INTENSITY}
    own = stock.case(SIZE, CELL, BOUNDARIES, {"model": model} | given)
    with stock.started(own, folder, start(model, centres()), stock.FROZEN) as gas:
        gas.start(None, ())
        for _ in range(STEPS):
            gas.advance(STEP, {})
        ours = stock.remembered(gas, folder / "kept")
        theirs = stock.pimple(gas, own, folder / "stock", STEP, STEPS, stock.FROZEN)
    assert ours.keys() == theirs.keys()
    return {name: stock.furthest(ours[name], theirs[name]) for name in ours}


def checks(folder: Path, _=(), reporter=None) -> list[dict]:
    """Checks of each model."""
    return [
        check(f"{model}, {name} of a frozen flow over pimpleFoam's, less 1", value, 0.0, SAME)
        for model in MODELS
        for name, value in apart(model, folder / "frozen" / model).items()
    ]
