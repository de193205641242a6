"""Particles of an instant that several processes share, in a file each: `particles_00003.pvtu` names them, as
`pieces/particles_00003_0000.vtu` and so on, by the rank of who wrote them; who has none writes none.

Particles stand in the order of the ranks. In VTK files of points without a mesh, as these are of, only those of
unstructured grids may be in pieces for all programs: pyvista knows no pieces of PolyData.
"""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from sdph.running.output import PIECES, write_text

SUFFIX = ".pvtu"
SOURCE = re.compile(r"pieces/particles_\d{5,}_\d{4,}\.vtu")
NAMES = {"f": "Float", "i": "Int", "u": "UInt"}  # kinds of numbers, as VTK calls them
WHOLE = """<?xml version="1.0"?>
<VTKFile type="PUnstructuredGrid" version="0.1" byte_order="LittleEndian">
<PUnstructuredGrid GhostLevel="0">
<PPointData>
{arrays}
</PPointData>
<PPoints>
{points}
</PPoints>
{pieces}
</PUnstructuredGrid>
</VTKFile>
"""


def write(world, cloud, path: Path, save) -> None:
    """A file of particles (pyvista points, on each process its own), whole or not there; `save(mesh, path)` writes a
    piece so. Processes that share a folder call it together."""
    folder = path.parent / PIECES
    if world.chief:
        forget(path)
        path.with_suffix(".vtp").unlink(missing_ok=True)  # by one process, before the run went back to a checkpoint
        folder.mkdir(exist_ok=True)
    world.told(None)  # all wait until there is room for them
    name, layout = f"{path.stem}_{world.rank:04d}.vtu", None
    if cloud.n_points:
        save(cloud.cast_to_unstructured_grid(), folder / name)
        layout = _layout(cloud)
    told = world.gather((name, layout))  # at the chief once all are written
    if told:
        write_text(path, _whole([own for own in told if own[1]]))
    world.told(None)  # all wait until it is there


def forget(path: Path) -> None:
    """Remove a file of particles in pieces, if there is one, and then these."""
    path.with_suffix(SUFFIX).unlink(missing_ok=True)
    for piece in (path.parent / PIECES).glob(f"{path.stem}_*.vtu"):
        piece.unlink()


def joined(path: Path, read):
    """The particles that a file names, as pyvista points; `read(piece)` is an unstructured grid. ValueError where it
    names no pieces, or they do not fit together."""
    import pyvista

    names = _named(path)
    clouds = [read(path.parent / name) for name in names]
    whole = pyvista.PolyData(np.concatenate([cloud.points for cloud in clouds] or [np.zeros((0, 3))]))
    for name in clouds[0].array_names if clouds else ():
        if any(name not in cloud.point_data for cloud in clouds):
            raise ValueError(f"array {name} is not in all of its pieces")
        whole[name] = np.concatenate([cloud.point_data[name] for cloud in clouds])
    return whole


def _named(path: Path) -> list[str]:
    """Names of the pieces, in their order."""
    try:
        names = [piece.attrib.get("Source", "") for piece in ElementTree.parse(path).getroot().iter("Piece")]
    except FileNotFoundError:
        raise ValueError("it is not there") from None
    except SyntaxError as error:
        raise ValueError(f"it cannot be decoded: {error}") from None
    for name in names:
        if not SOURCE.fullmatch(name):
            raise ValueError(f"{name[:80]!r} is no piece of it")
    return names


def _layout(cloud) -> tuple[list[str], str]:
    """The arrays of a cloud, and its points, as the file that names pieces has them."""
    arrays = [_array(values, name) for name, values in cloud.point_data.items()]
    return arrays, _array(cloud.points, "Points")


def _array(values, name: str) -> str:
    kind = f"{NAMES[values.dtype.kind]}{8 * values.dtype.itemsize}"
    width = values.shape[1] if values.ndim > 1 else 1
    return f'<PDataArray type="{kind}" Name="{name}" NumberOfComponents="{width}"/>'


def _whole(told: list[tuple]) -> str:
    """Text of the file that names the pieces of processes, each told of with what it holds."""
    arrays, points = told[0][1] if told else ([], '<PDataArray type="Float64" NumberOfComponents="3"/>')
    names = (f'<Piece Source="{PIECES}/{name}"/>' for name, _ in told)
    return WHOLE.format(arrays="\n".join(arrays), points=points, pieces="\n".join(names))
