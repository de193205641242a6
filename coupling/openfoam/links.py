"""Folders as OpenFOAM can name them: it takes no blanks and quotes in a path, and strips them without a word."""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path

REFUSED = " \t\"'"  # OpenFOAM's fileName takes none of these
PREFIX = "sdph-links-"


def takes(folder: Path) -> bool:
    """True where OpenFOAM can work in a folder under its own name."""
    return not set(str(folder)) & set(REFUSED)


class Links:
    """Names without blanks and quotes of folders that have some: links in a temporary folder, gone with `close`."""

    def __init__(self) -> None:
        self._folder, self._names = None, {}

    def plain(self, folder: Path) -> Path:
        """The resolved folder itself, or a link to it where OpenFOAM does not take its path."""
        folder = Path(folder).resolve()
        if takes(folder):
            return folder
        if self._folder is None:
            self._folder = Path(tempfile.mkdtemp(prefix=PREFIX))  # made with mode 0700
        if folder not in self._names:
            self._names[folder] = self._folder / str(len(self._names))
            self._names[folder].symlink_to(folder, target_is_directory=True)
        return self._names[folder]

    def place(self, folder: Path) -> Path:
        """Folder to start a program in that works on `folder`: OpenFOAM looks where it stands, past links."""
        plain = self.plain(folder)
        return plain if self._folder is None else self._folder

    def address(self, address: str) -> str:
        """The address of a server (coupling.transport), where it is a folder under its name here."""
        kind, _, folder = address.partition(":")
        return f"{kind}:{self.plain(folder)}" if kind == "file" else address

    def close(self) -> None:
        """Take the links away; a second call does nothing."""
        if self._folder is not None:
            shutil.rmtree(self._folder, ignore_errors=True)
        self._folder, self._names = None, {}
