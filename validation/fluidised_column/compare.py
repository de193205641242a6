"""A bed on an even distributor against Ergun 1952: pressure drop up and down through minimum fluidisation.

The run of the scene rests below U_mf for 2 s: it must be still and quiet. From its case the ramp is then run, each
velocity from the grains as the last one left them, always in the embedded gas, whatever gas the run has.
"""

from __future__ import annotations

import dataclasses
import tempfile
from pathlib import Path

import numpy as np

from coupling.embedded import EmbeddedGas
from sdph import effects
from sdph.engine.ledger import Ledger
from sdph.laws import exact as laws
from sdph.running.balances import work_of_gas
from sdph.running.metrics import column
from sdph.running.simulation import Simulation
from sdph.study.compare import check

RAMP = (0.04, 0.06, 0.075, 0.10, 0.12, 0.10, 0.075, 0.06, 0.04, 0.02)  # m/s, up and down
FIXED = 0.9  # of the weight; a bed that the gas carries less of lies packed on its way down; our choice
STAGE = 1.6  # s at each velocity; means are over the latter half: a bed that settles takes 0.5 s
PACKED, CARRIED, ONSET = 0.01, 0.02, 0.03  # of Ergun's pressure drop, of the weight, of U_mf
STILL, QUIET = 5e-3, 0.01  # m/s; of the weight


def exact(run) -> list[dict]:
    """The resting bed of the run, then the ramp."""
    return resting(run) + fluidisation(run.case)


def resting(run) -> list[dict]:
    """Speed and noise of the pressure in the last quarter of the run."""
    rows = np.genfromtxt(run.folder / "metrics.csv", delimiter=",", names=True)
    late = rows[rows["time_s"] > 0.75 * run.case.run.end_time]
    noise = np.ptp(late["pressure_drop_Pa"]) / late["weight_Pa"][0]
    return [
        _below("fastest grain at rest [m/s]", late["speed_max_m_s"].max(), STILL),
        _below("swing of the pressure drop at rest over the weight [-]", noise, QUIET),
        check(
            "pressure drop at rest [Pa], Ergun", late["pressure_drop_Pa"].mean(), late["ergun_Pa"].mean(), PACKED, True
        ),
        *work_of_gas(run.summary),
    ]


def fluidisation(case, ramp=RAMP, stage=STAGE) -> list[dict]:
    """Pressure drop of every velocity, and U_mf."""
    rows = list(zip(ramp, stages(case, ramp, stage)))
    onset, checks = u_mf(case, rows[0][1]["alpha_p_inside"]), []
    for k, (velocity, row) in enumerate(rows):
        name = f"pressure drop at {velocity:g} m/s, {'up' if k <= np.argmax(ramp) else 'down'} [Pa]"
        if velocity < onset:
            inside = column.ergun(case, [row["alpha_p_inside"]], row["superficial_velocity_m_s"])[0]
            checks.append(
                check(f"{name.replace('drop', 'gradient')}/m inside, Ergun", row["gradient_Pa_m"], inside, PACKED, True)
            )
            checks.append(check(f"{name}, Ergun", row["pressure_drop_Pa"], row["ergun_Pa"], PACKED, True))
        else:
            checks.append(check(f"{name}, weight", row["pressure_drop_Pa"], row["weight_Pa"], CARRIED, True))
    return [*checks, *_onset(case, [row for _, row in rows[int(np.argmax(ramp)) :]], rows[0][1]["alpha_p_inside"])]


def _onset(case, down, settled: float) -> list[dict]:
    """U_mf as it is measured: the line of the fixed bed on the way down, carried on to the weight of the bed; against
    Ergun's at the alpha_p of that line, and at that of the bed before it was blown through."""
    weight = laws.buoyant_weight(1.0, case.grains.density, case.gas.density, -case.domain.gravity[1])
    fixed = [row for row in down if row["gradient_Pa_m"] < FIXED * weight * row["alpha_p_inside"]]
    alpha_p = float(np.mean([row["alpha_p_inside"] for row in fixed]))
    found = crossing([(row["superficial_velocity_m_s"], row["gradient_Pa_m"]) for row in fixed], weight * alpha_p)
    return [
        check(f"U_mf [m/s], Ergun at alpha_p of the {bed}", found, u_mf(case, at), ONSET, True)
        for at, bed in ((alpha_p, "fixed bed on the way down"), (settled, "settled bed"))
    ]


def stages(case, ramp, stage):
    """Means over the latter half of each stage."""
    state = None
    for velocity in ramp:
        state, mean = _stage(with_velocity(case, velocity, stage), state)
        yield mean


def with_velocity(case, velocity: float, end: float):
    """The case blown through at `velocity` until `end`."""
    inlet = dataclasses.replace(case.boundaries["distributor"], velocity=(0.0, velocity, 0.0)[: case.dimensions])
    run = dataclasses.replace(case.run, end_time=end, output_interval=end, report_at=())
    return dataclasses.replace(case, run=run, boundaries=case.boundaries | {"distributor": inlet})


def _stage(case, state):
    gas = EmbeddedGas(case)
    with tempfile.TemporaryDirectory() as folder:
        simulation = Simulation(
            case, gas, Ledger(Path(folder) / "ledger.csv", case, gas.mesh.depth, *effects.in_ledger(case))
        )
        if state is not None:
            simulation.stepper.replace(state)
        simulation.start()
        rows = []
        while simulation.time < case.run.end_time:
            simulation.window()
            if simulation.time > 0.5 * case.run.end_time:
                rows.append(column.metrics(simulation))
        simulation.ledger.table.close()
    return simulation.state, {key: float(np.mean([row[key] for row in rows])) for key in rows[0]}


def u_mf(case, alpha_p: float) -> float:
    """Ergun's minimum fluidisation velocity [m/s] of the bed as it lies."""
    grains, gas = case.grains, case.gas
    return laws.minimum_fluidisation(
        alpha_p, grains.density, -case.domain.gravity[1], grains.diameter, gas.density, gas.viscosity
    )


def crossing(packed, weight: float) -> float:
    """Velocity at which a U + b U^2 through the (velocity, gradient) of the packed bed reaches the weight [Pa/m]."""
    velocity, gradient = np.array(packed).T
    a, b = np.linalg.lstsq(np.stack((velocity, velocity**2), axis=1), gradient, rcond=None)[0]
    return float(2.0 * weight / (a + np.sqrt(a * a + 4.0 * b * weight)))


def _below(name: str, value: float, limit: float) -> dict:
    return {"name": name, "value": float(value), "reference": limit, "tolerance": 0.0, "ok": bool(value <= limit)}


def metrics(run) -> dict[str, tuple]:
    """Metrics of `sdph cost`: at the end, the pressure drop against Ergun's row by row, the gradient inside the bed
    against Ergun's at the alpha_p there."""
    last = run.summary
    inside = float(column.ergun(run.case, [last["alpha_p_inside"]], last["superficial_velocity_m_s"])[0])
    drop, gradient = (last["pressure_drop_Pa"], last["ergun_Pa"]), (last["gradient_Pa_m"], inside)
    return {"pressure drop [Pa]": (*drop, None), "gradient inside [Pa/m]": (*gradient, None)}
