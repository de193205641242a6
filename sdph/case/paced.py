"""Factors on windows and steps that are beyond what is usual."""

from __future__ import annotations

STABLE = 1.0  # of the sub-steps' limits, which hold explicit steps stable
WIDE = 20.0  # cells that gas crosses in a window: twice as many as in any scene, and these are steady; our choice


def warnings(case) -> list[str]:
    """A line for each of `run.step_factor` and `coupling.courant` that is larger than usual, with the reason."""
    factor, courant = case.run.step_factor, case.coupling.courant
    told = []
    if factor > STABLE:
        told.append(
            f"run.step_factor = {factor:g}: steps are {factor:g} times as long as the limits of the effects, most of "
            "which are bounds of stability: beyond 1 a run may go unstable, or look right and be wrong; give at most 1"
        )
    if "grains" in case.matters and courant > WIDE:
        told.append(
            f"coupling.courant = {courant:g}: gas may cross {courant:g} cells in a window, and what it does to grains "
            f"is held for so long (first order in the window): usual is about 1, and up to {WIDE:g} (our choice) where "
            "the flow is steady; lower it, unless that is meant"
        )
    return told
