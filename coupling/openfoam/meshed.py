"""The mesh of a case of one's own before a run: a blockMeshDict is run in a copy, as the run will."""

from __future__ import annotations

import contextlib
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path

from coupling.gas import GasError
from coupling.openfoam import poly_mesh
from coupling.openfoam.case import write_case, write_start_fields
from coupling.openfoam.code import refuse_code
from coupling.openfoam.programs import barrier, install
from coupling.openfoam.programs import run as programs

FAILED = "failed"  # file in a folder that stays


@contextlib.contextmanager
def meshed(case, template: Path, allow_code: bool = False) -> Iterator[Path]:
    """The OpenFOAM case with its mesh: `template` itself, or where only a blockMeshDict of its own tells of the mesh,
    a copy in which that has been made, there as long as the context lasts."""
    if (template / poly_mesh.FOLDER).is_dir() or not (template / poly_mesh.BLOCKS).is_file():
        yield template
        return
    folder = Path(tempfile.mkdtemp(prefix="sdph-mesh-"))
    try:
        _make(case, template, folder / "gas", allow_code)
        yield folder / "gas"
    finally:
        if not (folder / FAILED).exists():
            shutil.rmtree(folder, ignore_errors=True)


def _make(case, template: Path, made: Path, allow_code: bool) -> None:
    """Make a case and its mesh in the folder `made`."""
    write_case(case, template, made, 1, allow_code)
    if not allow_code:
        refuse_code(made)
    environment = install.environment() if allow_code else barrier.environment()
    try:
        programs.run(["blockMesh"], made, made / "log.blockMesh", environment)
    except GasError:
        (made.parent / FAILED).touch()  # who reads the log wants the folder
        raise
    write_start_fields(case, made)
