"""Time per window of the embedded gas solver in a bed with a rising bubble: python benchmarks/embedded_gas.py [cells ...]"""

import sys
import time

import numpy as np

from coupling.embedded import EmbeddedGas
from sdph.case import from_table

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
            "density_kg_m3": 1.225, "viscosity_Pa_s": 1.8e-5, "conductivity_W_m_K": 0.0242, "heat_capacity_J_kg_K": 1006.0,
            "temperature_K": 288.0,
        },
        "grains": {"density_kg_m3": 2500.0, "diameter_mm": GRAIN * 1e3, "heat_capacity_J_kg_K": 800.0, "conductivity_W_m_K": 1.0},
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
        "alpha_g": 1.0 - alpha_p, "drag": beta, "drag_velocity": beta[:, None] * np.array([0.0, 0.1, 0.0]),
        "heat": eps, "heat_temperature": eps * 300.0,
    }  # fmt: skip


def windows(cells: int, dt: float) -> tuple[int, np.ndarray]:
    """Number of cells, and the time [ms] of each of many windows of dt [s]."""
    gas = EmbeddedGas(bed(cells))
    centres = gas.mesh.centres
    first = sources(centres, np.zeros(len(centres)), 0.0)
    state, taken = gas.start(first["alpha_g"], tuple(first)), []
    for n in range(1, WINDOWS + 6):
        given = sources(centres, np.linalg.norm(state.fields["velocity"], axis=1), n * dt)
        start = time.perf_counter()
        state = gas.advance(dt, given)
        taken.append(1e3 * (time.perf_counter() - start))
    return len(centres), np.array(taken[5:])


if __name__ == "__main__":
    for wanted in [int(a) for a in sys.argv[1:]] or [5000, 20000, 80000]:
        for dt in (1e-4, 1e-3):
            cells, taken = windows(wanted, dt)
            print(f"{cells} cells, window {dt:g} s: median {np.median(taken):.2f} ms, fastest {taken.min():.2f} ms")
