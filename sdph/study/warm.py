"""`sdph warm`: kernels of cases compiled before somebody waits for them, each case in a process of its own."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable

from sdph.study import pool
from sdph.study.apart import FINE, Command, environment, reason

AS_LATER = 0  # threads, as many as a run by itself has: those of one thread are other kernels (sdph.laws.cached)
MOMENT = 1e-6  # s, a run so short that it takes one window: it calls each kernel that a longer one calls; our choice


def warm(targets: list[str], gas: str | None, who: tuple[int | None, str | None], say: Callable[[str], None]) -> int:
    """Exit code of the first case that cannot be run, FINE without one; `who` as in `sdph.study.pool`, `say` hears how
    each went."""
    words = ("--gas", gas) if gas else ()
    jobs = [Command(target, ("run", target, *words), os.getcwd(), AS_LATER) for target in targets]
    worst = FINE
    for number, (job, outcome) in enumerate(pool.outcomes(jobs, warmed, *who), 1):
        say(f"{number}/{len(jobs)} {job.name}: {outcome['reason'] or 'is warm'}, {outcome['took_s']:.0f} s")
        worst = worst or outcome["exit_code"]
    return worst


def warmed(job: Command) -> dict:
    """Outcome of a run of a moment, of which nothing is kept: `exit_code`, `reason` and `took_s`."""
    begun = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="sdph-warm-") as folder:
        out = ("--until", repr(MOMENT), "--out", os.path.join(folder, "run"), "--json")
        command = [sys.executable, "-m", "sdph.cli", *job.words, *out]
        more = {"stdin": subprocess.DEVNULL, "capture_output": True, "text": True}
        done = subprocess.run(command, cwd=job.home, env=environment(job.threads), **more)
    told = reason(done.returncode, done.stderr.splitlines())
    return {"exit_code": done.returncode, "reason": told, "took_s": time.monotonic() - begun}
