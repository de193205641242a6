"""Time per window in a bed with a rising bubble: the embedded gas solver against OpenFOAM, and its multigrid against
others.

    python benchmarks/embedded_gas.py [cells ...]

Both solvers get the same sources. The pressure equation of the last window is then solved again to the same tolerance
by what is there to be had: `pyamg` (if it is installed) and scipy, setup included, because the drag changes the matrix
every window.
"""

import contextlib
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from scipy import sparse
from scipy.sparse import linalg

from coupling.embedded import EmbeddedGas, pressure
from coupling.openfoam.programs import install
from coupling.openfoam.solver import OpenFoamGas
from sdph.case.read import from_table
from sdph.scenes import paths

SIZE = (0.5, 1.0)  # m
GRAIN = 0.5e-3  # m
WINDOWS = 100


def bed(cells: int):
    """Case of a bed of about `cells` gas cells, inlet below, opening above."""
    side = SIZE[0] / round(np.sqrt(cells * SIZE[0] / SIZE[1]))
    return from_table({
        "title": "bed", "dimensions": 2, "effects": [], "run": {"end_time_s": 1.0, "output_interval_s": 1.0},
        "domain": {"size_m": list(SIZE), "gravity_m_s2": [0.0, -9.81]},
        "resolution": {"spacing_mm": side * 1e3, "cell_mm": side * 1e3},
        "gas": {
            "density_kg_m3": 1.225, "viscosity_Pa_s": 1.8e-5, "conductivity_W_m_K": 0.0242,
            "heat_capacity_J_kg_K": 1006.0, "temperature_K": 288.0,
        },
        "grains": {"density_kg_m3": 2500.0, "diameter_mm": GRAIN * 1e3, "heat_capacity_J_kg_K": 800.0,
        "conductivity_W_m_K": 1.0},
        "boundaries": {
            "below": {"kind": "velocity_inlet", "side": "bottom", "velocity_m_s": [0.0, 0.3], "temperature_K": 350.0},
            "above": {"kind": "pressure_outlet", "side": "top", "pressure_Pa": 0.0},
            "walls": {"kind": "wall"},
        },
    })  # fmt: skip


def sources(centres: np.ndarray, speed: np.ndarray, t: float) -> dict[str, np.ndarray]:
    """Ergun drag and heat of a bed whose bubble, at time t, has grown to 3 cm + 0.1 m/s t and risen at 1 m/s."""
    away = np.hypot(centres[:, 0] - 0.25, centres[:, 1] - 0.08 - t) - 0.03 - 0.1 * t
    alpha_p = np.where(centres[:, 1] < 0.5, 0.6, 0.0) * np.clip(0.5 + away / 0.02, 0.02, 1.0)
    beta = 150.0 * alpha_p**2 * 1.8e-5 / ((1.0 - alpha_p) * GRAIN**2) + 1.75 * alpha_p * 1.225 * speed / GRAIN
    eps = 3e5 * alpha_p
    return {
        "alpha_g": 1.0 - alpha_p, "momentum_coefficient": beta, "momentum": beta[:, None] * np.array([0.0, 0.1, 0.0]),
        "heat_coefficient": eps, "heat": eps * 300.0,
    }  # fmt: skip


def windows(gas, dt: float) -> np.ndarray:
    """Time [ms] of each of many windows of dt [s]."""
    centres = gas.mesh.centres
    first = sources(centres, np.zeros(len(centres)), 0.0)
    state, taken = gas.start(first["alpha_g"], tuple(first)), []
    for n in range(1, WINDOWS + 6):
        given = sources(centres, np.linalg.norm(state.fields["velocity"], axis=1), n * dt)
        start = time.perf_counter()
        state = gas.advance(dt, given)
        taken.append(1e3 * (time.perf_counter() - start))
    return np.array(taken[5:])


@contextlib.contextmanager
def solvers(cells: int):
    """Name -> gas solver of the bed, OpenFOAM where it is."""
    with tempfile.TemporaryDirectory() as folder, contextlib.ExitStack() as stack:
        found = {"embedded": EmbeddedGas(bed(cells))}
        if install.find():
            other = OpenFoamGas(bed(cells), Path(folder) / "gas", paths.gas_template(""))
            found["OpenFOAM"] = stack.enter_context(contextlib.closing(other))
        yield found


@contextlib.contextmanager
def recorded():
    """The arguments of the last pressure solve, in a list of one."""
    last, solve = [None], pressure.solve_pressure

    def record(*arguments):
        last[0] = (
            *arguments[:2],
            tuple(w.copy() for w in arguments[2]),
            *(a.copy() for a in arguments[3:6]),
            arguments[6],
        )
        return solve(*arguments)

    pressure.solve_pressure = record
    try:
        yield last
    finally:
        pressure.solve_pressure = solve


def matrix(grid, conductance: np.ndarray):
    """The pressure equation of the cells as a sparse matrix."""
    number = np.full(grid.size, -1)
    number[grid.cells] = np.arange(len(grid.cells))
    diagonal, rows, columns, values = np.zeros(len(grid.cells)), [], [], []
    for a, s in enumerate(grid.strides):
        for neighbour, k in (
            (grid.cells - s, conductance[a, grid.cells]),
            (grid.cells + s, conductance[a, grid.cells + s]),
        ):
            inside = number[neighbour] >= 0
            diagonal += k
            rows.append(np.flatnonzero(inside))
            columns.append(number[neighbour][inside])
            values.append(-k[inside])
    off = sparse.coo_matrix(
        (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), (len(diagonal),) * 2
    )
    return (off + sparse.diags(diagonal)).tocsr()


def others(A):
    """Name -> solve(b, rtol), setup included."""
    jacobi = sparse.diags(1.0 / A.diagonal())
    found = {
        "scipy, sparse LU": lambda b, rtol: linalg.splu(A.tocsc()).solve(b),
        "scipy, conjugate gradients with the diagonal": lambda b, rtol: linalg.cg(
            A, b, rtol=rtol, atol=0.0, M=jacobi, maxiter=20000
        )[0],
    }
    with contextlib.suppress(ImportError):
        import pyamg

        found["pyamg, smoothed aggregation"] = lambda b, rtol: pyamg.smoothed_aggregation_solver(A).solve(
            b, tol=rtol, accel="cg", maxiter=200
        )
        found["pyamg, Ruge-Stuben"] = lambda b, rtol: pyamg.ruge_stuben_solver(A).solve(
            b, tol=rtol, accel="cg", maxiter=200
        )
    return found


def enough(solve, A, b: np.ndarray, scale: np.ndarray, tolerance: float) -> float:
    """The largest tolerance, a power of ten, with which the residual of every cell is as small as the multigrid leaves
    it."""
    tried = (10.0**-k for k in range(16))
    return next(rtol for rtol in tried if (np.abs(b - A @ solve(b, rtol)) / scale).max() <= tolerance)


def fastest(call, rounds: int = 5) -> float:
    """Least time [ms] of some calls."""
    return min(_timed(call) for _ in range(rounds))


def _timed(call) -> float:
    start = time.perf_counter()
    call()
    return 1e3 * (time.perf_counter() - start)


def compare(cells: int, dt: float) -> None:
    """Prints one table."""
    with solvers(cells) as gases, recorded() as last:
        taken = {name: np.median(windows(gas, dt)) for name, gas in gases.items()}
        grid, count = gases["embedded"].box.grid, len(gases["embedded"].mesh.volumes)
    print(f"{count} cells, window {dt:g} s")
    for name, median in taken.items():
        print(f"  {name:52s}{median:9.2f} ms a window {median / taken['embedded']:9.1f} x")
    levels, inner, work, source, scale, x, tolerance = last[0]
    own = fastest(lambda: pressure.solve_pressure(levels, inner, work, source, scale, x, tolerance))
    print(f"  {'pressure alone: own multigrid':52s}{own:9.2f} ms          {1.0:9.1f} x")
    A, b = matrix(grid, work[0][:, : grid.size]), source[grid.cells]
    for name, solve in others(A).items():
        rtol = enough(solve, A, b, scale[grid.cells], tolerance)
        other = fastest(lambda solve=solve, rtol=rtol: solve(b, rtol))
        print(f"  {name:52s}{other:9.2f} ms          {other / own:9.1f} x")


if __name__ == "__main__":
    for wanted in [int(a) for a in sys.argv[1:]] or [5000, 20000]:
        for dt in (1e-4, 1e-3):
            compare(wanted, dt)
