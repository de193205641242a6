"""Waiting for a peer that may be dead or silent."""

from __future__ import annotations

import time
from collections.abc import Callable

SLICE = 0.2  # s between two looks at whether the peer is alive


def always() -> bool:
    """Take a peer that nobody watches to be alive."""
    return True


def check_wait(deadline: float, alive: Callable[[], bool]) -> None:
    """ConnectionError where the peer has ended, TimeoutError after the deadline (of `time.monotonic`)."""
    if not alive():
        raise ConnectionError("the peer has ended")
    if time.monotonic() >= deadline:
        raise TimeoutError("no message in time")
