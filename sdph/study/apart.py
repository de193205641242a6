"""Commands of ours, each in a process of its own: what one of them does ends no other."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from sdph.study import pool

FINE, CHECK_FAILED, BAD_INPUT, GAS_FAILED, CANNOT_WRITE, WENT_UNSTABLE = 0, 1, 2, 3, 4, 5  # exit codes of `sdph`
LINGER = 30.0  # s that a run has to stop after Ctrl-C; our choice
_LIVE: set[subprocess.Popen] = set()  # commands of `ended` that are on their way


@dataclass(frozen=True)
class Command:
    """`sdph WORDS --json`, a command that prints checks, from `home`; `name` is that of what it judges."""

    name: str
    words: tuple[str, ...]
    home: str
    threads: int = 0  # 0: as many as there are


def judged(
    names: list[str], words: Callable[[str], tuple], who: tuple[int | None, str | None], say: Callable[[str], None]
) -> dict[str, dict]:
    """Outcomes by name, in the order given, of the commands `words(name)`, done by `who` (workers, scheduler) of
    `sdph.study.pool`."""
    threads = pool.threads_each(who[0])
    jobs = [Command(name, words(name), os.getcwd(), threads) for name in names]
    found: dict[str, dict] = {}
    for job, outcome in pool.outcomes(jobs, checked, *who):
        found[job.name] = outcome
        fine = sum(check["ok"] for check in outcome.get("checks", []))
        told = outcome["reason"] or f"{fine} of {len(outcome['checks'])} checks hold"
        say(f"{len(found)}/{len(jobs)} {job.name}: {told}, {outcome['took_s']:.0f} s")
    return {name: found[name] for name in names}


def checked(job: Command) -> dict:
    """Outcome of a command: `exit_code`, `checks`, and the `reason` where it did not come to judge."""
    command, begun = [sys.executable, "-m", "sdph.cli", *job.words, "--json"], time.monotonic()
    more = {"stdin": subprocess.DEVNULL, "capture_output": True, "text": True}
    done = subprocess.run(command, cwd=job.home, env=environment(job.threads), **more)
    code = _exit_code(done.returncode)
    outcome = {"exit_code": code, "reason": "", "checks": [], "took_s": time.monotonic() - begun}
    if code in (FINE, CHECK_FAILED) and done.stdout.startswith("{"):
        return outcome | {"checks": json.loads(done.stdout)["checks"]}
    return outcome | {"reason": reason(code, done.stderr.splitlines())}


def ended(command: list[str], **more) -> int:
    """Exit code of a command, 128 + signal where one ended it. Ctrl-C is the run's too, and SIGTERM within
    `stopped_together`: it may still write its checkpoint."""
    with subprocess.Popen(command, stdin=subprocess.DEVNULL, **more) as process:
        _LIVE.add(process)
        try:
            code = process.wait()
        except (KeyboardInterrupt, SystemExit):
            process.wait(LINGER)
            raise
        finally:
            _LIVE.discard(process)
    return _exit_code(code)


@contextlib.contextmanager
def stopped_together() -> Iterator[None]:
    """SIGTERM and SIGHUP to this process are those of the commands that it waits for, too; then it exits by 128 +
    signal."""

    def stop(number, _) -> None:
        for process in tuple(_LIVE):
            process.send_signal(number)
        raise SystemExit(128 + number)

    before = {number: signal.signal(number, stop) for number in (signal.SIGTERM, signal.SIGHUP)}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _exit_code(code: int) -> int:
    """Exit code as a shell tells it: 128 + signal where one ended the command."""
    return code if code >= 0 else 128 - code


def environment(threads: int) -> dict[str, str]:
    """Environment of a command that may take so many threads; 0: as many as there are."""
    own = {"NUMBA_NUM_THREADS": str(threads)} if threads else {}
    return own | os.environ  # what the user has set stays


def reason(code: int, said: list[str]) -> str:
    """The line with which a run that failed says why."""
    if code == FINE:
        return ""
    own = [line.removeprefix("sdph: ") for line in said if line.startswith("sdph: ")]
    return (own or said[-1:] or [f"ended with {code} and said nothing"])[-1]
