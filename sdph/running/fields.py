"""Fields of a run, read back from its VTK files."""

from __future__ import annotations

import base64
import math
import re
from pathlib import Path

import numpy as np

from sdph.running import output
from sdph.schema import CaseError

READERS = {
    ".vtp": "vtkXMLPolyDataReader",
    ".vtr": "vtkXMLRectilinearGridReader",
    ".vtu": "vtkXMLUnstructuredGridReader",
}
DENSEST = 255  # times: how much LZ4 can press together at most


def load(path: Path, arrays: tuple[str, ...] = ()):
    """A pyvista mesh of a VTK file; `CaseError` where it is damaged, or is not empty and lacks one of `arrays`."""
    try:
        if not output.whole(path):
            raise ValueError("not all of it is there")
        _check(path.read_bytes())
        mesh = _decoded(path)
        lacks = [name for name in arrays if mesh.n_points and name not in mesh.array_names]
        if lacks:
            raise ValueError(f"it has no array {lacks[0]}")
    except ValueError as error:
        raise CaseError(f"{path} is damaged or missing ({error}); run it again") from None
    return mesh


def _decoded(path: Path):
    """What VTK makes of a file. Its own complaints, of many lines, are kept from the terminal."""
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
    if count and not size or last > size or count > len(text):
        raise ValueError("its blocks have no size")
    return count * size
