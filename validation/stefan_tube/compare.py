"""The Stefan tube against its closed form, N = p D/(R T L) ln((1 - X_2)/(1 - X_1)) (Stefan 1874).

Taken between the first cell above the liquid and the last one below the wind, whose mole fractions the run gives; the
profile between the two is checked as well: ln(1 - X) is a straight line there.
"""

from __future__ import annotations

import numpy as np

from sdph.laws import evaporation
from sdph.laws import exact as solution
from sdph.study.compare import check

FLUX = 0.01  # of the flux
PROFILE = 0.005  # of the mole fraction at the liquid
SATURATED = 0.02  # of it: the gas at the liquid lags behind by what leaves it in a window
STEADY = 0.8  # of the time has gone before the flux is taken


def exact(run) -> list[dict]:
    y, X = profile(run)
    above, below = first_above(run.case, y), int(np.searchsorted(y, run.case.boundaries["wind"].span[0])) - 1
    own = run.case.vapour
    expected = own.molar_mass * solution.stefan_tube_flux(
        run.case.gas.operating_pressure,
        own.diffusivity,
        run.case.gas.temperature,
        y[below] - y[above],
        X[above],
        X[below],
    )
    line = np.interp(y, [y[above], y[below]], [np.log1p(-X[above]), np.log1p(-X[below])])
    middle = (above + below) // 2
    _figure(run, y, X, -np.expm1(line), slice(above, below + 1))
    return [
        check("flux of vapour [kg/(m2 s)]", flux(run), expected, FLUX, True),
        check("mole fraction in the middle", X[middle], -np.expm1(line[middle]), PROFILE * X[above]),
        check("mole fraction at the liquid", X[0], saturated(run.case), SATURATED, True),
    ]


def metrics(run) -> dict[str, tuple]:
    """Metrics of `sdph cost`: flux, and the mole fraction in the middle relative to that at the liquid, against
    Stefan."""
    rate, middle, _ = exact(run)
    top = saturated(run.case)
    return {
        "flux": (rate["value"], rate["reference"], None),
        "mole fraction in the middle": (middle["value"], middle["reference"], top),
    }


def profile(run) -> tuple[np.ndarray, np.ndarray]:
    """Height [m] and mole fraction of vapour, mean of each row of cells, from below."""
    _, _, gas = run.fields(run.summary["time_s"])
    y = np.asarray(gas.cell_centers().points)[:, 1]
    Y = np.asarray(gas.cell_data["vapour_mass_fraction"])
    X = np.array(
        [evaporation.vapour_mole_fraction(value, run.case.vapour.molar_mass, run.case.gas.molar_mass) for value in Y]
    )
    rows, own = np.unique(np.round(y, 9), return_inverse=True)
    return rows, np.bincount(own, X) / np.bincount(own)


def first_above(case, y) -> int:
    """The first cell that no particle reaches: two smoothing lengths above the highest (not below a cell's own
    size)."""
    reach = 2.0 * max(case.smoothing_length, case.resolution.cell)
    top = case.particles["film"].upper[1] - 0.5 * case.resolution.spacing
    return int(np.searchsorted(y, top + reach + 0.5 * case.resolution.cell))


def saturated(case) -> float:
    return case.parameters["evaporation"].saturation_pressure / case.gas.operating_pressure


def flux(run) -> float:
    """Vapour from the liquid per area and time [kg/(m2 s)], in the last part of the run."""
    ledger = run.ledger
    late = ledger["time_s"] > STEADY * run.summary["time_s"]
    return float(ledger["evaporated_kg"][late].sum() / ledger["window_s"][late].sum() / run.case.domain.size[0])


def _figure(run, y, X, closed, rows) -> None:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(6, 4), constrained_layout=True)
    axes.plot(1e3 * y, X, "o", ms=4, label="cells of the gas")
    axes.plot(1e3 * y[rows], closed[rows], "k-", lw=1, label="Stefan")
    axes.set(xlabel="height [mm]", ylabel="mole fraction of vapour")
    axes.legend()
    figure.savefig(run.folder / "compare_exact.png", dpi=110)
    pyplot.close(figure)
