"""Progress of long work: a bar with the time left on a terminal, plain lines elsewhere."""

from __future__ import annotations

import sys
import time

LINE_INTERVAL = 10.0  # s between plain lines


class Reporter:
    """Shows where a run is. `status` tells of waiting, `progress` of windows done; all of it goes to stderr."""

    def __init__(self, quiet: bool = False):
        self.quiet = quiet
        self.started = self.shown = time.perf_counter()
        self.bar = None if quiet or not sys.stderr.isatty() else _bar()

    def status(self, text: str) -> None:
        if self.bar:
            self.bar.console.print(text)
        elif not self.quiet:
            print(text, file=sys.stderr, flush=True)

    def progress(self, simulation) -> None:
        clock = simulation.clock
        end = simulation.case.run.end_time
        text = f"t = {simulation.time:.4g} s, window {simulation.windows} ({clock.limit}), {len(simulation.state.x)} particles"
        if self.bar:
            task = self.bar.task_ids[0] if self.bar.task_ids else self.bar.add_task("", total=end)
            self.bar.update(task, completed=simulation.time, description=text)
        elif time.perf_counter() - self.shown > LINE_INTERVAL:
            self.shown = time.perf_counter()
            left = (self.shown - self.started) * (end / simulation.time - 1.0)
            self.status(f"{text}, {left:.0f} s left")

    def close(self) -> None:
        if self.bar:
            self.bar.stop()


def _bar():
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    columns = TextColumn("{task.description}"), BarColumn(), TimeRemainingColumn()
    bar = Progress(*columns, console=Console(stderr=True))
    bar.start()
    return bar
