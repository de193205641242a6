"""Rehearsal of `sdph run` up to its first window, without a gas: what cannot be is refused."""

from __future__ import annotations

import math
import tempfile
from pathlib import Path

from coupling.choice import OWN_MESH, expected
from coupling.openfoam import poly_mesh
from sdph.case.gas_cells import cell_edges, cells
from sdph.exchange.window import Window
from sdph.methods.grains import start
from sdph.methods.grains.grains import Grains
from sdph.methods.liquids.start import parts_of as parts_of_liquid
from sdph.methods.mps.method import MpsStepper
from sdph.methods.solids.method import SolidStepper
from sdph.running import inputs, metrics
from sdph.schema import CaseError
from sdph.study import closed_vessels
from sdph.study import memory as room
from sdph.study.explain import estimate

# method -> what makes all of it that a run begins with
MADE = {
    "grains": lambda case: (Grains(case), Window(case)), "liquid": parts_of_liquid, "mps": MpsStepper,
    "solid": SolidStepper,
}  # fmt: skip


def priced(case, template: Path):
    """Gas that a run would have, for estimates of its time; None for the embedded solver's, or without any."""
    if "grains" not in case.matters or expected(case.only("grains")) == "embedded":
        return None
    own = (template / poly_mesh.FOLDER).is_dir()
    return estimate.by_openfoam(len(poly_mesh.PolyMesh(template).volumes) if own else math.prod(cells(case)))


def rehearse(case, template: Path, *, allow_code: bool = False) -> None:
    """CaseError where `sdph run` would end with one; `template` and `allow_code` as in `coupling.choice.open_gas`."""
    look(case, template, allow_code=allow_code)
    if any((template / name).exists() for name in OWN_MESH):  # walls that the run will know by it
        case = start.assumed(case)
    for matter in case.matters:
        MADE[case.moved_by(matter)](case.only(matter))


def look(case, template: Path, *, allow_code: bool = False) -> None:
    """The same without particles, which a run makes next: where this passes they decide."""
    inputs.check(case)
    room.refuse_too_large(case)
    metrics.refuse_unknown(case)
    if "grains" in case.matters:
        grains = case.only("grains")
        _gas(grains, template, expected(grains), allow_code)
        closed_vessels.refuse_filling(grains, template)


def _gas(case, template: Path, chosen: str, allow_code: bool) -> None:
    """Rehearse what the gas solver `chosen` makes of the case before it starts."""
    own = next((template / name for name in OWN_MESH if (template / name).exists()), None)
    if own and case.coupling.gas == "embedded":
        raise CaseError(f"{own} is a mesh that only OpenFOAM reads; give --gas openfoam, or take the mesh away")
    if own and chosen == "embedded":
        raise CaseError(
            f"{own} is a mesh that only OpenFOAM reads, and OpenFOAM was not found; get it with: sdph openfoam setup "
            "--install"
        )
    if chosen == "embedded":
        from coupling.embedded.box import Box
        from coupling.embedded.grid import build_grid

        Box(case, build_grid(cell_edges(case)), limited=True)
        return
    from coupling.openfoam.case import write_case
    from coupling.openfoam.programs.installation import require

    require()
    with tempfile.TemporaryDirectory(prefix="sdph-explain-") as folder:
        write_case(case, template, Path(folder) / "gas", case.coupling.gas_ranks, allow_code)
