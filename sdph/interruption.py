"""Ctrl-C, SIGTERM and SIGHUP: a run that is asked to stop ends its window, writes a checkpoint and goes."""

from __future__ import annotations

import signal
import threading
from contextlib import contextmanager

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class Stopped(KeyboardInterrupt):
    """A run was asked to stop by a signal."""

    def __init__(self, number: int):
        super().__init__(f"stopped by {signal.Signals(number).name}")
        self.number = number


class Wish:
    """Whether somebody wants the run to stop. While it is `patient` the first signal only sets `number`; else, and the
    second time, it raises `Stopped` at once."""

    def __init__(self):
        self.number, self.patient = None, False

    def __call__(self, number: int, frame) -> None:
        if self.number is None and self.patient:
            self.number = number
            return
        raise Stopped(number)

    def obey(self) -> None:
        """Raise `Stopped` where it was asked for."""
        if self.number is not None:
            raise Stopped(self.number)


@contextmanager
def listening():
    """A `Wish` that hears the signals of this process; they are as before afterwards."""
    wish = Wish()
    if threading.current_thread() is not threading.main_thread():
        yield wish  # Python hands signals to the main thread alone
        return
    before = {number: signal.signal(number, wish) for number in SIGNALS}
    try:
        yield wish
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
