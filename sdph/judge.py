"""Which effects a case calls for: every effect judges itself from the scales of the case."""

from __future__ import annotations

import dataclasses

from sdph import effects
from sdph.effects.effect import Judgement
from sdph.scales import Scales


def scales_of(case) -> Scales:
    """Scales of a case as if every effect that can judge itself had its section."""
    defaults = {name: row.parameters() for name, row in effects.REGISTRY.items() if row.call}
    return Scales(dataclasses.replace(case, parameters=defaults | case.parameters))


def judgements(case) -> dict[str, Judgement]:
    """Name of the effect -> its judgement, for all that can judge themselves."""
    scales = scales_of(case)
    return {name: row.call(scales) for name, row in effects.REGISTRY.items() if row.call}


def called_for(case) -> dict[str, Judgement]:
    """Those without which the case errs by more than `run.accuracy`."""
    return {name: own for name, own in judgements(case).items() if own.error_if_off > case.run.accuracy}


def missing(case) -> list[str]:
    """One warning for each effect that is called for and off."""
    text = "effect {} is off, but called for ({} = {:.3g}, matters from {:.3g}): expect an error of about {:.1g} of the answer"
    off = {name: own for name, own in called_for(case).items() if name not in case.effects}
    return [text.format(name, own.name, own.number, own.threshold, own.error_if_off) for name, own in off.items()]
