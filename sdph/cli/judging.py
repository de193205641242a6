"""`sdph stress`, `sdph validate`, `sdph warm` and `sdph bench`: commands that do many things, here or by workers."""

from __future__ import annotations

import contextlib
import functools
import sys
from pathlib import Path

from sdph.schema import CaseError
from sdph.study import apart
from sdph.study.apart import CHECK_FAILED, FINE


def stress_cases(options) -> int:
    """Run the hard cases, their map or the faults of `sdph stress`."""
    if options.json and (options.map or options.faults is not None):
        raise CaseError("--json is of the hard cases; --map and --faults print their own tables: leave it out")
    whole = "--map" if options.map else "--faults" if options.faults is not None else ""
    if whole and (options.case or options.fast):
        raise CaseError(f"{whole} is not of single hard cases: leave {', '.join(options.case) or '--fast'} out")
    if options.faults is not None:
        from sdph.study.stress import faults

        return FINE if all(check["ok"] for check in faults.run(options.faults)) else CHECK_FAILED
    from sdph.study.stress import boundaries, suite

    if options.map:
        print(boundaries.table(Path("stress_map.png")))
        return FINE
    hard = suite.chosen(options.case, options.fast)
    if _by_workers(options):
        return _apart([own.name for own in hard], lambda name: ("stress", name), options)
    verdicts = []
    for own in hard:
        verdicts.append(suite.run(own))
        if not options.json:
            suite.show(verdicts[-1])
    fine = [verdict.ok for verdict in verdicts]
    if options.json:
        _tell([check for verdict in verdicts for check in verdict.checks], True)
    else:
        print(f"{sum(fine)} of {len(fine)} pass")
    return FINE if all(fine) else CHECK_FAILED


def validate_scene(options) -> int:
    """Check one scene, or all, each in a process of its own."""
    from coupling.openfoam.programs import run as programs
    from sdph.running.interruption import listening
    from sdph.running.progress import Reporter
    from sdph.study import record, validate

    if options.record and options.set:
        raise CaseError(f"--record {options.record}: a record is of the scene as it is; leave --set out")
    if options.scene is None:
        return _apart(validate.validated(), lambda name: _words(name, options), options)
    study, _, part = options.scene.partition(".")
    if options.record and part and study in validate.STUDIES:
        record.with_parts(options.record, study)  # before the part is run
    if _by_workers(options):
        raise CaseError("--workers and --scheduler part the scenes among them; leave them out for one scene")
    overrides = tuple(options.set) + ((f'coupling.gas="{options.gas}"',) if options.gas else ())
    with listening(), contextlib.closing(Reporter(line=not options.json)) as reporter, programs.told(reporter.status):
        acted, folder = {}, options.out and options.out / options.scene
        checks = validate.validate(options.scene, overrides, reporter, folder, acted)
    if not options.set:
        checks += _vanished(options, checks)
    if options.record and part:
        record.write_part(options.record, study, part, checks, options.gas, validate.parts(study))
    elif options.record:
        record.write(options.record, study, checks, options.gas, acted, validate.long(study))
    _tell(checks, options.json)
    return FINE if all(check["ok"] for check in checks) else CHECK_FAILED


def _vanished(options, checks: list[dict]) -> list[dict]:
    """Failed checks for those of the scene's record that this run lacks, and a line that says what to do."""
    from sdph.study import validate

    found = validate.vanished(options.scene, checks, options.record)
    if found:
        print(
            f"sdph: {options.scene} lacks {len(found)} checks that its record has (nan in the table); where they were "
            "meant to go, delete them from the record",
            file=sys.stderr,
        )
    return found


def _words(name: str, options) -> tuple[str, ...]:
    """Command that validates a scene as all are; a study without a gas is told of none."""
    from sdph.study import validate

    more = [("--set", text) for text in options.set]
    more += [(f"--{key}", str(given)) for key in ("record", "out") if (given := getattr(options, key))]
    if options.gas and any("coupling.gas".startswith(own) for own in validate.STUDIES.get(name, ("coupling.",))):
        more.append(("--gas", options.gas))
    return ("validate", name, *(word for pair in more for word in pair))


def warm_cases(options) -> int:
    """Compile the kernels of cases, here or by workers."""
    from sdph import scenes
    from sdph.study.warm import warm

    targets = options.target or scenes.names()
    for target in targets:
        scenes.find(target)
    say = functools.partial(print, file=sys.stderr, flush=True)
    return warm(targets, options.gas, (options.workers, options.scheduler), say)


def bench(options) -> int:
    """Measure the main ratios of speed, or those of several processes."""
    from sdph.running import output
    from sdph.study import bench, bench_ranks

    say = functools.partial(print, file=sys.stderr, flush=True)
    rows = bench_ranks.rows(options.ranks, say) if options.ranks else bench.rows(say)
    print(output.strict_json(bench.record(rows)) if options.json else bench.table(rows))
    return FINE


def _by_workers(options) -> bool:
    return options.workers is not None or options.scheduler is not None


def _apart(names: list[str], words, options) -> int:
    """Judge each of the names by a command of its own; the worst exit code of those that came to no judgement, else
    whether all checks hold."""
    who = options.workers, options.scheduler
    found = apart.judged(names, words, who, lambda text: print(text, file=sys.stderr, flush=True))
    _tell([check for outcome in found.values() for check in outcome.get("checks", [])], options.json)
    return max(outcome["exit_code"] for outcome in found.values())


def _tell(checks: list[dict], as_json: bool) -> None:
    from sdph.running import output
    from sdph.study import compare

    told = [{key: value for key, value in check.items() if key != "part"} for check in checks]
    print(output.strict_json({"checks": told}) if as_json else compare.table(told))
