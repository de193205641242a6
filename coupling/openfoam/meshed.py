"""The mesh of a case of one's own before a run: a blockMeshDict is run in a copy, as the run will."""

from __future__ import annotations

import contextlib
import tempfile
from collections.abc import Iterator
from pathlib import Path

from coupling.openfoam import poly_mesh
from coupling.openfoam.case import write_case, write_start_fields
from coupling.openfoam.code import refuse_code
from coupling.openfoam.programs import barrier, install
from coupling.openfoam.programs import run as programs


@contextlib.contextmanager
def meshed(case, template: Path, allow_code: bool = False) -> Iterator[Path]:
    """The OpenFOAM case with its mesh: `template` itself, or where only a blockMeshDict of its own tells of the mesh,
    a copy in which that has been made, there as long as the context lasts."""
    if (template / poly_mesh.FOLDER).is_dir() or not (template / poly_mesh.BLOCKS).is_file():
        yield template
        return
    with tempfile.TemporaryDirectory(prefix="sdph-mesh-") as folder:
        made = Path(folder) / "gas"
        write_case(case, template, made, 1, allow_code)
        if not allow_code:
            refuse_code(made)
        environment = install.environment() if allow_code else barrier.environment()
        programs.run(["blockMesh"], made, made / "log.blockMesh", environment)
        write_start_fields(case, made)
        yield made
