"""Processes of a run: which there are, whether they are gone."""

from __future__ import annotations

import contextlib
import os
import signal
import time
from pathlib import Path

LINGER = 5.0  # s after which nothing of a run may be there any more


def gone(folder: Path) -> bool:
    deadline = time.monotonic() + LINGER
    while processes(folder) and time.monotonic() < deadline:
        time.sleep(0.1)
    return not processes(folder)


def processes(folder: Path) -> list[tuple[int, str]]:
    """(pid, name) of every process whose command names the folder."""
    found = []
    for path in Path("/proc").glob("[0-9]*"):
        try:
            words = (path / "cmdline").read_bytes().decode(errors="replace").split("\0")
        except OSError:
            continue  # it has ended meanwhile
        if any(word == str(folder) or word.startswith(f"{folder}/") for word in words):
            found.append((int(path.name), Path(words[0]).name))
    return sorted(found)


def send(pids: list[int], number: signal.Signals) -> None:
    for pid in pids:
        with contextlib.suppress(ProcessLookupError):  # it has ended meanwhile
            os.kill(pid, number)
