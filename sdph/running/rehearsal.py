"""What `sdph run` makes of a case before its first window, made without a gas: what cannot be is refused."""

from __future__ import annotations

import tempfile
from pathlib import Path

from coupling.openfoam.build import silent
from sdph import driver, metrics, room
from sdph.gas_cells import cell_edges
from sdph.liquid.run import Moments
from sdph.liquid.step import parts_of as parts_of_liquid
from sdph.simulation import parts_of
from sdph.window import Window


def rehearse(case, template: Path, *, allow_code: bool = False) -> None:
    """CaseError where `sdph run` would end with one; `template` and `allow_code` as in `driver.open_gas`."""
    room.refuse_too_large(case)
    metrics.refuse_unknown(case)
    if case.liquid:
        parts_of_liquid(case)
        Moments(case)
        return
    parts_of(case)
    Window(case)
    _gas(case, template, allow_code)


def _gas(case, template: Path, allow_code: bool) -> None:
    """What each gas solver makes of the case before it starts."""
    if driver.chosen_gas(case, silent) == "embedded":
        from coupling.embedded.box import Box
        from coupling.embedded.grid import build_grid

        Box(case, build_grid(cell_edges(case)), limited=True)
        return
    from coupling.openfoam.case import write_case
    from coupling.openfoam.installation import require

    require()
    with tempfile.TemporaryDirectory(prefix="sdph-explain-") as folder:
        write_case(case, template, Path(folder) / "gas", case.coupling.ranks, allow_code)
