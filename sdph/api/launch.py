"""Checks before a run begins: what cannot be is refused, what may be wrong is warned of. `sdph run` and Python do the
same."""

from __future__ import annotations

from pathlib import Path

from coupling.gas import GasError
from sdph.running import inputs
from sdph.schema import CaseError
from sdph.study import explained


def looked_at(case, template: Path, *, allow_code: bool = False, whole: bool = False) -> list[str]:
    """Warnings of a resolved case; `CaseError` where it cannot run. `whole` makes its particles too, as `explain`
    does. Where OpenFOAM cannot make its mesh there are none before a run: that says why, and keeps the log."""
    try:
        return explained.warned(case, template, allow_code=allow_code, whole=whole)
    except GasError:
        if whole:
            raise
        return []


def refuse_useless(case, name: str, given: dict[str, object]) -> None:
    """CaseError for options (as they are written -> value; None, "" or 0 where not given) of the gas that would do
    nothing."""
    inputs.check(case)  # what follows reads some of them
    embedded = next((value for key, value in given.items() if key.endswith("gas")), None) == "embedded"
    for key, value in given.items():
        if value and "grains" not in case.matters:
            raise CaseError(f"{key} {value}: {name} has no gas and no gas solver; leave it out")
        if value and embedded and not key.endswith("gas"):
            raise CaseError(f"{key} {value}: the embedded gas solver runs in this process; leave it out")
