"""Effects and keys of a case that a reference of OpenFOAM knows. The rest is refused by name, and so is an effect that
nobody looked at yet."""

from __future__ import annotations

from sdph.case.sections import Case
from sdph.laws.constants import ROUND_OFF
from sdph.schema import CaseError


def refuse_no_output(case: Case) -> None:
    """CaseError where a case ends before its first output: OpenFOAM would write nothing."""
    end, interval = case.run.end_time, case.run.output_interval
    if end < interval * (1.0 - ROUND_OFF):
        raise CaseError(
            f"run.end_time_s = {end:g} lies before the first output (run.output_interval_s = {interval:g}), and a "
            "reference of OpenFOAM writes none at its end: give a shorter interval to compare"
        )


def lacks(case: Case, effects: frozenset[str], reference: str) -> list[str]:
    """Lines on what a case has that is known to no reference, and on effects that are not among `effects`, which
    `reference` knows."""
    found = []
    if case.mixed:
        several = ", ".join(case.materials)
        found.append(f"grains are of several materials ({several}); {reference} has grains of one material")
    if alien := sorted(set(case.effects) - effects):
        found.append(f"effects holds {', '.join(alien)}; {reference} has none: leave it out to compare")
    if "drag" in case.effects and case.parameters["drag"].filter != "none":
        found.append(f'drag.filter = "igci"; {reference} has none: leave it out to compare')
    own = case.parameters["walls"] if "walls" in case.effects else None
    if own and own.mesh and own.source != "gas":  # else it is made of the patches of the gas
        found.append(f"walls.mesh holds grains where the gas has no patch, and {reference} knows patches")
    return found


def refuse(lacking: list[str]) -> None:
    """CaseError, of one line, where a reference is lacking anything."""
    if lacking:
        raise CaseError(";  ".join(lacking))
