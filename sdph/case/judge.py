"""Effects that a case calls for: every effect judges itself from the scales of the case."""

from __future__ import annotations

from sdph import effects
from sdph.effects.effect import Judgement
from sdph.methods.grains import scales as grains
from sdph.methods.liquids import scales as liquids
from sdph.methods.mps import scales as mps
from sdph.methods.solids import scales as solids

OF = {"grains": grains, "liquid": liquids, "mps": mps, "solid": solids}


def scales_of(case):
    """Scales of a case as if every effect that can judge itself and needs no input had its section."""
    return OF[case.moved_by(matter(case))].scales_of(case)


def matter(case) -> str:
    """Matter that a case is judged by: a liquid rather than grains or bodies beside it."""
    return "liquid" if "liquid" in case.matters else case.matters[-1]


def judgements(case, scales=None) -> dict[str, Judgement]:
    """Name of the effect -> its judgement, for all that act on what the case is of and can judge themselves.

    `scales` are those of the case, where they are known.
    """
    scales = scales or scales_of(case)
    own = {name: row for name, row in effects.REGISTRY.items() if row.call and matter(case) in row.matter}
    return {name: row.call(scales) for name, row in own.items() if name in scales.case.parameters}


def called_for(case, scales=None) -> dict[str, Judgement]:
    """Judgements of the effects without which the case errs by more than `run.accuracy`."""
    return {name: own for name, own in judgements(case, scales).items() if own.error_if_off > case.run.accuracy}


def missing(case, scales=None) -> list[str]:
    """One warning for each effect that is called for and off; where nothing moves, grains are held by intent."""
    text = (
        "effect {} is off, but called for ({} = {:.3g}, matters from {:.3g}): expect an error of about {:.1g} of "
        "the answer"
    )
    held = not effects.moving(case)
    off = {
        n: own
        for n, own in called_for(case, scales).items()
        if n not in case.effects and not (held and effects.REGISTRY[n].moves)
    }
    return [text.format(name, own.name, own.number, own.threshold, own.error_if_off) for name, own in off.items()]
