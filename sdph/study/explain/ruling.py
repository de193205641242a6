"""Effects that make the step of a liquid much shorter than all else does: a unit of theirs may have slipped."""

from __future__ import annotations

from sdph import effects
from sdph.study.explain import estimate

TIMES = 10.0  # times shorter than all other limits: an effect that takes nine tenths of a run's time; our choice


def warnings(case, end: float, rows: list[dict]) -> list[str]:
    """A line where an effect rules the steps of a case to its `end` [s] alone; `rows` are limits of the step [s] by
    cause, as `explain` shows them."""
    limits = sorted((row["largest [s]"], row["cause"]) for row in rows)
    if len(limits) < 2 or limits[1][0] < TIMES * limits[0][0] or limits[0][1] not in effects.REGISTRY:
        return []
    (least, cause), (other, next_one) = limits[:2]
    number, few = (estimate.steps(case, end, longest) for longest in (least, other))
    return [
        f"{cause} lets a step be {least:.3g} s long at most, {other / least:.3g} times shorter than {next_one} and all "
        f"else: {number} steps in place of {few}; {_given(case, cause)}"
    ]


def _given(case, cause: str) -> str:
    """Words on what to look at: of viscosity the key of the phase that rules, and what was likely meant."""
    if cause != "laminar_viscosity":
        return f"look at the units of [{cause}]"
    phases = [name for name in ("liquid", "gas_phase") if getattr(case, name)]
    ruling = max(phases, key=lambda name: getattr(case, name).viscosity / getattr(case, name).density)
    value = getattr(case, ruling).viscosity
    return f"look at {ruling}.viscosity_Pa_s = {value:g}; if mPa s was meant, give {1e-3 * value:g}"
