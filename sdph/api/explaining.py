"""`sdph.explain`: what a case calls for, its limits and its cost, before it runs."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

from sdph.api.case import Case
from sdph.study import explained
from sdph.study.explain import tables

if TYPE_CHECKING:
    import pandas


class Explanation(dict[str, list[dict[str, Any]]]):
    """Parts (numbers, effects, ratios, limits, expected, warnings), each a list of rows; printed as `sdph explain`
    prints it."""

    @property
    def warnings(self) -> list[str]:
        """Warnings: doubts about the case."""
        return [row["warning"] for part, rows in self.items() if part.startswith("warnings") for row in rows]

    def frame(self, part: str) -> pandas.DataFrame:
        """A part as a pandas data frame."""
        import pandas

        return pandas.DataFrame(self[part])

    def __str__(self) -> str:
        return tables.text(self)


def explain(case: Case | str | os.PathLike[str], *, allow_code: bool = False) -> Explanation:
    """Judge what a case (or scene, folder, file) calls for, its limits and its cost; `CaseError` where `run`
    would end with one."""
    own = Case.of(case)
    return Explanation(explained.explained(own.resolved, own.gas_folder, allow_code=allow_code))
