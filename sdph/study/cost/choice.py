"""`sdph run SCENE --accuracy E`: the cheapest measured settings that hold E."""

from __future__ import annotations

from pathlib import Path

from sdph.scenes import paths
from sdph.schema import CaseError
from sdph.study.cost import errors
from sdph.study.cost import rows as measured_rows
from sdph.study.cost.ladder import declared, overrides


def measured(scene: str) -> tuple[Path, list[dict]]:
    """The rows for a scene: the user's own, else those that come with sdph."""
    for file in (Path("runs/cost") / scene / "cost.csv", paths.data("validation") / scene / "cost.csv"):
        if file.is_file():
            return file, errors.judged(declared(scene), measured_rows.read(file))
    raise CaseError(
        f"nothing is measured for {scene}, so no accuracy can be promised; measure it with: sdph cost {scene}"
    )


def settings_for(scene: str, accuracy: float, report) -> tuple[str, ...]:
    """Overrides of the cheapest measured settings that hold `accuracy`, as do all finer ones; says which, and on what
    evidence. What is simulated, and until when, stays as the case has it."""
    file, rows = measured(scene)
    own, best = declared(scene), measured_rows.cheapest(rows, accuracy)
    if best is None:
        raise CaseError(
            f"{scene} is {errors.refusal(own, rows, accuracy)} ({file}); allow a larger error, or refine its ladder"
        )
    chosen = (*own.settings, *overrides({key: best[key] for key in own.keys}))
    over = f", measured with {' '.join(own.excerpt)}" if own.excerpt else ""
    report(
        f"--accuracy {accuracy:g}: {' '.join(chosen)}; within {best['bound']:.2g} of its limit{over}, "
        f"{best['wall_s']:.3g} s ({file})"
    )
    if different := errors.model_difference(own, rows):
        report(f"--accuracy {accuracy:g} is of the numerics alone: {different} ({own.reference})")
    return chosen


def with_settings(scene: str, accuracy: float, given: tuple[str, ...], report) -> tuple[str, ...]:
    """`given` overrides after those of `settings_for`, which may not be among them: the promise would not hold."""
    for text in given:
        if text.split("=")[0].strip() in declared(scene).keys:
            raise CaseError(f"--set {text}: --accuracy {accuracy:g} chooses that key itself; leave one of them out")
    return (*settings_for(scene, accuracy, report), *given)
