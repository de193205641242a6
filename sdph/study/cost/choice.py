"""`sdph run SCENE --accuracy [METRIC=]E`: the cheapest measured settings that hold E, in all metrics or in one."""

from __future__ import annotations

from pathlib import Path

from sdph import scenes
from sdph.scenes import paths
from sdph.schema import CaseError
from sdph.study.cost import errors, measured_case
from sdph.study.cost import rows as measured_rows
from sdph.study.cost.ladder import Ladder, declared, overrides


def measured(scene: str) -> tuple[Path, list[dict]]:
    """The rows for a scene, the user's own, else those that come with sdph; for a case of one's own those that were
    measured of that very case, but for the keys of its ladder."""
    own, mine = declared(scene), measured_case.of_ones_own(scene)
    name = scenes.find(scene)[0] if Path(scene).exists() else scene
    file = Path("runs/cost") / name / "cost.csv"
    if mine and file.is_file():
        measured_case.refuse_other(mine, own, file)
    elif not mine and (measured_case.is_own(file) or not file.is_file()):
        file = paths.data("validation") / name / "cost.csv"
    if file.is_file():
        return file, errors.judged(own, measured_rows.read(file))
    raise CaseError(
        f"nothing is measured for {scene}, so no accuracy can be promised; measure it with: sdph cost {scene}"
    )


def settings_for(scene: str, wanted: tuple[str, float], report) -> tuple[str, ...]:
    """Overrides of the cheapest measured settings that hold `wanted`, (metric or "" for all, error), as do all finer
    ones; says which, and on what evidence. What is simulated, and until when, stays as the case has it."""
    file, rows = measured(scene)
    own, (metric, accuracy) = declared(scene), wanted
    known = list(errors.converged(own, rows))
    if metric and metric not in known:
        raise CaseError(f"--accuracy {metric}=...: {scene} has no such metric; it has: {', '.join(known)}")
    if metric:
        rows = errors.judged(own, measured_rows.of_metric(rows, metric))
    best = measured_rows.cheapest(rows, accuracy)
    if best is None:
        others = "" if metric else priced(own, rows, accuracy)
        raise CaseError(
            f"{scene} is {errors.refusal(own, rows, accuracy)} ({file}); allow a larger error, or refine its ladder"
            f"{others}"
        )
    chosen = (*own.settings, *overrides({key: best[key] for key in own.keys}))
    over = f", measured with {' '.join(own.excerpt)}" if own.excerpt else ""
    report(
        f"{named(wanted)}: {' '.join(chosen)}; within {errors.percent(best['bound'])} of its limit{over}, "
        f"{best['wall_s']:.3g} s ({file})"
    )
    if different := errors.model_difference(own, rows):
        report(f"{named(wanted)} is of the numerics alone: {different} ({own.reference})")
    return chosen


def priced(own: Ladder, rows: list[dict], accuracy: float) -> str:
    """Advice to ask for a metric that is held, if there is one."""
    for name in errors.converged(own, rows):
        if measured_rows.cheapest(errors.judged(own, measured_rows.of_metric(rows, name)), accuracy):
            return f"; or ask for one metric alone: --accuracy '{name}={accuracy:g}'"
    return ""


def named(wanted: tuple[str, float]) -> str:
    """The option as it was given."""
    metric, accuracy = wanted
    return f"--accuracy {metric}={accuracy:g}" if metric else f"--accuracy {accuracy:g}"


def with_settings(scene: str, wanted: tuple[str, float], given: tuple[str, ...], report) -> tuple[str, ...]:
    """`given` overrides after those of `settings_for`, which may not be among them: the promise would not hold."""
    for text in given:
        if text.split("=")[0].strip() in declared(scene).keys:
            raise CaseError(f"--set {text}: {named(wanted)} chooses that key itself; leave one of them out")
    return (*settings_for(scene, wanted, report), *given)
