"""Tells once that kernels are compiled, which keeps the first run of a case waiting in silence; and for how long."""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import Callable, Iterator

from numba.core import event

from sdph.laws.cached import WATCH

PATIENCE = 2.0  # s of compiling of which nobody need hear; our choice
TEXT = "compiling kernels, about a minute the first time that a case has these effects"


class Listener(event.Listener):
    """Hears numba begin and end to compile what it does not find in its cache, callees within their callers."""

    def __init__(self, tell: Callable[[str], None]):
        self.tell, self.depth, self.timer, self.told = tell, 0, None, False

    def on_start(self, event) -> None:
        self.depth += 1
        if self.depth == 1 and not self.told:
            self.timer = threading.Timer(PATIENCE, self._tell)
            self.timer.daemon = True
            self.timer.start()

    def on_end(self, event) -> None:
        self.depth -= 1
        if self.depth == 0 and self.timer:
            self.timer.cancel()

    def _tell(self) -> None:
        self.told = True
        self.tell(TEXT)


def timed(wall: dict[str, float], part: str, function, *arguments):
    """Result of a function; its wall time [s] counts for a part of `wall`, and for "compiling" what kernels took."""
    begun, before = time.perf_counter(), WATCH.spent
    result = function(*arguments)
    compiled = WATCH.spent - before
    wall[part] += time.perf_counter() - begun - compiled
    wall["compiling"] += compiled
    return result


@contextlib.contextmanager
def told(tell: Callable[[str], None]) -> Iterator[None]:
    """Within the context `tell` hears one line where a kernel takes longer than PATIENCE to compile."""
    listener = Listener(tell)
    with event.install_listener("numba:compile", listener):
        yield
