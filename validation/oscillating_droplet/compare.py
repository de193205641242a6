"""The droplet against Lamb's frequency and Laplace's pressure, sigma/R."""

from __future__ import annotations

import numpy as np
from scipy.optimize import curve_fit

from sdph.engine.state import GAS, LIQUID
from sdph.laws import liquids
from sdph.study.compare import check

PERIOD, PRESSURE = 0.01, 0.01  # issue 19
CORE, FAR = 0.6, 1.5  # of R: inside and outside of it no kernel reaches the interface
DAMPING = 0.2  # of what viscosity alone does: issue 19
QUIET = 0.5  # of the run: from then on pressures are averaged, over what sound does in the box
AT_REST = ("pools.drop.speed_m_s=0.0", "pools.air.speed_m_s=0.0")
VARIANTS = {"oscillating_droplet": ((), ["exact"]), "at_rest": (AT_REST, ["exact"])}


def metrics(run) -> dict:
    """Values for `sdph cost`: (value, reference, scale)."""
    own = period(run)[0]
    return {"period": (own["value"], own["reference"], own["reference"])}


def exact(run) -> list[dict]:
    """The period where the droplet was set in motion, Laplace's pressure where it was not."""
    pool = run.case.pools["drop"]
    return period(run) if pool.speed else laplace(run)


def radius(run) -> float:
    """Radius of a disc with the variance of the droplet at the start [m]."""
    spread = run.history["liquid_spread_x_m2"][0] + run.history["liquid_spread_y_m2"][0]  # R^2/2 of a disc
    return float(np.sqrt(2.0 * spread))


def viscous(run) -> float:
    """Rate [1/s] at which viscosity damps the amplitude, 2 n (n - 1) nu/R^2 with n = 2: what potential flow r^n cos(n
    theta) dissipates over its energy, as Lamb 1932, section 355, has it of a sphere."""
    return 4.0 * run.case.liquid.viscosity / (run.case.liquid.density * radius(run) ** 2)


def period(run) -> list[dict]:
    """Period of a damped sine that is fitted to the difference of the droplet's two variances."""
    case, h = run.case, run.history
    time, stretch = h["time_s"], h["liquid_spread_x_m2"] - h["liquid_spread_y_m2"]
    omega = liquids.disc_frequency(
        2, radius(run), case.parameters["surface_tension"].coefficient, case.liquid.density, case.gas_phase.density
    )

    def damped(t, size, rate, w, phase):
        return size * np.exp(-rate * t) * np.sin(w * t + phase)

    (_size, rate, w, _), _ = curve_fit(damped, time, stretch, (stretch.max(), 0.05 * omega, omega, 0.0))
    centre = np.hypot(
        h["liquid_centre_x_m"] - h["liquid_centre_x_m"][0], h["liquid_centre_y_m"] - h["liquid_centre_y_m"][0]
    ).max()
    return [
        check("period [s]", 2.0 * np.pi / w, 2.0 * np.pi / omega, PERIOD, True),
        check("damping over omega", rate / omega, viscous(run) / omega, DAMPING, True),
        check("drift of the droplet over its radius", centre / radius(run), 0.0, 0.01),
    ]


def laplace(run) -> list[dict]:
    """The mean difference of pressure over the later part of the run."""
    case, jumps = run.case, []
    centre, size = np.array(case.pools["drop"].centre), radius(run)
    for time in np.arange(QUIET * case.run.end_time, case.run.end_time, case.run.output_interval):
        _, points, _ = run.fields(time)
        distance = np.linalg.norm(points.points[:, :2] - centre, axis=1) / size
        inside = points["pressure"][(points["kind"] == LIQUID) & (distance < CORE)].mean()
        jumps.append(inside - points["pressure"][(points["kind"] == GAS) & (distance > FAR)].mean())
    h, sigma = run.history, case.parameters["surface_tension"].coefficient
    fastest = h["liquid_fastest_m_s"][-1] / np.sqrt(sigma / (case.liquid.density * size))
    return [
        check("pressure inside over outside [Pa]", np.mean(jumps), sigma / size, PRESSURE, True),
        check("parasitic speed over sqrt(sigma/(rho R))", fastest, 0.0, 0.1),
    ]
