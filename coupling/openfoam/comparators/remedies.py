"""Words on a two-fluid solver that broke down: what of the case it can hang on, and what to change."""

from __future__ import annotations

import re

from coupling.openfoam.cell_sizes import largest_jump
from coupling.openfoam.poly_mesh import PolyMesh

# of a floating-point error, by the signal, by OpenFOAM's own word, and by the code that mpirun ends with (128 + 8)
BROKE = re.compile(r"SIGFPE|sigFpe|Floating point exception|ended with code 136")
JUMP = 1.2  # of the width of a cell over its neighbour's: what grading is allowed, as a rule; our choice


def remedy(told: str, mesh: PolyMesh | None, step: float) -> str:
    """Words to end the line with in which a solver's end was `told`: what to change; empty where it was no
    floating-point error. `mesh` is one of the case's own, `step` [s] that of the solver."""
    if not BROKE.search(told):
        return ""
    if mesh is not None:
        ratio, place = largest_jump(mesh)
        if ratio > JUMP:
            where = ", ".join(f"{x:.4g}" for x in place)
            return (
                f"; cells of the mesh jump in width by {ratio:.3g} at ({where}) m, where two fluids see a bed too "
                f"dense: let neighbours differ by {JUMP:g} at most, by even or graded blocks, or begin with less "
                "volume_fraction"
            )
    return (
        f"; its step of {step:.3g} s may be too long: run the case anew with run.output_interval_s of {0.5 * step:.2g} "
        "or less, which no step of two fluids is longer than"
    )
