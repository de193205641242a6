"""Reading of files that somebody else may have made: plain files alone, none larger than allowed, none waited for."""

from __future__ import annotations

import os
import stat
from pathlib import Path


class Unreadable(ValueError):
    """A file that is not what it has to be: what is wrong with it, in one line."""


def open_plain(path: Path, most: int) -> int:
    """A descriptor of a plain file (no link, pipe or device) of at most `most` bytes."""
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)  # a pipe nobody writes into would not open
    except (OSError, ValueError) as error:
        raise Unreadable(f"{path.name} cannot be read as a plain file ({getattr(error, 'strerror', None) or error})") from None
    found = os.fstat(descriptor)
    if stat.S_ISREG(found.st_mode) and found.st_size <= most:
        return descriptor
    os.close(descriptor)
    what = f"has {found.st_size} bytes; at most {most} are allowed" if stat.S_ISREG(found.st_mode) else "is no plain file"
    raise Unreadable(f"{path.name} {what}")


def read_plain(path: Path, most: int) -> bytes:
    """All of a plain file of at most `most` bytes."""
    with open(open_plain(path, most), "rb") as file:
        data = file.read(most + 1)
    if len(data) > most:
        raise Unreadable(f"{path.name} grows while it is read")
    return data
