"""Progress of a run: one line that is rewritten on a terminal, plain lines elsewhere, and a page of it with
`--watch`."""

from __future__ import annotations

import sys
import time

from sdph.engine import state as particles

LINE_INTERVAL = 10.0  # s between plain lines
OF_HEAT = ("T", "heat")  # residuals of the equation of the gas's temperature, by OpenFOAM and the embedded gas
REFRESH = 0.2  # s between changes of the line on a terminal


class Reporter:
    """Shows where a run is: `status` tells of waiting and warns, `progress` of windows done; `page` draws them.

    Both speak on stderr, not at all where `quiet`, and without `line` not of windows.
    """

    def __init__(self, quiet: bool = False, line: bool = True, page=None):
        self.quiet, self.line, self.page = quiet, line, page
        self.shown, self.begun = time.perf_counter(), None
        self.bar = None if quiet or not line or not sys.stderr.isatty() else _bar()

    def status(self, text: str) -> None:
        if self.bar:
            self.bar.console.print(text)
        elif not self.quiet:
            try:
                print(text, file=sys.stderr, flush=True)
            except BrokenPipeError:  # whoever read it has read enough; the run goes on
                self.quiet = True

    def progress(self, simulation) -> None:
        """Show the state of a run after a window."""
        now = time.perf_counter()
        self.begun = self.begun or (now, simulation.time)
        if self.page:
            self.page.show(simulation, self._line(simulation, now))
        if not self.line or now - self.shown < (REFRESH if self.bar else LINE_INTERVAL):
            return
        self.shown = now
        if not self.bar:
            self.status(self._line(simulation, now))
            return
        task = self.bar.task_ids[0] if self.bar.task_ids else self.bar.add_task("")
        self.bar.update(
            task, total=simulation.clock.end, completed=simulation.time, description=self._line(simulation, now)
        )

    def close(self) -> None:
        if self.bar:
            self.bar.stop()

    def _line(self, simulation, now: float) -> str:
        """Time, window and what rules it, particles, residual, closure of the ledger, time left."""
        began, at = self.begun
        ledger, gas = simulation.ledger, simulation.gas and simulation.gas_state.budget.residuals
        parts = [f"t = {simulation.time:.4g} s", f"window {ledger.last['window_s']:.2e} s ({simulation.clock.limit})"]
        state = simulation.state
        parts.append(f"{particles.count(state) - int((state.kind == particles.WALL).sum())} particles")
        if gas and not simulation.case.warm:
            gas = {name: left for name, left in gas.items() if name not in OF_HEAT}
        if gas:
            parts.append("residual {1:.0e} ({0})".format(*max(gas.items(), key=lambda item: item[1])))
        closure = {key: value for key, value in ledger.summary().items() if key.endswith(("drift_rel", "mismatch_rel"))}
        worst, name = max((value, key.removesuffix("_rel")) for key, value in closure.items())
        parts.append(f"closure {worst:.0e} ({name})")
        if simulation.time > at:
            left = (simulation.clock.end - simulation.time) / (simulation.time - at)
            parts.append(f"{(now - began) * left:.0f} s left")
        return ", ".join(parts)


def _bar():
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn

    bar = Progress(TextColumn("{task.description}"), BarColumn(bar_width=20), console=Console(stderr=True))
    bar.start()
    return bar
