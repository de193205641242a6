"""`sdph run` of a case with a liquid: no gas, no windows; the same run folder."""

from __future__ import annotations

import math
import time as clock
from pathlib import Path

import numpy as np

from sdph import case as cases
from sdph import output, particles
from sdph.effects import drain
from sdph.liquid import LIQUID
from sdph.liquid.outlet import Outlet
from sdph.liquid.step import LiquidStepper, kinetic_energy, loads, wall_loads

SAMPLES = 10  # rows of history.csv for each output of fields, where the case says nothing


class LiquidRun:
    """A liquid between its outputs; `progress.Reporter` reads it as it does a `Simulation`."""

    def __init__(self, case):
        self.case, self.stepper = case, LiquidStepper(case)
        self.time, self.windows = 0.0, 0
        self.load = loads(self.stepper)
        self.clock = self
        self.outlet = Outlet(self.stepper) if "drain" in case.effects else None
        self.fill = drain.command(case.parameters["drain"], self.outlet.fill) if self.outlet else None

    @property
    def state(self):
        return self.stepper.state

    @property
    def limit(self) -> str:
        return self.stepper.limit

    def advance(self, end: float) -> np.ndarray:
        """To `end` [s]; returns the mean force and moment (6,) on the tank on the way, from the momentum theorem."""
        start, impulse = self.time, np.zeros(6)
        while self.time < end:
            left = end - self.time
            dt = self.stepper.step(left)
            if self.outlet:
                self.outlet.command(self.fill(self.time + dt))
            load = loads(self.stepper)
            impulse += 0.5 * dt * (self.load + load)
            self.load = load
            self.time = end if dt >= left else self.time + dt
        self.windows += 1
        return impulse / (end - start) if end > start else self.load


def run(case, folder: Path, reporter) -> dict:
    """Run a liquid case into a new folder and return its summary."""
    started = clock.perf_counter()
    with output.claimed(output.create(folder)):
        output.write_text(folder / output.MARK, cases.dumps(case))
        return _run(case, folder, reporter, started)


def _run(case, folder: Path, reporter, started: float) -> dict:
    simulation = LiquidRun(case)
    history, fields = output.Table(folder / "history.csv"), Timeline(folder)
    fields.write(0.0, simulation.stepper)
    history.write(row(simulation, simulation.load))
    first = clock.perf_counter()
    for end, write in _moments(case):
        mean = simulation.advance(end)
        history.write(row(simulation, mean))
        if write:
            fields.write(end, simulation.stepper)
        reporter.progress(simulation)
    history.close()
    summary = _summary(simulation, started, first)
    output.write_summary(folder, summary)
    return summary


def _moments(case):
    """(time, whether fields are written) of every row of the history after the first."""
    every = case.run.output_interval
    interval = case.liquid.history_interval or every / SAMPLES
    outputs = {round(n * every, 12) for n in range(1, math.ceil(case.run.end_time / every))} | {case.run.end_time}
    rows = {round(n * interval, 12) for n in range(1, math.ceil(case.run.end_time / interval))}
    ends = sorted(rows | outputs | set(case.run.report_at))
    kept = [t for t, after in zip(ends, [*ends[1:], math.inf]) if after - t > 1e-9 * case.run.end_time or t in outputs]
    return [(t, t in outputs) for t in kept if t <= case.run.end_time]


def row(simulation, mean) -> dict[str, float]:
    """What history.csv holds: sums over the liquid, and loads on the tank."""
    s, case = simulation.state, simulation.case
    wet = s.kind >= LIQUID
    mass = s.mass[wet]
    places, velocities = particles.positions(s)[wet], particles.velocities(s)[wet]
    speed = np.sqrt((velocities**2).sum(axis=1))
    values = {
        "time_s": simulation.time,
        "mass_kg": float(mass.sum()),
        "kinetic_energy_J": kinetic_energy(s),
        "potential_energy_J": -float((mass * (places[:, : case.dimensions] @ np.array(case.domain.gravity))).sum()),
        "fastest_m_s": float(speed.max(initial=0.0)),
        "pressure_largest_Pa": float(simulation.stepper.pressure[wet].max(initial=0.0)),
    }
    middle = places.mean(axis=0)
    near = ((places - middle) ** 2).sum(axis=1) < (2.0 * case.resolution.spacing) ** 2
    values["centre_pressure_Pa"] = float(simulation.stepper.pressure[wet][near].mean()) if near.any() else math.nan
    for a, name in enumerate("xyz"[: case.dimensions]):
        values[f"centre_{name}_m"] = float((mass * places[:, a]).sum() / mass.sum())
        values[f"momentum_{name}_kg_m_s"] = float((mass * velocities[:, a]).sum())
        values[f"largest_{name}_m"] = float(places[:, a].max())
    if simulation.outlet:
        values["drained_kg"] = float(simulation.outlet.gone[0])
        values["commanded_kg"] = (simulation.outlet.fill - simulation.fill(simulation.time)) * simulation.stepper.capacity
    if "tank" in case.effects:
        for kind, load in (("mean", mean), ("wall", wall_loads(simulation.stepper))):
            for name, value in zip(("force_x_N", "force_y_N", "force_z_N", "moment_x_Nm", "moment_y_Nm", "moment_z_Nm"), load):
                values[f"{kind}_{name}"] = float(value)
    return values


def _summary(simulation, started: float, first: float) -> dict:
    case, stepper = simulation.case, simulation.stepper
    spent = clock.perf_counter() - first
    count = len(simulation.state.x)
    return {
        "title": case.title,
        "time_s": simulation.time,
        "particles": count,
        "liquid_particles": len(stepper.active),
        "steps": stepper.steps,
        "kinetic_energy_J": kinetic_energy(simulation.state),
        "particle_steps_per_s": count * stepper.steps / spent,
        "start_to_first_step_s": first - started,
        "wall_s": clock.perf_counter() - started,
    }


class Timeline:
    """Liquid particles by time: `run.pvd` opens in ParaView and pyvista."""

    def __init__(self, folder: Path):
        self.folder, self.entries = folder, []

    def write(self, time: float, stepper) -> None:
        name = f"fields/particles_{len(self.entries):05d}.vtp"
        points(stepper).save(self.folder / name)
        self.entries.append(f'<DataSet timestep="{time:.9g}" part="0" file="{name}"/>')
        output.write_text(self.folder / "run.pvd", output.PVD.format("\n".join(self.entries)))


def points(stepper):
    """Liquid particles as pyvista points."""
    import pyvista

    s = stepper.state
    wet = np.flatnonzero(s.kind >= LIQUID)
    cloud = pyvista.PolyData(particles.positions(s)[wet])
    cloud["velocity"] = particles.velocities(s)[wet]
    cloud["pressure"] = stepper.pressure[wet]
    for name in ("ident", "kind", "mass", "density"):
        cloud[name] = getattr(s, name)[wet]
    return cloud
