"""`sdph run`: a run from its case to its summary."""

from __future__ import annotations

import time
from pathlib import Path

from sdph import case as cases
from sdph import history, metrics, output, paths
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
    out = Outputs(folder, simulation)
    first = None
    while simulation.time < case.run.end_time:
        simulation.window()
        first = first or time.perf_counter() - started
        out.window()
        reporter.progress(simulation)
    out.close()
    summary = _summary(simulation, out) | {"start_to_first_window_s": first, "wall_s": time.perf_counter() - started}
    output.write_summary(folder, summary)
    return summary


class Outputs:
    """All that a run writes as it goes: history by window, fields and metrics by output interval."""

    def __init__(self, folder: Path, simulation):
        self.simulation = simulation
        self.fields = output.Fields(folder, simulation.gas, simulation.case.grains.density)
        self.history, self.metrics = output.Table(folder / "history.csv"), output.Table(folder / "metrics.csv")
        self.first, self.last, self.rows = history.row(simulation), {}, []
        self.history.write(self.first)
        self._write()

    def window(self) -> None:
        """After each window."""
        self.last = history.row(self.simulation)
        self.history.write(self.last)
        if self.simulation.time in self.simulation.clock.outputs:
            self._write()

    def close(self) -> None:
        for table in (self.history, self.metrics, self.simulation.ledger.table):
            table.close()

    def _write(self) -> None:
        self.fields.write(self.simulation.time, self.simulation.state, self.simulation.cell_fields())
        self.rows.append(metrics.row(self.simulation))
        self.metrics.write(self.rows[-1])


def _summary(simulation, out: Outputs) -> dict:
    """summary.json, less the wall time of the whole."""
    case = simulation.case
    summary = {
        "title": case.title,
        "time_s": simulation.time,
        "particles": len(simulation.state.x),
        "cells": len(simulation.gas.mesh.volumes),
        "windows": simulation.windows,
        "sub_steps": simulation.stepper.steps,
        "wall_contacts": simulation.stepper.contacts,
    }
    for name in case.probes:
        own = {key: value for key, value in out.last.items() if key.startswith(f"{name}_")}
        summary |= own | {f"{name}_rise_K": own[f"{name}_temperature_K"] - out.first[f"{name}_temperature_K"]}
    summary |= metrics.summary(case, out.rows) | simulation.ledger.summary()
    summary |= {f"wall_{part}_s": spent for part, spent in simulation.wall.items()}
    summary |= {f"{part}_ms_per_window": 1e3 * spent / simulation.windows for part, spent in simulation.wall.items()}
    return summary | {"particle_steps_per_s": len(simulation.state.x) * simulation.stepper.steps / simulation.wall["particles"]}
