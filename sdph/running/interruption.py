"""Ctrl-C, SIGTERM and SIGHUP: a run that is asked to stop ends its window, writes a checkpoint and goes."""

from __future__ import annotations

import os
import signal
import threading
from contextlib import contextmanager

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
# of llvmlite, called by LLVM while a kernel is compiled: what is raised in it is lost
CALLBACK = "_raw_object_cache_notify"
# s that a window and its checkpoint may still take once the run was asked to stop, and the shares of those before them:
# a gas that hangs takes for ever; our choice
PATIENCE, SHARES = 3.0, 2.0
LATER = 0.05  # s until a signal that came there is sent again; our choice


class Stopped(KeyboardInterrupt):
    """A run was asked to stop by a signal."""

    def __init__(self, number: int):
        super().__init__(f"stopped by {signal.Signals(number).name}")
        self.number = number


class Wish:
    """Request to stop the run. While it is `patient` the first signal only sets `number`; else, the second time, and
    where nobody has obeyed for `patience` [s], it raises `Stopped` at once."""

    def __init__(self):
        self.number, self.patient, self.timer = None, False, None
        self.patience = PATIENCE

    def __call__(self, number: int, frame) -> None:
        number = signal.SIGTERM if number == signal.SIGUSR1 else number  # as several processes are asked to stop
        if self.number is None and self.patient:
            self.number, self.timer = number, threading.Timer(self.patience, os.kill, (os.getpid(), number))
            self.timer.daemon = True
            self.timer.start()
        elif _called_from(CALLBACK, frame):
            threading.Timer(LATER, os.kill, (os.getpid(), number)).start()
        else:
            raise Stopped(number)

    def allow(self, spent: float) -> None:
        """Let the next window and its checkpoint take some `spent` [s] too; the one that was waited for has ended."""
        self.rest()
        self.patience = PATIENCE + SHARES * spent

    def obey(self, asked: int | None) -> None:
        """Raise `Stopped` where all processes heard of the signal `asked`; one that came since then is obeyed next."""
        if asked:
            raise Stopped(asked)

    def rest(self) -> None:
        """Send nothing any more."""
        if self.timer:
            self.timer.cancel()


def _called_from(name: str, frame) -> bool:
    """True where a function of that name is among those that are running."""
    while frame and frame.f_code.co_name != name:
        frame = frame.f_back
    return frame is not None


@contextmanager
def listening():
    """A `Wish` that hears the signals of this process; they are as before afterwards."""
    wish = Wish()
    if threading.current_thread() is not threading.main_thread():
        yield wish  # Python hands signals to the main thread alone
        return
    before = {number: signal.signal(number, wish) for number in (*SIGNALS, signal.SIGUSR1)}
    try:
        yield wish
    finally:
        wish.rest()
        for number, handler in before.items():
            signal.signal(number, handler)
