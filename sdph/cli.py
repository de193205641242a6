"""The command line. Modules are imported by the command that needs them, so that `sdph --help` is quick."""

from __future__ import annotations

import argparse
import contextlib
import json
import signal
import sys
from pathlib import Path

from sdph import __version__
from sdph.schema import CaseError

FINE, CHECK_FAILED, BAD_INPUT, GAS_FAILED, CANNOT_WRITE, WENT_UNSTABLE = 0, 1, 2, 3, 4, 5


def main(arguments: list[str] | None = None) -> int:
    """Entry point; returns the exit code: 0 fine, 1 a check failed, 2 bad input, 3 the gas side failed,
    4 the run folder cannot be written, 5 the run went unstable, 128 + signal when stopped."""
    options = _parser().parse_args(arguments)
    try:
        return options.command(options)
    except CaseError as error:
        return _failed(error, BAD_INPUT)
    except json.JSONDecodeError as error:
        return _failed(f"a file of the run is damaged (no JSON: {error}); run it again", BAD_INPUT)
    except OSError as error:
        return _failed(f"{error.filename or 'a file'}: {error.strerror or error}; give a place that is there and can be written", CANNOT_WRITE)
    except KeyboardInterrupt as stop:
        return _failed(str(stop) and stop or "interrupted", 128 + getattr(stop, "number", signal.SIGINT))
    except RuntimeError as error:
        code = {"GasError": GAS_FAILED, "CannotWrite": CANNOT_WRITE, "Unstable": WENT_UNSTABLE}.get(type(error).__name__)
        if code is None:
            raise
        return _failed(error, code)


def _failed(message, code: int) -> int:
    """One line, with how to go on where that is known."""
    text = " ".join([str(message), *getattr(message, "__notes__", ())])
    print(f"sdph: {' '.join(text.split())}", file=sys.stderr)
    return code


class _Parser(argparse.ArgumentParser):
    """Says what is wrong in one line."""

    def error(self, message):
        sys.exit(_failed(f"{message}; see {self.prog} --help", BAD_INPUT))


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(prog="sdph", description="Flows of grains, droplets and liquids: SPH particles and a gas.")
    parser.add_argument("--version", action="version", version=__version__)
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    _command(commands, "list", list_scenes, "the scenes, one line each")
    init = _command(commands, "init", init_case, "an editable case folder from a scene")
    init.add_argument("scene")
    init.add_argument("folder", type=Path)
    _run_options(_command(commands, "run", run, "run a scene, a case folder or a case file"))
    explain = _command(commands, "explain", explain_case, "what a case calls for, its limits and its cost, before it runs")
    _case_options(explain)
    explain.add_argument("--measure", action="store_true", help="measure what each effect costs on this machine; minutes the first time")
    cost = _command(commands, "cost", cost_of_accuracy, "what accuracy costs in time: measures a ladder of settings, draws it")
    cost.add_argument("scene")
    cost.add_argument("--out", type=Path, help="folder (default: runs/cost/SCENE); goes on with what is there")
    cost.add_argument("--budget", type=_seconds, default=float("inf"), metavar="TIME", help="such as 90s or 10min: starts nothing new after that")
    cost.add_argument("--repeats", type=_count, default=1, help="runs of each setting; the median counts (default: 1)")
    stress = _command(commands, "stress", stress_cases, "hard cases that must stay stable; exit code 1 if one does not")
    stress.add_argument("case", nargs="*", help="hard cases (default: all under validation/stress)")
    stress.add_argument("--fast", action="store_true", help="only those that CI runs")
    stress.add_argument("--faults", type=_count, nargs="?", const=50, metavar="N", help="kill, starve and stop runs at N random moments (50)")
    stress.add_argument("--json", action="store_true", help="print the checks as JSON")
    stress.add_argument("--map", action="store_true", help="measure how far beyond its limits each effect stays stable")
    compare = _command(commands, "compare", compare_run, "a run against a reference; exit code 1 outside tolerance")
    compare.add_argument("run", type=Path)
    compare.add_argument("--against", required=True, choices=("tfm", "dpm", "exact"))
    compare.add_argument("--json", action="store_true", help="print the checks as JSON")
    check = _command(commands, "validate", validate_scene, "run a scene and check it against all its references")
    check.add_argument("scene", nargs="?", help="default: every scene that has a validation")
    check.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="override a key of the case")
    check.add_argument("--gas", choices=("openfoam", "embedded"), help="gas solver (default: openfoam where it is)")
    check.add_argument("--out", type=Path, help="keep the runs in this folder")
    check.add_argument("--json", action="store_true", help="print the checks as JSON")
    view = _command(commands, "view", view_run, "look at a run")
    view.add_argument("run", type=Path)
    view.add_argument("--png", type=Path, help="write a picture instead of opening a window")
    view.add_argument("--time", type=float, metavar="T", help="time [s] (default: the last)")
    view.add_argument("--field", help="what colours the particles and cells (default: temperature, of a liquid velocity)")
    view.add_argument("--movie", type=Path, help="write all times as a .gif or .mp4 instead of opening a window")
    report = _command(commands, "report", report_runs, "one HTML file of one or several runs, side by side; also of failed ones")
    report.add_argument("runs", nargs="+", type=Path, metavar="RUN")
    report.add_argument("--out", type=Path, help="the file (default: report.html in the first run's folder)")
    openfoam = _command(commands, "openfoam", openfoam_setup, "find or install OpenFOAM and compile the gas solver")
    openfoam.add_argument("action", choices=("setup",))
    openfoam.add_argument("--install", action="store_true", help="install what is missing with apt")
    _command(commands, "doctor", doctor, "what is there, what is missing and what mends it")
    return parser


def _command(commands, name: str, function, summary: str):
    parser = commands.add_parser(name, help=summary, description=summary)
    parser.set_defaults(command=function)
    return parser


def _case_options(parser) -> None:
    parser.add_argument("target", help="scene, folder made by `sdph init`, or case.toml")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="override a key of the case")
    parser.add_argument("--json", action="store_true", help="print the result as JSON")


def _run_options(parser) -> None:
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("target", nargs="?", help="scene, folder made by `sdph init`, or case.toml")
    what.add_argument("--resume", type=Path, metavar="RUN", help="go on with a run from its last checkpoint")
    parser.add_argument("--out", type=Path, help="run folder (default: runs/SCENE, numbered)")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="override a key of the case")
    parser.add_argument("--gas", choices=("openfoam", "embedded"), help="gas solver (default: openfoam where it is)")
    parser.add_argument("--transport", choices=("socket", "file"), help="how fields travel to OpenFOAM")
    parser.add_argument("--np", type=int, help="MPI ranks of the gas solver")
    parser.add_argument("--allow-code", action="store_true", help="let the OpenFOAM files of your case run code (#codeStream and its like)")
    parser.add_argument("--accuracy", type=_share, metavar="E", help="take the cheapest measured setting that errs by this or less, such as 2%%")
    parser.add_argument("--until", type=float, metavar="T", help="end time [s]")
    parser.add_argument("--watch", action="store_true", help="keep a page of the run as it goes in its folder: watch.html")
    parser.add_argument("--json", action="store_true", help="print the summary as JSON")


def _share(text: str) -> float:
    """2% or 0.02."""
    return _above_zero(text.removesuffix("%"), "2% or 0.02") / (100.0 if text.endswith("%") else 1.0)


def _seconds(text: str) -> float:
    """90, 90s, 10min or 2h."""
    units = {"min": 60.0, "h": 3600.0, "s": 1.0}
    unit = next((name for name in units if text.endswith(name)), "")
    return _above_zero(text.removesuffix(unit), "90s, 10min or 2h") * units.get(unit, 1.0)


def _count(text: str) -> int:
    if not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text}; it must be a whole number, at least 1")
    return int(text)


def _above_zero(text: str, allowed: str) -> float:
    """A finite number above 0; `ArgumentTypeError` says what is allowed."""
    with contextlib.suppress(ValueError):
        if 0.0 < float(text) < float("inf"):
            return float(text)
    raise argparse.ArgumentTypeError(f"{text}; it must be above 0, such as {allowed}")


def list_scenes(options) -> int:
    from sdph import scenes

    for name in scenes.names():
        print(f"{name:20s} {scenes.title(name)}")
    return FINE


def init_case(options) -> int:
    from sdph import output, paths, scenes

    name, file = scenes.find(options.scene)
    folder = output.create(options.folder, ())
    output.write_text(folder / output.MARK, file.read_text(encoding="utf-8"))
    output.copy_template(paths.gas_template(name), folder / "gas")
    print(f"{folder}/case.toml and {folder}/gas are yours to edit; run them with: sdph run {folder}")
    return FINE


def run(options) -> int:
    from sdph import case as cases
    from sdph import driver, output, room, scenes, watch
    from sdph.cost import choice
    from sdph.explain import tables
    from sdph.progress import Reporter

    overrides = tuple(options.set) + _overrides(options)
    with contextlib.closing(Reporter(quiet=options.json)) as reporter:
        if options.resume:
            folder = options.resume
            _refuse(options, ("out", "accuracy", "allow_code"), "--resume goes on with a run as it was begun")
            reporter.page = watch.Page(folder) if options.watch else None
            summary = driver.resume(folder, overrides, reporter)
        else:
            name, file = scenes.find(options.target)
            if options.accuracy:
                overrides = choice.with_settings(name, options.accuracy, overrides, reporter.status)
            case = cases.load(file, overrides)
            if case.liquid:
                _refuse(options, ("gas", "transport", "np"), f"{name} is a liquid and has no gas solver")
            elif options.gas == "embedded":
                _refuse(options, ("transport", "np"), "the embedded gas solver runs in this process")
            room.refuse_too_large(case)
            for warning in tables.warnings(case):
                reporter.status(f"warning: {warning}")
            folder, own = options.out or output.free_name(Path("runs") / name), file.parent / "gas"
            reporter.page = watch.Page(folder) if options.watch else None
            summary = driver.run(case, name, folder, own if own.is_dir() else None, reporter, allow_code=options.allow_code)
    print(output.strict_json(summary) if options.json else f"{_table(summary)}\nrun folder: {folder}")
    return FINE


def _refuse(options, names, why: str) -> None:
    """Options that would do nothing are not taken in silence."""
    for name in names:
        if getattr(options, name):
            raise CaseError(f"--{name.replace('_', '-')} {getattr(options, name)}: {why}; leave it out")


def _overrides(options) -> tuple[str, ...]:
    given = {
        "coupling.gas": options.gas,
        "coupling.transport": options.transport,
        "coupling.ranks": options.np,
        "run.end_time_s": options.until,
    }
    return tuple(f"{key}={json.dumps(value)}" for key, value in given.items() if value is not None)


def _table(summary: dict) -> str:
    return "\n".join(f"{key:40s} {value:.9g}" if isinstance(value, float) else f"{key:40s} {value}" for key, value in summary.items())


def explain_case(options) -> int:
    from sdph import case as cases
    from sdph import output, scenes
    from sdph.explain import tables

    case = cases.load(scenes.find(options.target)[1], tuple(options.set))
    parts = {}
    if options.measure:
        from sdph.explain import effect_costs

        parts["cost of effects, bubbling bed"] = effect_costs.table(lambda text: print(text, file=sys.stderr, flush=True))
    parts |= tables.explain(case)
    print(output.strict_json(parts) if options.json else f"{case.title}\n\n{tables.text(parts)}")
    return FINE


def cost_of_accuracy(options) -> int:
    from sdph.cost import climb, report, rows

    folder = options.out or Path("runs/cost") / options.scene
    found = rows.errors(climb.climb(options.scene, folder / "cost.csv", options.budget, options.repeats, lambda text: print(text, flush=True)))
    print(f"\n{report.text(options.scene, found)}")
    report.draw(options.scene, found, folder / "cost.png")
    print(f"{folder}/cost.csv and cost.png")
    return FINE


def stress_cases(options) -> int:
    if options.json and (options.map or options.faults is not None):
        raise CaseError("--json is of the hard cases; --map and --faults print their own tables: leave it out")
    if options.faults is not None:
        from sdph.stress import faults

        return FINE if all(check["ok"] for check in faults.run(options.faults)) else CHECK_FAILED
    from sdph import output
    from sdph.stress import boundaries, suite

    if options.map:
        print(boundaries.table(Path("stress_map.png")))
        return FINE
    verdicts = []
    for hard in suite.chosen(options.case, options.fast):
        verdicts.append(suite.run(hard))
        if not options.json:
            suite.show(verdicts[-1])
    fine = [verdict.ok for verdict in verdicts]
    print(output.strict_json({"checks": [check for verdict in verdicts for check in verdict.checks]}) if options.json else f"{sum(fine)} of {len(fine)} pass")
    return FINE if all(fine) else CHECK_FAILED


def compare_run(options) -> int:
    from sdph import compare, output

    checks = compare.compare(options.run, options.against)
    print(output.strict_json({"checks": checks}) if options.json else compare.table(checks))
    return FINE if all(check["ok"] for check in checks) else CHECK_FAILED


def validate_scene(options) -> int:
    from sdph import compare, output, validate
    from sdph.progress import Reporter

    overrides = tuple(options.set) + ((f'coupling.gas="{options.gas}"',) if options.gas else ())
    checks = []
    with contextlib.closing(Reporter(quiet=options.json)) as reporter:
        for scene in [options.scene] if options.scene else validate.validated():
            checks += validate.validate(scene, overrides, reporter, options.out and options.out / scene)
    print(output.strict_json({"checks": checks}) if options.json else compare.table(checks))
    return FINE if all(check["ok"] for check in checks) else CHECK_FAILED


def view_run(options) -> int:
    from sdph import view

    if options.movie:
        view.movie(options.run, options.movie, options.field)
    else:
        view.show(options.run, options.png, options.time, options.field)
    return FINE


def report_runs(options) -> int:
    from sdph import report

    print(report.write(options.runs, options.out or options.runs[0] / "report.html"))
    return FINE


def openfoam_setup(options) -> int:
    from coupling.openfoam import install

    install.setup(install=options.install)
    return FINE


def doctor(options) -> int:
    from coupling.openfoam import install

    rows = install.doctor()
    for row in rows:
        print(row)
    return FINE if all(row.found for row in rows) else CHECK_FAILED


if __name__ == "__main__":
    sys.exit(main())
