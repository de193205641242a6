"""A whole sweep: points, what is done already, the runs, table and figure."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from sdph.schema import CaseError
from sdph.study import pool
from sdph.study.sweep import jobs as runs
from sdph.study.sweep import plan, table


@dataclass(frozen=True)
class Wish:
    """Options of `sdph sweep`."""

    target: str
    sets: tuple[str, ...]
    out: Path
    table: Path | None = None
    more: tuple[str, ...] = ()  # overrides that all runs have
    flags: tuple[str, ...] = ()  # options of `sdph run` that all have
    workers: int | None = None
    scheduler: str | None = None
    metrics: tuple[str, ...] = ()
    over: str | None = None
    again: bool = False  # also what failed in a way that lasts


def sweep(wish: Wish, say: Callable[[str], None]) -> list[dict]:
    """Rows of sweep.csv; what was done by an earlier call into the same folder is not done again."""
    points = plan.points(list(wish.sets), wish.table)
    if points == [{}]:
        raise CaseError("a sweep needs values: give --set section.key=v1,v2 (or a:b:n), or --table FILE")
    threads = pool.threads_each(wish.workers)
    all_jobs = runs.jobs_of(wish.target, points, wish.more, wish.flags, wish.out, threads)
    axis = table.axis(all_jobs, wish.over) if wish.metrics else None
    wish.out.mkdir(parents=True, exist_ok=True)
    outcomes, before = {}, table.read(wish.out)
    for job in all_jobs:
        if stands := runs.standing(job, before, wish.again):
            outcomes[job.name] = stands
    left = [job for job in all_jobs if job.name not in outcomes]
    say(f"{len(all_jobs)} runs, {len(left)} of them to do, in {wish.out / runs.RUNS}")
    keys, metrics = list(points[0]), list(wish.metrics)
    found, told = table.write(wish.out, all_jobs, outcomes), ""
    if found and left:
        table.refuse_unknown(found, keys, metrics, len(left))
    for job, outcome in pool.outcomes(left, runs.done, wish.workers, wish.scheduler):
        outcomes[job.name] = outcome
        found = table.write(wish.out, all_jobs, outcomes)
        say(f"{len(outcomes)}/{len(all_jobs)} {job.name}: {outcome['reason'] or 'fine'}, {outcome['took_s']:.0f} s")
        if len(outcomes) < len(all_jobs):
            table.refuse_unknown(found, keys, metrics, len(all_jobs) - len(outcomes))
            told = told or _awaited(found, keys, metrics, say)
    if axis:
        _draw(wish, found, keys, metrics, axis, say)
    return found


def _awaited(found: list[dict], keys: list[str], metrics: list[str], say: Callable[[str], None]) -> str:
    """Say once, as soon as a summary is known, which metrics it does not have."""
    if line := table.awaited(found, keys, metrics):
        say(line)
    return line


def _draw(wish: Wish, found: list[dict], keys: list[str], metrics: list[str], axis, say) -> None:
    """Draw what is known of the metrics; `CaseError` of those that no summary has, after that."""
    own = table.known(found, keys)
    there = [name for name in metrics if name in own]
    if there or not own:  # where all runs failed their crosses are drawn
        say(f"{table.draw(found, keys, there or metrics, axis, wish.out / table.FIGURE)}")
    table.refuse_unknown(found, keys, metrics)
