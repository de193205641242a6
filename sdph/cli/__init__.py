"""The command line. Modules are imported by the command that needs them, so that `sdph --help` is quick."""

from __future__ import annotations

import contextlib
import errno
import os
import signal
import sys
from pathlib import Path

from sdph.cli import judging, making
from sdph.cli.arguments import parser
from sdph.cli.sweeping import sweep
from sdph.schema import CaseError
from sdph.study.apart import BAD_INPUT, CANNOT_WRITE, CHECK_FAILED, FINE, GAS_FAILED, WENT_UNSTABLE


def main(given: list[str] | None = None) -> int:
    """Entry point; returns the exit code: 0 fine, 1 a check failed, 2 bad input, 3 the gas side failed,
    4 the run folder cannot be written, 5 the run went unstable, 128 + signal when stopped."""
    try:
        options = parser().parse_args(given)
        code = COMMANDS[options.command](options)
        sys.stdout.flush()
        return code
    except CaseError as error:
        return _failed(error, BAD_INPUT)
    except BrokenPipeError:  # whoever read the output has read enough; what is left of it is dropped
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 128 + signal.SIGPIPE
    except OSError as error:
        if error.errno == errno.ENAMETOOLONG:
            return _failed(f"{str(error.filename)[:80]}...: {error.strerror}; give a shorter one", BAD_INPUT)
        return _failed(
            f"{error.filename or 'a file'}: {error.strerror or error}; give a place that is there and can be written",
            CANNOT_WRITE,
        )
    except KeyboardInterrupt as stop:
        return _failed((str(stop) and stop) or "interrupted", 128 + getattr(stop, "number", signal.SIGINT))
    except RuntimeError as error:
        codes = {
            "GasError": GAS_FAILED,
            "CannotWrite": CANNOT_WRITE,
            "Unstable": WENT_UNSTABLE,
            "Stalled": WENT_UNSTABLE,
        }
        code = next((codes[kind.__name__] for kind in type(error).__mro__ if kind.__name__ in codes), None)
        if code is None:
            raise
        return _failed(error, code)


def _failed(message, code: int) -> int:
    """One line, with how to go on where that is known."""
    from sdph.engine import world
    from sdph.engine.reading import one_line

    text = " ".join([str(message), *getattr(message, "__notes__", ())])
    if world.here().number == 1:
        print(f"sdph: {one_line(text)}", file=sys.stderr)
        return code
    from sdph.running import ranks

    ranks.wait_for_the_first()
    print(f"sdph: {one_line(text)}", file=sys.stderr)
    return ranks.end(code)


def list_scenes(options) -> int:
    from sdph import scenes

    for name in scenes.names():
        print(f"{name:20s} {scenes.title(name)}")
    return FINE


def run(options) -> int:
    from sdph import scenes
    from sdph.api import launch
    from sdph.case import fluids
    from sdph.engine import world
    from sdph.running import driver, output, ranks, vessel
    from sdph.running.progress import Reporter
    from sdph.show import watch
    from sdph.study.cost import choice

    overrides, here = tuple(options.set) + _overrides(options), world.here()
    several = options.ranks and options.ranks > 1
    if here.number > 1:
        sys.excepthook = ranks.end_all
        ranks.agree(here)
    if several:
        _refuse(options, ("watch",), "a page is of one process")
    with contextlib.closing(Reporter(quiet=not here.chief, line=not options.json)) as reporter:
        if options.resume:
            folder = options.resume
            _refuse(options, ("out", "accuracy"), "--resume goes on with a run as it was begun")
            if several:
                return ranks.resume(folder, options.ranks, overrides, _handed(options, overrides))
            reporter.page = watch.Page(folder) if options.watch else None
            summary = driver.resume(folder, overrides, reporter, allow_code=options.allow_code)
        else:
            name, file = scenes.find(options.target)
            if options.accuracy:
                overrides = choice.with_settings(options.target, options.accuracy, overrides, reporter.status)
            case = vessel.load(file, overrides)
            launch.refuse_useless(case, name, {f"--{key}": getattr(options, key) for key in ("gas", "transport", "np")})
            template = driver.template_of(case, name, file)
            for warning in launch.looked_at(case, template, allow_code=options.allow_code):
                reporter.status(f"warning: {warning}")
            for line in fluids.told(case):
                reporter.status(line)
            folder = options.out or output.free_name(Path("runs") / name)
            if several:
                own = _handed(options, ())
                return ranks.run(case, folder, options.ranks, template, own, allow_code=options.allow_code)
            reporter.page = watch.Page(folder) if options.watch else None
            summary = driver.run(case, name, folder, template, reporter, allow_code=options.allow_code)
    if here.chief:
        print(output.strict_json(summary) if options.json else f"{_table(summary)}\nrun folder: {folder}")
    return FINE


def _handed(options, overrides: tuple[str, ...]) -> list[str]:
    """Options of the processes that share a run."""
    flags = ["--json"] * options.json + ["--allow-code"] * options.allow_code
    return [part for value in overrides for part in ("--set", value)] + flags


def _refuse(options, names, why: str) -> None:
    """CaseError for options that would do nothing."""
    for name in names:
        if getattr(options, name):
            raise CaseError(f"--{name.replace('_', '-')} {getattr(options, name)}: {why}; leave it out")


def _overrides(options) -> tuple[str, ...]:
    given = {
        "coupling.gas": options.gas,
        "coupling.transport": options.transport,
        "coupling.gas_ranks": options.np,
        "run.end_time_s": options.until,
        "run.device": options.device,
    }
    return tuple(f"{key}={value!r}" for key, value in given.items() if value is not None)  # as TOML has them, nan too


def _table(summary: dict) -> str:
    return "\n".join(
        f"{key:40s} {value:.9g}" if isinstance(value, float) else f"{key:40s} {value}" for key, value in summary.items()
    )


def explain_case(options) -> int:
    from sdph import scenes
    from sdph.running import compiling, driver, output, vessel
    from sdph.study import explained
    from sdph.study.explain import tables

    name, file = scenes.find(options.target)
    gas = (f'coupling.gas="{options.gas}"',) if options.gas else ()
    case = vessel.load(file, (*options.set, *gas))
    template = driver.template_of(case, name, file)
    parts = {}
    with compiling.told(_say):
        if options.measure:
            from sdph.study.explain import effect_costs

            parts["measured on this machine"] = effect_costs.measured(case, _say)
        parts |= explained.explained(case, template, allow_code=options.allow_code)
        if options.ranks:
            from sdph.study import sharing

            parts["ranks"] = sharing.rows(case, options.ranks)
    print(output.strict_json(parts) if options.json else f"{case.title}\n\n{tables.text(parts)}")
    return FINE


def _say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def cost_of_accuracy(options) -> int:
    from sdph import scenes
    from sdph.study.cost import climb, errors, ladder, report

    folder = options.out or Path("runs/cost") / scenes.find(options.scene)[0]
    found = errors.judged(
        ladder.declared(options.scene),
        climb.climb(
            options.scene, folder / "cost.csv", options.budget, options.repeats, lambda text: print(text, flush=True)
        ),
    )
    print(f"\n{report.text(options.scene, found)}")
    report.draw(options.scene, found, folder / "cost.png")
    print(f"{folder}/cost.csv and cost.png")
    return FINE


def compare_run(options) -> int:
    from coupling.openfoam.programs import run as programs
    from sdph.running import output
    from sdph.running.interruption import listening
    from sdph.study import against, compare

    with listening(), programs.told(_say):  # a signal ends OpenFOAM's programs too
        checks = against.compare(options.run, options.against, _say)
    unlike = against.unlike(options.run, options.against)
    if options.json:
        print(output.strict_json({"checks": checks, "unlike": unlike}))
    else:
        print("\n".join([compare.table(checks), *(["", "not alike:", *unlike] if unlike else [])]))
    return FINE if all(check["ok"] for check in checks) else CHECK_FAILED


def gel_droplet(options) -> int:
    from sdph.running import output
    from sdph.study.gel_droplet import course, sections

    found = course.Course(sections.judged(sections.load(options.file, tuple(options.set)), _say))
    folder = options.out or output.free_name(Path("runs") / "droplet")
    course.write(found, folder)
    text = f"{_table(found.summary)}\n{course.told_of_pressures(found)}\nfolder: {folder}"
    print(output.strict_json(found.summary) if options.json else text)
    return FINE


def view_run(options) -> int:
    from sdph.show import view
    from sdph.show.look import Look

    look = Look(options.field, options.theme, options.smooth, options.outline, options.vectors)
    if options.web:
        from sdph.show import web

        _refuse(options, ("png", "movie"), "--web serves a page and writes no file")
        web.serve(options.run, options.time, look)
    elif options.movie:
        _refuse(options, ("png", "time"), "--movie is of all instants, and writes no picture")
        view.movie(options.run, options.movie, look=look, tell=_say)
    else:
        view.show(options.run, options.png, options.time, look=look)
    return FINE


def report_runs(options) -> int:
    from sdph.study import report

    print(report.write(options.runs, options.out or options.runs[0] / "report.html"))
    return FINE


def openfoam_setup(options) -> int:
    from coupling.openfoam.programs import install

    install.setup(install=options.install)
    return FINE


def complete(options) -> int:
    from sdph.cli import completion

    print(completion.script(parser(), options.shell))
    return FINE


def doctor(options) -> int:
    from coupling.openfoam.programs import install
    from sdph.engine.gpu import found

    rows = install.doctor()
    for row in rows:
        print(row)
    print(f"{'CUDA device':24}{found.described()}")
    return FINE if all(row.found for row in rows) else CHECK_FAILED


COMMANDS = {
    "list": list_scenes,
    "init": making.init_case,
    "run": run,
    "explain": explain_case,
    "warm": judging.warm_cases,
    "bench": judging.bench,
    "cost": cost_of_accuracy,
    "stress": judging.stress_cases,
    "compare": compare_run,
    "validate": judging.validate_scene,
    "sweep": sweep,
    "droplet": gel_droplet,
    "view": view_run,
    "report": report_runs,
    "openfoam": openfoam_setup,
    "doctor": doctor,
    "completion": complete,
}
