"""Which effects a case calls for: every effect judges itself from the scales of the case."""

from __future__ import annotations

import dataclasses

from sdph import effects
from sdph.effects.effect import Judgement
from sdph.methods.grains.scales import Scales


def scales_of(case) -> Scales:
    """Scales of a case as if every effect that can judge itself and needs no input had its section."""
    parameters = _defaults(_matter(case)) | case.parameters
    if case.liquid:
        from sdph.methods.liquids.scales import LiquidScales

        return LiquidScales(dataclasses.replace(case, parameters=parameters))
    return Scales(dataclasses.replace(case, effects=tuple(parameters), parameters=parameters))


def _matter(case) -> str:
    return "liquid" if case.liquid else "grains"


def _defaults(matter: str) -> dict:
    """Parameters of the effects that need no input."""
    rows = [row for row in effects.REGISTRY.values() if row.call and matter in row.matter]
    return {row.name: row.parameters() for row in rows if all(f.default is not dataclasses.MISSING for f in dataclasses.fields(row.parameters))}


def judgements(case, scales=None) -> dict[str, Judgement]:
    """Name of the effect -> its judgement, for all that act on what the case is of and can judge themselves.

    `scales` are those of the case, where they are known.
    """
    scales = scales or scales_of(case)
    own = {name: row for name, row in effects.REGISTRY.items() if row.call and _matter(case) in row.matter}
    return {name: row.call(scales) for name, row in own.items() if name in scales.case.parameters}


def called_for(case, scales=None) -> dict[str, Judgement]:
    """Those without which the case errs by more than `run.accuracy`."""
    return {name: own for name, own in judgements(case, scales).items() if own.error_if_off > case.run.accuracy}


def missing(case, scales=None) -> list[str]:
    """One warning for each effect that is called for and off; where nothing moves, grains are held by intent."""
    text = "effect {} is off, but called for ({} = {:.3g}, matters from {:.3g}): expect an error of about {:.1g} of the answer"
    held = not effects.moving(case)
    off = {n: own for n, own in called_for(case, scales).items() if n not in case.effects and not (held and effects.REGISTRY[n].moves)}
    return [text.format(name, own.name, own.number, own.threshold, own.error_if_off) for name, own in off.items()]
