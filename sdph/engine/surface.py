"""Surface meshes from files of any kind that meshio reads."""

from __future__ import annotations

import io
import warnings
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

import numpy as np

from sdph.engine.reading import one_line
from sdph.schema import CaseError

SHORT = 200  # letters of what meshio says; our choice
LARGEST = 2**27  # bytes of a mesh, some 2.5 million triangles in binary STL; our choice


def read(path: str, key: str):
    """Mesh of a file as meshio reads it, its points finite; a `CaseError` with the key of the case where it is no
    mesh."""
    import meshio

    try:
        if not Path(path).is_file():  # nor a pipe or a device, which may have no end
            raise ValueError("there is no such file")
        if Path(path).stat().st_size > LARGEST:
            raise ValueError(f"it has {Path(path).stat().st_size} bytes; at most {LARGEST} are allowed")
        with (
            warnings.catch_warnings(),
            redirect_stdout(io.StringIO()),
            redirect_stderr(io.StringIO()),
        ):  # it prints what it also raises
            warnings.simplefilter("ignore")
            mesh = meshio.read(path)
        if not np.isfinite(mesh.points).all():
            raise ValueError("one of its points is no number")
        for block in mesh.cells:  # VTK would end the process
            if len(block.data) and not 0 <= np.min(block.data) <= np.max(block.data) < len(mesh.points):
                raise ValueError(
                    f"a cell of type {block.type} names a point that is not there; it has {len(mesh.points)}"
                )
    except (Exception, SystemExit) as error:  # meshio's readers trip over damaged files in ways of their own
        told = one_line(error, SHORT) or type(error).__name__
        raise CaseError(f"{key} = {path!r} cannot be read ({told}); give a surface mesh that meshio reads") from None
    return mesh
