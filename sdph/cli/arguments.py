"""The options of the command line."""

from __future__ import annotations

import argparse
import contextlib
from pathlib import Path

from sdph.schema import CaseError
from sdph.version import __version__

SET = "override a key of the case; the path of a file is taken from the working directory"


class _Parser(argparse.ArgumentParser):
    """Says what is wrong as any other bad input is told."""

    def error(self, message):
        raise CaseError(f"{message}; see {self.prog} --help")


def parser() -> argparse.ArgumentParser:
    """Parser of the command line; its result has the name of the command as `command`."""
    whole = _Parser(prog="sdph", description="Flows of grains, droplets and liquids: SPH particles and a gas.")
    whole.add_argument("--version", action="version", version=__version__)
    commands = whole.add_subparsers(required=True, dest="command", metavar="COMMAND")
    _command(commands, "list", "the scenes, one line each")
    init = _command(commands, "init", "an editable case folder from a scene, or from an OpenFOAM case")
    init.add_argument("scene", nargs="?")
    init.add_argument(
        "--from-openfoam", type=Path, metavar="CASE", help="take mesh, patches, conditions and properties of this case"
    )
    init.add_argument("folder", type=Path)
    init.add_argument("--slurm", action="store_true", help="a script for SLURM beside the case, to be edited: job.sh")
    _run_options(_command(commands, "run", "run a scene, a case folder or a case file"))
    explain = _command(commands, "explain", "what a case calls for, its limits and its cost, before it runs")
    _case_options(explain)
    _code_option(explain)
    explain.add_argument("--gas", choices=("openfoam", "embedded"), help="gas solver (default: as `run` has it)")
    explain.add_argument("--ranks", type=count, metavar="N", help="how so many processes would share the particles")
    explain.add_argument(
        "--measure",
        action="store_true",
        help="measure what each effect of grains costs on this machine, or a step of a case without a gas; minutes",
    )
    warm = _command(commands, "warm", "compile the kernels of cases now, so that their first run need not")
    warm.add_argument("target", nargs="*", help="scenes, case folders or case files (default: all scenes)")
    warm.add_argument("--gas", choices=("openfoam", "embedded"), help="gas solver (default: openfoam where it is)")
    _workers(warm, "cases")
    bench = _command(commands, "bench", "main ratios of speed on this machine, beside those on ours: a minute or two")
    bench.add_argument("--ranks", type=count, metavar="N", help="those of N processes that share particles instead")
    bench.add_argument("--json", action="store_true", help="print them as JSON")
    _study(commands)
    _sweep(commands)
    _droplet(commands)
    _view(commands)
    _report(commands)
    openfoam = _command(commands, "openfoam", "find or install OpenFOAM and compile the gas solver")
    openfoam.add_argument("action", choices=("setup",))
    openfoam.add_argument("--install", action="store_true", help="install what is missing with apt")
    _command(commands, "doctor", "what is there, what is missing and what mends it")
    completion = _command(commands, "completion", "a script by which your shell completes commands, options, scenes")
    completion.add_argument("shell", choices=("bash", "zsh"))
    return whole


def _study(commands) -> None:
    """Commands that judge: cost, stress, compare, validate."""
    cost = _command(commands, "cost", "what accuracy costs in time: measures a ladder of settings, draws it")
    cost.add_argument("scene")
    cost.add_argument("--out", type=Path, help="folder (default: runs/cost/SCENE); goes on with what is there")
    cost.add_argument(
        "--budget",
        type=seconds,
        default=float("inf"),
        metavar="TIME",
        help="such as 90s or 10min: starts nothing new after that",
    )
    cost.add_argument("--repeats", type=count, default=1, help="runs of each setting; the median counts (default: 1)")
    stress = _command(commands, "stress", "hard cases that must stay stable; exit code 1 if one does not")
    stress.add_argument("case", nargs="*", help="hard cases (default: all under validation/stress)")
    stress.add_argument("--fast", action="store_true", help="only those that CI runs")
    stress.add_argument(
        "--faults",
        type=count,
        nargs="?",
        const=50,
        metavar="N",
        help="kill, starve and stop runs at N random moments (50)",
    )
    stress.add_argument("--json", action="store_true", help="print the checks as JSON")
    _workers(stress, "cases")
    stress.add_argument("--map", action="store_true", help="measure how far beyond its limits each effect stays stable")
    compare = _command(commands, "compare", "a run against a reference; exit code 1 outside tolerance")
    compare.add_argument("run", type=Path)
    compare.add_argument("--against", required=True, choices=("tfm", "dpm", "exact"))
    compare.add_argument("--json", action="store_true", help="print the checks as JSON")
    check = _command(commands, "validate", "run a scene and check it against all its references")
    check.add_argument(
        "scene",
        nargs="?",
        help="or experiments, granular_piles: what others measured, kinetic_theory or spray_plug, or a part of one, "
        "experiments.bed_profiles (default: all these and every scene that has a validation)",
    )
    check.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="override a key of the case")
    check.add_argument("--gas", choices=("openfoam", "embedded"), help="gas solver (default: openfoam where it is)")
    check.add_argument("--out", type=Path, help="keep the runs in this folder")
    check.add_argument(
        "--record",
        type=Path,
        metavar="FOLDER",
        help="keep the checks of each scene with date and commit: SCENE.json; of a part, among those of its study",
    )
    check.add_argument("--json", action="store_true", help="print the checks as JSON")
    _workers(check, "scenes")


def _workers(command, what: str) -> None:
    """Options of commands that do many things of a kind."""
    who = command.add_mutually_exclusive_group()
    alone = "default: one by one"
    who.add_argument("--workers", type=count, metavar="N", help=f"so many {what} at once, by dask ({alone})")
    who.add_argument("--scheduler", metavar="ADDRESS", help=f"address of a dask scheduler whose workers do the {what}")


def _sweep(commands) -> None:
    """Command of many runs."""
    sweep = _command(
        commands, "sweep", "many runs of a case over values of its keys; called again, it does what is left"
    )
    sweep.add_argument("target", help="scene, folder made by `sdph init`, or case.toml")
    sweep.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="KEY=VALUES",
        help="values v1,v2,... or a:b:n, n numbers from a to b; several keys make a grid",
    )
    sweep.add_argument(
        "--table", type=Path, metavar="FILE", help="CSV file: a row for each run, its first line names keys"
    )
    sweep.add_argument("--out", type=Path, help="folder of sweep.csv and runs (default: runs/sweep-TARGET)")
    _workers(sweep, "runs")
    sweep.add_argument("--gas", choices=("openfoam", "embedded"), help="gas solver (default: openfoam where it is)")
    sweep.add_argument("--until", type=float, metavar="T", help="end time [s] of each run")
    sweep.add_argument(
        "--plot", action="append", default=[], metavar="METRIC", help="draw a number of the summaries; may be repeated"
    )
    sweep.add_argument("--over", metavar="KEY", help="over this key (default: the first that takes several numbers)")
    sweep.add_argument("--again", action="store_true", help="also do again what cannot be run or went unstable")
    _code_option(sweep)
    sweep.add_argument("--json", action="store_true", help="print the rows as JSON")


def _droplet(commands) -> None:
    """Command of the reduced model of a gel droplet."""
    droplet = _command(commands, "droplet", "one gel droplet without particles: growth, neck, tear, vent")
    droplet.add_argument("file", nargs="?", type=Path, help="TOML file with its keys (default: the base case)")
    words = "override a key of the file; heating.place is rim or inside"
    droplet.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help=words)
    droplet.add_argument("--out", type=Path, help="folder of table and picture (default: runs/droplet, numbered)")
    droplet.add_argument("--json", action="store_true", help="print the summary as JSON")


def _view(commands) -> None:
    view = _command(commands, "view", "look at a run")
    view.add_argument("run", type=Path)
    view.add_argument("--png", type=Path, help="write a picture, .png, .svg or .pdf, instead of opening a window")
    view.add_argument("--time", type=float, metavar="T", help="time [s] (default: the last)")
    view.add_argument(
        "--field",
        help="what colours particles, cells (default: what the scene is about); A,B in 2-D: B of what has it, else A",
    )
    view.add_argument("--movie", type=Path, help="write all times as a .gif or .mp4 instead of opening a window")
    view.add_argument("--web", action="store_true", help="serve a page with time, fields and a cut on this machine")
    view.add_argument("--theme", choices=("light", "dark"), default="light", help="colours of the paper and the ink")
    view.add_argument("--smooth", action="store_true", help="continuous fields instead of particles and cells, in 2-D")
    view.add_argument("--outline", action="store_true", help="outline bubbles (alpha_p = 0.15) or a liquid")
    view.add_argument("--vectors", action="store_true", help="arrows of velocity")


def _report(commands) -> None:
    report = _command(commands, "report", "one HTML file of one or several runs, side by side; also of failed ones")
    report.add_argument("runs", nargs="+", type=Path, metavar="RUN")
    report.add_argument("--out", type=Path, help="the file (default: report.html in the first run's folder)")


def _command(commands, name: str, summary: str):
    return commands.add_parser(name, help=summary, description=summary)


def _case_options(parser) -> None:
    parser.add_argument("target", help="scene, folder made by `sdph init`, or case.toml")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help=SET)
    parser.add_argument("--json", action="store_true", help="print the result as JSON")


def _code_option(parser) -> None:
    parser.add_argument(
        "--allow-code",
        action="store_true",
        help="let the OpenFOAM files of your case run code (#codeStream and its like)",
    )


def _run_options(parser) -> None:
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("target", nargs="?", help="scene, folder made by `sdph init`, or case.toml")
    what.add_argument("--resume", type=Path, metavar="RUN", help="go on with a run from its last checkpoint")
    parser.add_argument("--out", type=Path, help="run folder (default: runs/SCENE, numbered)")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help=SET)
    parser.add_argument("--gas", choices=("openfoam", "embedded"), help="gas solver (default: openfoam where it is)")
    parser.add_argument("--transport", choices=("socket", "file"), help="how fields travel to OpenFOAM")
    parser.add_argument("--np", type=int, help="MPI ranks of the gas solver")
    parser.add_argument("--ranks", type=count, metavar="N", help="processes that share the particles")
    parser.add_argument("--device", choices=("cpu", "cuda"), help="where loops over particles run (default: cpu)")
    _code_option(parser)
    parser.add_argument(
        "--accuracy",
        type=accuracy,
        metavar="[METRIC=]E",
        help="take the cheapest measured setting that errs by this or less, such as 2%%, in all metrics or in one",
    )
    parser.add_argument("--until", type=float, metavar="T", help="end time [s]")
    parser.add_argument(
        "--watch", action="store_true", help="keep a page of the run as it goes in its folder: watch.html"
    )
    parser.add_argument("--json", action="store_true", help="print the summary as JSON")


def accuracy(text: str) -> tuple[str, float]:
    """2%, or of one metric front_m=2%: (metric or "", share)."""
    metric, _, found = text.rpartition("=")
    return metric.strip(), share(found.strip())


def share(text: str) -> float:
    """2% or 0.02; no more than 1."""
    found = _above_zero(text.removesuffix("%"), "2% or 0.02") / (100.0 if text.endswith("%") else 1.0)
    if found > 1.0:
        raise argparse.ArgumentTypeError(
            f"{text}; it must be at most 1, or 100%: did you mean {text.removesuffix('%')}%?"
        )
    return found


def seconds(text: str) -> float:
    """90, 90s, 10min or 2h."""
    units = {"min": 60.0, "h": 3600.0, "s": 1.0}
    unit = next((name for name in units if text.endswith(name)), "")
    return _above_zero(text.removesuffix(unit), "90s, 10min or 2h") * units.get(unit, 1.0)


def count(text: str) -> int:
    if not text.isdigit() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text}; it must be a whole number, at least 1")
    return int(text)


def _above_zero(text: str, allowed: str) -> float:
    """A finite number above 0; `ArgumentTypeError` says what is allowed."""
    with contextlib.suppress(ValueError):
        if 0.0 < float(text) < float("inf"):
            return float(text)
    raise argparse.ArgumentTypeError(f"{text}; it must be above 0, such as {allowed}")
