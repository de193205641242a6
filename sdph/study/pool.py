"""Workers of studies: this process, one job after the other, or workers of dask, here or on a cluster."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator

from sdph.schema import CaseError


def threads_each(workers: int | None) -> int:
    """Threads of a run where `workers` share this machine; 0, as many as there are, for one alone or elsewhere."""
    return max(1, (os.cpu_count() or 1) // workers) if workers else 0


def outcomes(
    jobs: list, done: Callable, workers: int | None = None, scheduler: str | None = None
) -> Iterator[tuple[object, dict]]:
    """Each job, which has a `name`, with its outcome `done(job)`, as they end: by `workers` of this machine, by those
    of a `scheduler` (its address), or else one by one."""
    if not jobs:
        return
    if workers is None and scheduler is None:
        for job in jobs:
            yield job, done(job)
        return
    distributed = _dask()
    with _client(distributed, workers, scheduler) as client:
        futures = {client.submit(done, job, key=f"sdph-{job.name}", pure=False): job for job in jobs}
        for future in distributed.as_completed(futures, loop=client.loop):
            yield futures[future], _outcome(future)


def _outcome(future) -> dict:
    """Outcome of a job that a worker had; a worker that is lost has failed."""
    try:
        return future.result()
    except Exception as error:
        return {"exit_code": 1, "reason": f"its worker failed: {error}", "took_s": 0.0}


def _dask():
    try:
        import distributed
    except ImportError:
        raise CaseError(
            "--workers and --scheduler need the package distributed of dask, which is missing: pip install "
            "'sdph[sweep]', or leave them out: then one run follows the other"
        ) from None
    return distributed


def _client(distributed, workers: int | None, scheduler: str | None):
    """A client of the scheduler, or of workers here, each a thread that waits for the process of its run."""
    if scheduler is None:
        return distributed.Client(
            n_workers=workers, threads_per_worker=1, processes=False, dashboard_address=None, set_as_default=False
        )
    try:
        return distributed.Client(scheduler, set_as_default=False, timeout="10s")
    except (OSError, ValueError) as error:
        raise CaseError(
            f"--scheduler {scheduler}: no scheduler of dask answers there ({error}); start one: dask scheduler"
        ) from None
