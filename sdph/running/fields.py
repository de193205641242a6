"""Fields of a run in VTK files: written as it goes, and read back."""

from __future__ import annotations

import base64
import errno
import math
import os
import re
from pathlib import Path

import numpy as np

from sdph.engine.kept import Many, Unfit, short
from sdph.engine.world import ALONE
from sdph.running import pieces
from sdph.running.output import WALLS, write_text
from sdph.schema import CaseError

READERS = {
    ".vtp": "vtkXMLPolyDataReader",
    ".vtr": "vtkXMLRectilinearGridReader",
    ".vtu": "vtkXMLUnstructuredGridReader",
}
KNOWN = (*READERS, pieces.SUFFIX)  # endings of files of a timeline
LAST = b"</VTKFile>"
ENTRY = re.compile(
    r'<DataSet timestep="[\d.e+-]+" part="\d+" file="fields/(particles|gas|liquid|solid)_\d{5,}\.(vtp|vtr|vtu|pvtu)"/>'
)
PARTS = {"particles": 0, "gas": 1, "liquid": 2, "solid": 3}  # of a timeline
SHARED = "particles"  # what several processes have parts of; the gas is the chief's
SUFFIXES = {"vtkPolyData": ".vtp", "vtkRectilinearGrid": ".vtr", "vtkUnstructuredGrid": ".vtu"}
PVD = '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n<Collection>\n{}\n</Collection>\n</VTKFile>\n'
DENSEST = 255  # times: how much LZ4 can press together at most


def load(path: Path, arrays: tuple[str, ...] = ()):
    """A pyvista mesh of a VTK file, of particles in pieces that of all of them; `CaseError` where it is damaged, or is
    not empty and lacks one of `arrays`."""
    try:
        mesh = pieces.joined(path, _piece) if path.suffix == pieces.SUFFIX else _read(path)
        lacks = [name for name in arrays if mesh.n_points and name not in mesh.array_names]
        if lacks:
            raise ValueError(f"it has no array {lacks[0]}")
    except ValueError as error:
        raise CaseError(f"{path} is damaged or missing ({error}); run it again") from None
    return mesh


def _piece(path: Path):
    """Mesh of a piece, which is told of by its name where it is damaged."""
    try:
        return _read(path)
    except ValueError as error:
        raise ValueError(f"{path.name}: {error}") from None


def _read(path: Path):
    """Mesh of a file; ValueError where it is damaged."""
    if not whole(path):
        raise ValueError("not all of it is there")
    _check(path.read_bytes())
    return _decoded(path)


def _decoded(path: Path):
    """Mesh of a file by VTK, whose own complaints, of many lines, are kept from the terminal."""
    import pyvista
    from vtkmodules import vtkIOXML
    from vtkmodules.vtkCommonCore import vtkLogger

    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    reader = getattr(vtkIOXML, READERS[path.suffix])()
    reader.SetFileName(str(path))
    with pyvista.VtkErrorCatcher(send_to_logging=False) as caught:
        reader.Update()
        mesh = pyvista.wrap(reader.GetOutput())
    if caught.events or not np.isfinite(np.asarray(mesh.points)).all():
        raise ValueError("it cannot be decoded")
    return mesh


def _check(data: bytes) -> None:
    """ValueError where a file claims more than can be in it, or blocks of no size: VTK then ends the process."""
    numbers = [int(found) for found in re.findall(rb'\bNumberOf\w+="\s*(\d+)', data)]
    extents = [list(map(int, found.split())) for found in re.findall(rb'Extent="([\d\s-]+)"', data)]
    numbers += [math.prod(abs(b - a) + 1 for a, b in zip(e[::2], e[1::2])) for e in extents]
    if b"compressor=" in data:
        header = np.uint64 if b'header_type="UInt64"' in data else np.uint32
        numbers += [_unpacked(text, header) for text in re.findall(rb'format="binary"[^>]*>\s*([^\s<]*)', data)]
    if max(numbers, default=0) > DENSEST * len(data):
        raise ValueError("it claims to have more than it holds")


def _unpacked(text: bytes, header) -> int:
    """Bytes of an array in compressed blocks, whose number and size base64 begins with."""
    width = np.dtype(header).itemsize
    count, size, last = np.frombuffer(base64.b64decode(text[: 4 * width], validate=True), header, 3).tolist()
    if (count and not size) or last > size or count > len(text):
        raise ValueError("its blocks have no size")
    return count * size


class Fields:
    """Particles, and gas where there is any, on one timeline: `run.pvd` opens in ParaView and pyvista."""

    KEPT, FORMS = ("entries",), {"entries": Many("")}  # see sdph.engine.kept

    def __init__(self, folder: Path, world=ALONE):
        """Fields into a folder, to which each process of a world writes its particles and the chief all else."""
        self.folder, self.world = folder, world
        self.entries: list[str] = []

    def admit(self, kept: dict) -> None:
        """Unfit where an entry is not as `write` makes it."""
        for entry in kept["entries"]:
            if not ENTRY.fullmatch(entry):
                raise Unfit(f"{short(entry)} is no entry of run.pvd")

    def revive(self) -> None:
        """The timeline up to the checkpoint that was put back."""
        self._write_timeline()

    def write(self, time: float, meshes: dict) -> None:
        """`meshes` (name -> pyvista mesh, the same names each time) at `time` [s], and the timeline up to there; a
        process that is not the chief has its particles alone."""
        number = self.world.told(len(self.entries) // len(meshes))  # the chief has all names
        files = {f"fields/{name}_{number:05d}{self._suffix(name, mesh)}": mesh for name, mesh in meshes.items()}
        for name, mesh in files.items():
            self._save(mesh, self.folder / name)
        parts = [PARTS[name] for name in meshes]
        self.entries += [
            f'<DataSet timestep="{time:.9g}" part="{part}" file="{name}"/>' for part, name in zip(parts, files)
        ]
        self._write_timeline()

    def _suffix(self, name: str, mesh) -> str:
        return pieces.SUFFIX if self.world.number > 1 and name == SHARED else SUFFIXES[mesh.GetClassName()]

    def _save(self, mesh, path: Path) -> None:
        if path.suffix == pieces.SUFFIX:
            pieces.write(self.world, mesh, path, save)
            return
        pieces.forget(path)  # by several processes, before the run went back to a checkpoint
        save(mesh, path)

    def write_walls(self, walls) -> None:
        """A pyvista surface that holds for all times; nothing where it is None."""
        if walls is not None and self.world.chief:
            save(walls, self.folder / WALLS)

    def _write_timeline(self) -> None:
        if self.world.chief:
            write_text(self.folder / "run.pvd", PVD.format("\n".join(self.entries)))


def save(mesh, path: Path) -> None:
    """A VTK file, whole or not at all. VTK tells nobody when the disk is full: its last line does."""
    draft = path.with_name(f"part-{path.name}")
    mesh.save(draft, compression="lz4")  # a fifth of zlib's time for a tenth more room
    if not whole(draft):
        draft.unlink(missing_ok=True)
        raise OSError(errno.ENOSPC, f"{os.strerror(errno.ENOSPC)} (or another failure of VTK to write {path.name})")
    os.replace(draft, path)


def whole(path: Path) -> bool:
    """True where a VTK file is there, with its last line."""
    if not path.is_file():
        return False
    with open(path, "rb") as file:
        file.seek(max(0, path.stat().st_size - 2 * len(LAST)))
        return file.read().strip().endswith(LAST)
