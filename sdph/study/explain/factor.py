"""Limits of steps as a run takes them: times `run.step_factor`."""

from __future__ import annotations

LONGEST = "largest [s]"


def applied(case, rows: list[dict]) -> list[dict]:
    """Rows of limits with those of steps and sub-steps times the factor of the case."""
    factor = case.run.step_factor
    return [_times(factor, row) if factor != 1.0 and _of_steps(row) else row for row in rows]


def _of_steps(row: dict) -> bool:
    return row.get("of", "sub-step") == "sub-step" and row["cause"] != "window"


def _times(factor: float, row: dict) -> dict:
    told = {"how": f"{row['how']}; times run.step_factor"} if "how" in row else {}
    return row | {LONGEST: factor * row[LONGEST]} | told
