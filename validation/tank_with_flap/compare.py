"""An elastic flap that holds water back: where its tip rests, and the force on it, against statics."""

from __future__ import annotations

import numpy as np

from sdph.laws import solids
from sdph.study.compare import check

MOST = 0.05  # of the tip's deflection; our choice: the issue names no bar
FORCE = 0.02  # of the force, which no bending theory is in; our choice


def swings(run) -> np.ndarray:
    """Rows of the history at which the tip is back, by its passages through its mean on the way out."""
    off = deflection(run)
    rows = np.flatnonzero((off[:-1] < off.mean()) & (off[1:] >= off.mean())) + 1
    return rows[np.insert(np.diff(rows) > 2, 0, True)]


def deflection(run) -> np.ndarray:
    """Deflection of the tip [m], row by row of the history."""
    place = run.history["solid_flap_highest_x_m"]
    return place - place[0]


def rest(run) -> float:
    """Mean deflection [m] over whole swings."""
    rows = swings(run)
    return float(deflection(run)[rows[0] : rows[-1]].mean())


def exact_rest(run) -> float:
    """The same by bending and shear."""
    own, flap, water = run.case.solid, run.case.bodies["flap"], run.case.pools["water"]
    height, thickness = flap.upper[1] - flap.held_upper[1], flap.upper[0] - flap.lower[0]
    material = own.youngs_modulus, own.poisson_ratio, -run.case.domain.gravity[1] * run.case.liquid.density
    depth = solids.dammed_depth(water.upper[1] - water.lower[1], water.upper[0] - water.lower[0], thickness, *material)
    return solids.dam_deflection(depth, height, thickness, *material)


def force(run) -> float:
    """Mean force [N/m] of the water on the flap, along x, over whole swings."""
    rows = swings(run)
    begin, end = run.history["time_s"][[rows[0], rows[-1]]]
    ledger = np.genfromtxt(run.folder / "ledger_solid.csv", delimiter=",", names=True, dtype=None, encoding="utf-8")
    within = (ledger["time_s"] > begin) & (ledger["time_s"] <= end)
    return float(ledger["impulse_of_liquid_x_kg_m_s"][within].sum() / (end - begin))


def pushed(case) -> float:
    """Force [N/m] of the water on the flap at rest, rho g d^2/2."""
    water = case.pools["water"]
    return -0.5 * case.domain.gravity[1] * case.liquid.density * (water.upper[1] - water.lower[1]) ** 2


def metrics(run) -> dict:
    """Values for `sdph cost`: (value, reference, scale)."""
    wanted, weight = exact_rest(run), pushed(run.case)
    return {"deflection": (rest(run), wanted, wanted), "force": (force(run), weight, weight)}


def exact(run) -> list[dict]:
    drifts = max(run.summary["momentum_drift_rel"], run.summary["solid_momentum_drift_rel"])
    return [
        check("deflection of the tip over that of bending and shear", rest(run) / exact_rest(run), 1.0, MOST),
        check("force on the flap over rho g d^2/2", force(run) / pushed(run.case), 1.0, FORCE),
        check("momentum of water or flap that nobody gave", drifts, 0.0, 1e-12),
    ]
