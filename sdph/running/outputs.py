"""All that a run writes as it goes, beside its ledger and its checkpoints."""

from __future__ import annotations

from pathlib import Path

from sdph.engine import state as particles
from sdph.engine.kept import ROW, Many, Unfit
from sdph.engine.table import Table
from sdph.running import averages, metrics
from sdph.running.extremes import Extremes
from sdph.running.fields import Fields


class Outputs:
    """All that a run writes as it goes: history by row, fields and metrics by output interval."""

    KEPT = ("fields", "history", "metrics", "first", "last", "rows", "extremes")  # see sdph.engine.kept
    FORMS = {"first": ROW, "last": ROW, "rows": Many(ROW)}

    def __init__(self, folder: Path, simulation, world):
        """Outputs into a folder, of which the chief of a world writes all but the particles of other processes."""
        self.simulation, self.fields, self.folder = simulation, Fields(folder, world), folder
        tables = (folder / name if world.chief else None for name in ("history.csv", "metrics.csv"))
        self.history, self.metrics = (Table(file) for file in tables)
        self.first, self.last, self.rows, self.extremes = {}, {}, [], Extremes(simulation.case)

    def admit(self, kept: dict) -> None:
        """Unfit where a kept row is not of the columns of its table, or holds what is no number."""
        first, last, rows = kept["first"], kept["last"], kept["rows"]
        own, metric = kept["history"]["columns"], kept["metrics"]["columns"]
        for row, columns in ((first, own), (last or first, own), *((row, metric) for row in rows)):
            if not row.keys() <= set(columns) or any(isinstance(value, str) for value in row.values()):
                raise Unfit("a row of the history or of the metrics is not of the columns of its table")

    def start(self) -> None:
        """The rows and fields of the start, and the walls, which stay as they are."""
        self.fields.write_walls(self.simulation.walls())
        self.first = self.simulation.row()
        self._keep(self.first)
        self._write()

    def window(self) -> None:
        """Write what is due after a window."""
        if self.simulation.at_row:
            self.last = self.simulation.row()
            self._keep(self.last)
        if self.simulation.clock.writes(self.simulation.time):
            self._write()

    def _keep(self, row: dict) -> None:
        self.history.write(row)
        self.extremes.hear(row)

    def close(self) -> None:
        for table in self._tables():
            table.close()

    def _tables(self) -> tuple:
        return self.history, self.metrics, *self.simulation.tables()

    def _write(self) -> None:
        self.fields.write(self.simulation.time, self.simulation.meshes())
        self.rows.append(metrics.row(self.simulation))
        self.metrics.write(self.rows[-1])
        for table in self._tables():  # who looks at a run that goes on sees all up to its last output
            table.flush()
        averages.write(self.folder, self.simulation)

    def summary(self) -> dict:
        """summary.json, less the wall time of the whole."""
        now = self.simulation
        with now.whole():
            case, count = now.case, particles.count(now.state)
        found = {"title": case.title, "time_s": now.time, "particles": count, "windows": now.windows}
        found |= now.summary(self) | self.extremes.summary() | metrics.summary(case, self.rows) | now.ledger.summary()
        found |= {f"wall_{part}_s": spent for part, spent in now.wall.items()}
        parts = {part: spent for part, spent in now.wall.items() if part != "compiling"}
        found |= {f"{part}_ms_per_window": 1e3 * spent / now.windows for part, spent in parts.items()}
        return found | {"particle_steps_per_s": count * now.stepper.steps / now.wall["particles"]}
