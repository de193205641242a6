"""The height of the wave against Prosperetti 1981, from the first Fourier component of where the lower liquid is."""

from __future__ import annotations

import numpy as np

from sdph.engine.state import LIQUID
from sdph.laws import liquids
from sdph.study.compare import check

HEIGHT = 0.03  # of the height at the start, root mean square: issue 19; 2 % at 32 cells a wave is good for grids


def heights(run) -> tuple[np.ndarray, np.ndarray]:
    """(times [s], heights [m]): 2/L sum V cos(k x) of the lower liquid is the amplitude of its surface, as the rest
    of it is even."""
    case, found = run.case, []
    pool, times = case.pools["lower"], np.arange(0.0, run.summary["time_s"], case.run.output_interval)
    length = pool.upper[0] - pool.lower[0]
    for time in times:
        _, points, _ = run.fields(time)
        own = points["kind"] == LIQUID
        phase = 2.0 * np.pi * (points.points[own, 0] - pool.centre[0]) / length
        found.append(2.0 / length * (points["mass"][own] * np.cos(phase)).sum() / case.liquid.density)
    return times, np.array(found)


def misses(run) -> np.ndarray:
    """Misses of the height, over that at the start."""
    case, (times, found) = run.case, heights(run)
    pool, start = case.pools["lower"], case.pools["lower"].displacement
    expected = liquids.capillary_wave(
        times, pool.upper[0] - pool.lower[0], case.parameters["surface_tension"].coefficient, case.liquid.density,
        case.gas_phase.density, case.liquid.viscosity / case.liquid.density,
    )  # fmt: skip
    return found / start - expected


def metrics(run) -> dict:
    """Values for `sdph cost`: (value, reference, scale)."""
    return {"height": (float(np.sqrt(np.mean(misses(run) ** 2))), 0.0, 1.0)}


def exact(run) -> list[dict]:
    missed = misses(run)
    return [check("height over that at the start, root mean square", np.sqrt(np.mean(missed**2)), 0.0, HEIGHT)]
