"""Folders that belong to a process and are locked while it lives: one whose lock can be taken has a dead owner.

The lock is the kernel's own (flock), so that it counts between processes that do not see each other's numbers too, as
in containers that share /tmp, and goes with its owner, however that ends.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
import shutil
import tempfile
from pathlib import Path


class OwnFolder:
    """A new folder `<prefix>-<random>` in `where`, for this user alone; `path` is its place.

    It gets that name when it is locked: nobody sees it without a lock while its owner lives.
    """

    def __init__(self, where: Path | str, prefix: str):
        draft = Path(tempfile.mkdtemp(prefix=f".{prefix}-", dir=where)).absolute()  # made with mode 0700
        self.path, self._lock = draft.with_name(draft.name[1:]), os.open(draft, os.O_RDONLY | os.O_DIRECTORY)
        try:
            fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            os.rename(draft, self.path)
        except OSError:
            draft.rmdir()
            os.close(self._lock)
            raise

    def close(self) -> None:
        """Remove the folder with all that is in it; a second call does nothing."""
        if self._lock is not None:
            shutil.rmtree(self.path, ignore_errors=True)
            os.close(self._lock)
            self._lock = None


def sweep(where: Path | str, prefix: str, contents: set[str]) -> None:
    """Remove the folders `<prefix>-*` in `where` whose owners are dead.

    Left alone: links, folders of other users, locked ones, and those that hold anything but `contents`.
    """
    with contextlib.suppress(OSError):  # nobody may look into `where`
        for path in list(Path(where).glob(f"{prefix}-*")):
            with contextlib.suppress(OSError):  # its owner lives, or somebody else was quicker
                _remove_dead(path, contents)


def _remove_dead(path: Path, contents: set[str]) -> None:
    if os.lstat(path).st_uid != os.geteuid():
        return
    lock = os.open(path, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        if os.path.samestat(os.fstat(lock), os.lstat(path)) and set(os.listdir(lock)) <= contents:
            shutil.rmtree(path)
    finally:
        os.close(lock)
