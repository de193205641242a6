"""Runs of a sweep, each `sdph run` in a process and a folder of its own.

A folder is called by the values of its point and a hash of the resolved case: a sweep that is called again, with more
values too, finds what it has done, and a case that was changed is another.
"""

from __future__ import annotations

import hashlib
import os
import re
import shutil
import sys
import time
from dataclasses import dataclass
from pathlib import Path

from sdph import scenes
from sdph.case import read as cases
from sdph.running import inputs, output, vessel
from sdph.schema import CaseError
from sdph.study.apart import BAD_INPUT, FINE, WENT_UNSTABLE, ended, environment, reason

LASTING = (BAD_INPUT, WENT_UNSTABLE)  # failures that come again when nothing is changed
RUNS = "runs"  # folder in that of the sweep
NAME, EACH, HASH = 60, 24, 8  # letters of a folder's name; of one value in it


@dataclass(frozen=True)
class Job:
    """A point, the folder and the command of its run, from `home`; `refused` says why it cannot be run."""

    point: dict[str, str]
    folder: str
    command: tuple[str, ...]
    home: str
    threads: int = 0  # of a run; 0: as many as there are
    refused: str = ""

    @property
    def name(self) -> str:
        return Path(self.folder).name


def jobs_of(target: str, points: list[dict], more: tuple[str, ...], flags: tuple[str, ...], out: Path, threads: int):
    """The job of each point; `more` are overrides and `flags` options of `sdph run` that all have. `CaseError` where no
    point can be run."""
    _, file = scenes.find(target)
    jobs = [_job(target, file, point, more, flags, out, threads) for point in points]
    if all(job.refused for job in jobs):
        raise CaseError(jobs[0].refused)
    return list({job.folder: job for job in jobs}.values())  # values that are the same twice are one run


def _job(target: str, file: Path, point: dict, more: tuple, flags: tuple, out: Path, threads: int) -> Job:
    given = tuple(f"{key}={value}" for key, value in point.items() if value)
    try:
        case = vessel.load(file, (*more, *given))
        inputs.check(case)
        told, refused = "\n".join([cases.dumps(case), *inputs.digests(case, file)]), ""
    except CaseError as error:
        told, refused = repr(given), str(error)
    digest = hashlib.sha256(told.encode()).hexdigest()[:HASH]
    words = (f"{key.rpartition('.')[2]}={value}" for key, value in point.items() if value)
    short = "_".join(re.sub(r"[^A-Za-z0-9.,=+-]+", "_", word)[:EACH] for word in words)
    name = f"{short[:NAME]}-{digest}".lstrip("-.")
    folder = os.path.abspath(out / RUNS / name)
    sets = tuple(word for text in (*more, *given) for word in ("--set", text))
    return Job(point, folder, (target, "--out", folder, *sets, *flags), os.getcwd(), threads, refused)


def standing(job: Job, before: dict[str, dict], again: bool) -> dict | None:
    """The outcome of a job that need not be done: it is finished, cannot be run, or failed `before` (by name) in a way
    that lasts."""
    if job.refused:
        return {"exit_code": BAD_INPUT, "reason": job.refused}
    if (Path(job.folder) / "summary.json").is_file():
        return {"exit_code": FINE, "reason": ""}
    own = before.get(job.name)
    return own if own and own["exit_code"] in LASTING and not again else None


def done(job: Job) -> dict:
    """Outcome of a job that is run to its end, from its last checkpoint where there is one: `exit_code` and `reason`.

    It needs nothing but its argument: a worker elsewhere that sees the same files can do it.
    """
    folder, begun = Path(job.folder), time.monotonic()
    if (folder / output.MARK).is_file() and (folder / output.ORIGIN).is_file():
        words = ["--resume", job.folder, *(word for word in job.command if word == "--allow-code")]
    else:
        shutil.rmtree(folder, ignore_errors=True)  # what was cut before it was a run
        words = list(job.command)
    folder.parent.mkdir(parents=True, exist_ok=True)
    with open(f"{job.folder}.log", "w+", encoding="utf-8") as log:
        command = [sys.executable, "-m", "sdph.cli", "run", *words]
        code = ended(command, cwd=job.home, env=environment(job.threads), stdout=log, stderr=log)
        log.seek(0)
        said = log.read().splitlines()
    return {"exit_code": code, "reason": reason(code, said), "took_s": time.monotonic() - begun}
