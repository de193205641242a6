"""The spray of a swirling sheet: what is handed over, what came in, and what lone drops of the table would give off."""

from __future__ import annotations

import csv
import math

from sdph.running.chain import DIAMETERS, HANDOVER
from sdph.study.compare import check

CLOSED = 1e-12  # of what the drops have: swirl-sheet.md, section 9


def exact(run) -> list[dict]:
    """Checks of what was handed over, as the run reckoned it (`sdph.running.chain`), of mass and evaporation."""
    own, name = run.summary, next(iter(run.case.nozzles))
    with open(run.folder / HANDOVER, newline="", encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["quantity"] != DIAMETERS]  # not kept, and told
    checks = [check(f"handed over: {row['quantity']}", float(row["difference_rel"]), 0.0, CLOSED) for row in rows]
    nozzle = run.case.nozzles[name]
    largest = nozzle.rate * run.case.resolution.spacing / nozzle.speed  # of an interval that becomes particles
    checks.append(check("mass that came in [kg]", own["injected_kg"], nozzle.rate * own["time_s"], largest))
    share = own["evaporated_kg"] / own["injected_kg"]
    checks.append(check("evaporated share, reported beside all of it", share, 1.0, math.inf))
    return checks
