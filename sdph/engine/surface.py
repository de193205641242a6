"""Surface meshes from files of any kind that meshio reads."""

from __future__ import annotations

import io
import warnings
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import NamedTuple

import numpy as np

from sdph.engine.reading import one_line
from sdph.schema import CaseError

SHORT = 200  # letters of what meshio says; our choice
LARGEST = 2**27  # bytes of a mesh, some 2.5 million triangles in binary STL; our choice
# widths of the domain that a surface may be wide: one in inches is 39 times as wide as it is meant, in millimetres a
# thousand times; our choice
WIDEST = 20.0


def refuse_size(key: str, path: str, points: np.ndarray, domain, spacing: float) -> None:
    """CaseError where a surface (points (P, d) [m]) is so wide or so narrow that its lengths are in another unit than
    metres; `domain` (d,) [m] is the size of the case's, `spacing` [m] that of its particles."""
    width = float(np.ptp(points, axis=0).max())
    if spacing <= width <= WIDEST * max(domain):
        return
    size = f"domain.size_m = {[float(f'{length:.6g}') for length in domain]}"
    wide = f"{key} = {path!r} is {width:.4g} m wide as it is read, and"
    if width > spacing:
        raise CaseError(
            f"{wide} {size}: perhaps its lengths are millimetres; set {key}_scale, the metres of its unit (0.001 for "
            "millimetres), or enlarge the domain"
        )
    raise CaseError(
        f"{wide} resolution.spacing_mm = {1e3 * spacing:.4g}, which does not see it; look at {key}_scale, the metres "
        "of its unit, or lower the spacing"
    )


class Unit(NamedTuple):
    """Metres of a unit of a file, and where its origin stands (d,) [m]; None where that is the case's."""

    scale: float = 1.0
    offset: tuple | None = None

    def placed(self, points: np.ndarray) -> np.ndarray:
        """Points (P, 2 or 3) of the file in the case [m]."""
        scaled = self.scale * np.asarray(points, float)
        if self.offset is not None:
            scaled[:, : len(self.offset)] += self.offset
        return scaled


METRES = Unit()


def unit(own) -> Unit:
    """Unit and place of the mesh that a section of a case names."""
    return Unit(own.mesh_scale, own.mesh_offset)


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
