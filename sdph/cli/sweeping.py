"""`sdph sweep`: many runs of one case."""

from __future__ import annotations

import sys
from pathlib import Path

from sdph.schema import CaseError


def sweep(options) -> int:
    """Do what is left of a sweep; 1 where a run of it has failed."""
    from sdph.running import output
    from sdph.study import apart
    from sdph.study.sweep import table
    from sdph.study.sweep.sweep import Wish, sweep

    if options.over and not options.plot:
        raise CaseError(f"--over {options.over}: there is nothing to draw; give --plot METRIC too")
    out = options.out or Path("runs") / f"sweep-{Path(options.target).resolve().name}"
    more = [("coupling.gas", options.gas and f'"{options.gas}"'), ("run.end_time_s", options.until)]
    wish = Wish(
        options.target, tuple(options.set), out, table=options.table,
        more=tuple(f"{key}={value}" for key, value in more if value is not None),
        flags=("--allow-code",) * options.allow_code, workers=options.workers, scheduler=options.scheduler,
        metrics=tuple(options.plot), over=options.over, again=options.again,
    )  # fmt: skip
    with apart.stopped_together():
        rows = sweep(wish, lambda text: print(text, file=sys.stderr, flush=True))
    failed = [row for row in rows if row["exit_code"] != 0]
    for row in failed:
        print(f"failed with {row['exit_code']}: {row['run']}: {row['reason']}", file=sys.stderr)
    print(output.strict_json(rows) if options.json else f"{len(rows) - len(failed)} of {len(rows)}: {out / table.FILE}")
    return 1 if failed else 0
