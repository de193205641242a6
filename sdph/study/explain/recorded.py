"""Price of the runs that nozzles of a case record, and that go before it: the sheet whose drops a spray is of."""

from __future__ import annotations

from sdph.case import judge
from sdph.running import inputs
from sdph.study.explain import mps

WALL = "wall time"


def rows(case, expected: list[dict]) -> list[dict]:
    """Rows of what each such run is expected to be, as `mps.expected` has them; with those `expected` of the case
    itself the time of all."""
    found = []
    for name, nozzle in case.nozzles.items():
        if nozzle.record and not nozzle.table:
            found += [{"nozzle": name, "records": nozzle.record} | row for row in _of(name, nozzle)]
    times = [row["value"] for row in (*expected, *found) if row["what"] == WALL]
    if len(times) > 1:
        found.append({"nozzle": "", "records": "", "what": f"{WALL} of all", "value": sum(times), "unit": "s"})
    return found


def _of(name: str, nozzle) -> list[dict]:
    """The same of one nozzle."""
    recorded, done = inputs.recorded(f"nozzles.{name}", nozzle)
    if done:
        return [{"what": "has been run already", "value": str(done), "unit": ""}]
    scales = judge.scales_of(recorded)
    return mps.expected(scales, mps.limits(scales))
