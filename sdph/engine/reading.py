"""Reading of what somebody else may have made: plain files alone, of bounded size, from which nothing is executed; a
text as one line."""

from __future__ import annotations

import json
import math
import os
import re
import stat
import struct
import zipfile
from pathlib import Path

import numpy as np

# of a file, of what becomes of it, of lists in lists; our choice
JSON_BYTES, JSON_MEMORY, JSON_DEPTH = 2**27, 2**27, 64
ENTRY = 100  # bytes of memory that a value of JSON takes at most, its text left out
DIRECTORY = 2**22  # bytes of the list of arrays in a file, some 40 000; our choice
# of a zip file (APPNOTE.TXT 4.3): signature, bytes of the list
END, END_64, LOCATOR = struct.Struct("<4s8xL6x"), struct.Struct("<4s36xQ8x"), 20
PREFIX = b"\x93NUMPY\x01\x00"  # of an array (numpy.lib.format, version 1.0), before the length of its header
HEAD = re.compile(
    rb"\{'descr': '([<|][biufU]\d{1,9})', 'fortran_order': (True|False), 'shape': \(([\d, ]{0,200})\), \} *\n"
)
LINE = 2000  # letters of a line that says what is wrong; our choice
MOST_NUMBERS = 2**40  # of an array, extents of 0 taken as 1


class Unreadable(ValueError):
    """A file that is not what it has to be: what is wrong with it, in one line."""


def one_line(text, most: int = LINE) -> str:
    """A text, or what an error says, as one line that a terminal takes for no commands; its middle is left out where it
    has more than `most` letters."""
    words = " ".join(str(text).split())
    line = "".join(letter if letter.isprintable() else repr(letter)[1:-1] for letter in words)
    return line if len(line) <= most else f"{line[: most // 2]} [...] {line[-most // 2 :]}"


def open_plain(path: Path, most: int) -> int:
    """A descriptor of a plain file (no link, pipe or device) of at most `most` bytes."""
    try:
        # a pipe nobody writes into would not open
        descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or error
        raise Unreadable(f"{path.name} cannot be read as a plain file ({why})") from None
    found = os.fstat(descriptor)
    plain = stat.S_ISREG(found.st_mode)
    if plain and found.st_size <= most:
        return descriptor
    os.close(descriptor)
    wrong = f"has {found.st_size} bytes; at most {most} are allowed" if plain else "is no plain file"
    raise Unreadable(f"{path.name} {wrong}")


def read_plain(path: Path, most: int) -> bytes:
    """All of a plain file of at most `most` bytes."""
    with open(open_plain(path, most), "rb") as file:
        data = file.read(most + 1)
    if len(data) > most:
        raise Unreadable(f"{path.name} grows while it is read")
    return data


def read_json(path: Path):
    """Value of a JSON file; NaN and Infinity are numbers."""
    data = read_plain(path, JSON_BYTES)
    if len(data) + ENTRY * sum(data.count(mark) for mark in (b",", b"[", b"{")) > JSON_MEMORY:
        raise Unreadable(f"{path.name} would take more than {JSON_MEMORY} bytes of memory")
    try:
        value = json.loads(data)
    except RecursionError:
        raise Unreadable(f"{path.name} is nested too deeply") from None
    except ValueError as error:
        raise Unreadable(f"{path.name} is no JSON ({error})") from None
    _refuse_depth(path, value)
    return value


def _refuse_depth(path: Path, value) -> None:
    level = [value]
    for _ in range(JSON_DEPTH):
        level = [
            part
            for whole in level
            if isinstance(whole, (dict, list))
            for part in (whole.values() if isinstance(whole, dict) else whole)
        ]
        if not level:
            return
    raise Unreadable(f"{path.name} is nested too deeply")


def read_arrays(path: Path, most: int) -> dict[str, np.ndarray]:
    """Name -> array of a file as `np.savez` writes it, of at most `most` bytes: numbers and texts, stored as they
    are."""
    with open(open_plain(path, most), "rb") as file:
        try:
            return _arrays(file, os.fstat(file.fileno()).st_size)
        except Unreadable as error:
            raise Unreadable(f"{path.name}: {error}") from None
        except MemoryError:
            raise Unreadable(f"{path.name} does not fit into memory") from None
        except Exception as error:  # zipfile lets through whatever goes wrong in its parts
            raise Unreadable(f"{path.name} is no file of arrays ({error})") from None


def _arrays(file, size: int) -> dict[str, np.ndarray]:
    if _directory(file, size) > DIRECTORY:
        raise Unreadable("it lists too many arrays")
    with zipfile.ZipFile(file) as archive:
        members = archive.infolist()
        if sum(member.file_size for member in members) > size or any(
            member.compress_type != zipfile.ZIP_STORED for member in members
        ):
            raise Unreadable("it says that it holds more than it is long")
        if len(archive.NameToInfo) < len(members):
            raise Unreadable("it holds two arrays of one name")
        return {member.filename.removesuffix(".npy"): _array(archive.read(member)) for member in members}


def _directory(file, size: int) -> int:
    """Bytes of the list of a zip file without a comment, as its end tells, or the end of a large one before that."""
    file.seek(max(0, size - END.size - LOCATOR - END_64.size))
    tail = file.read().rjust(END.size + LOCATOR + END_64.size, b"\0")
    (mark, short), (mark_64, long) = END.unpack(tail[-END.size :]), END_64.unpack(tail[: END_64.size])
    if mark != b"PK\x05\x06":
        raise Unreadable("it has no end")
    return max(short if short < 2**32 - 1 else 0, long if mark_64 == b"PK\x06\x06" else 0)


def _array(data: bytes) -> np.ndarray:
    start = len(PREFIX) + 2
    length = int.from_bytes(data[len(PREFIX) : start], "little")
    head = HEAD.fullmatch(data[start : start + length])
    if data[: len(PREFIX)] != PREFIX or head is None:
        raise Unreadable("an array is not of plain numbers or texts")
    dtype, shape = (
        np.dtype(head[1].decode()),
        tuple(int(extent) for extent in head[3].decode().replace(",", " ").split()),
    )
    start += length
    if (
        math.prod(max(1, extent) for extent in shape) > MOST_NUMBERS
        or math.prod(shape) * dtype.itemsize != len(data) - start
    ):
        raise Unreadable(f"an array of shape {shape} and type {dtype} has {len(data) - start} bytes")
    flat = np.frombuffer(data, dtype, offset=start) if len(data) > start else np.empty(0, dtype)
    return flat.reshape(shape, order="F" if head[2] == b"True" else "C").copy(order="A")
