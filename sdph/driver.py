"""`sdph run`: a run from its case to its summary."""

from __future__ import annotations

import time
from pathlib import Path

from sdph import case as cases
from sdph import output, paths
from sdph.ledger import Ledger
from sdph.simulation import Simulation


def run(case, name: str, folder: Path, gas_folder: Path | None, reporter) -> dict:
    """Run a case into a new folder and return its summary.

    `gas_folder` holds the user's own OpenFOAM case (None: the scene's template); `reporter` shows progress.
    """
    started = time.perf_counter()
    output.create(folder)
    output.write_text(folder / output.MARK, cases.dumps(case))
    gas = open_gas(case, name, folder, gas_folder, reporter.status)
    try:
        return _coupled(case, gas, folder, reporter, started)
    finally:
        gas.close()


def open_gas(case, name: str, folder: Path, gas_folder: Path | None, status):
    """The gas solver that the case asks for; `auto` takes OpenFOAM where it is built, else the embedded one."""
    chosen = case.coupling.gas
    if chosen == "auto":
        from coupling.openfoam import install

        chosen = "openfoam" if install.find() else "embedded"
        if chosen == "embedded":
            status("OpenFOAM was not found: the gas is solved by the embedded solver (sdph openfoam setup --install gets it)")
    if chosen == "embedded":
        from coupling.embedded import EmbeddedGas

        return EmbeddedGas(case)
    from coupling.openfoam.solver import OpenFoamGas

    template = gas_folder or paths.data("openfoam_case_templates") / name / "gas"
    return OpenFoamGas(case, folder / "gas", template, status=status)


def _coupled(case, gas, folder: Path, reporter, started: float) -> dict:
    """The loop over windows with its outputs."""
    simulation = Simulation(case, gas, Ledger(folder / "ledger.csv", case, gas.mesh.depth))
    simulation.start()
    fields, history = output.Fields(folder, gas, case.grains.density), output.Table(folder / "history.csv")
    history.write(_history(simulation))
    fields.write(0.0, simulation.state, simulation.cell_fields())
    first = None
    while simulation.time < case.run.end_time:
        simulation.window()
        first = first or time.perf_counter() - started
        history.write(_history(simulation))
        if simulation.time in simulation.clock.outputs:
            fields.write(simulation.time, simulation.state, simulation.cell_fields())
        reporter.progress(simulation)
    for table in (history, simulation.ledger.table):
        table.close()
    summary = _summary(simulation, time.perf_counter() - started, first)
    output.write_summary(folder, summary)
    return summary


def _history(simulation) -> dict[str, float]:
    row = {"time_s": simulation.time}
    for name, probe in simulation.case.probes.items():
        row |= {f"{name}_{key}": value for key, value in simulation.probe(probe.at).items()}
    return row


def _summary(simulation, wall: float, first: float) -> dict:
    case = simulation.case
    summary = {
        "title": case.title,
        "time_s": simulation.time,
        "particles": len(simulation.state.x),
        "cells": len(simulation.gas.mesh.volumes),
        "windows": simulation.windows,
        "sub_steps": simulation.stepper.steps,
    }
    for name, probe in case.probes.items():
        summary |= {f"{name}_{key}": value for key, value in simulation.probe(probe.at).items()}
        summary[f"{name}_rise_K"] = summary[f"{name}_temperature_K"] - simulation.initial[name]
    summary |= simulation.ledger.summary()
    summary |= {f"wall_{part}_s": spent for part, spent in simulation.wall.items()}
    summary |= {f"{part}_ms_per_window": 1e3 * spent / simulation.windows for part, spent in simulation.wall.items()}
    stepping = simulation.wall["particles"] or wall
    summary["particle_steps_per_s"] = len(simulation.state.x) * simulation.stepper.steps / stepping
    return summary | {"start_to_first_window_s": first, "wall_s": wall}
