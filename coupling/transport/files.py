"""The same messages through files in a folder, for machines where sockets are closed.

Message n of a direction is the file `to_gas/<n>` or `to_sdph/<n>`: written under a temporary name, then
renamed, so that a reader never sees a part of it, and removed by whoever read it.
"""

from __future__ import annotations

import os
import shutil
import time
from collections.abc import Callable
from pathlib import Path

from coupling.transport import folders
from coupling.transport.messages import (
    ABSOLUTE_LIMIT,
    GREETING_LIMIT,
    HEADER,
    Message,
    MessageError,
    decode,
    encode,
    secret_fits,
)
from coupling.transport.waiting import SLICE, always
from sdph.engine.reading import Unreadable, read_plain

PREFIX, DIRECTIONS = "exchange", ("to_gas", "to_sdph")  # of a folder for an exchange, and what is in it
SHORTEST_SLEEP, LONGEST_SLEEP = 5e-5, 2e-3  # s between two looks for a file


class FileConnection:
    """One side of an exchange through `folder`. `limit` [bytes] bounds each message in either direction."""

    def __init__(
        self, folder: Path, outgoing: str = DIRECTIONS[0], incoming: str = DIRECTIONS[1], limit: int = ABSOLUTE_LIMIT
    ):
        self._out, self._in = Path(folder) / outgoing, Path(folder) / incoming
        self._sent = self._received = 0
        self.limit, self.own = limit, None  # own: the folder, where it was made for this exchange alone
        for path in (self._out, self._in):
            path.mkdir(mode=0o700, parents=True, exist_ok=True)

    def send(self, message: Message) -> None:
        """Leave the message as the next file."""
        draft = self._out / "draft"
        draft.write_bytes(encode(message, self.limit))
        os.rename(draft, self._out / str(self._sent))
        self._sent += 1

    def receive(self, timeout: float, alive: Callable[[], bool] = always) -> Message:
        """The next message; TimeoutError after `timeout` [s], ConnectionError when the peer is gone."""
        path = self._in / str(self._received)
        self._wait(path, time.monotonic() + timeout, alive)
        try:
            data = read_plain(path, self.limit + HEADER.size)
        except Unreadable as error:
            raise MessageError(f"message {error}") from None
        message = decode(data, self.limit)
        path.unlink()
        self._received += 1
        return message

    def _wait(self, path: Path, deadline: float, alive: Callable[[], bool]) -> None:
        sleep, look = SHORTEST_SLEEP, time.monotonic() + SLICE
        while not path.exists():
            now = time.monotonic()
            if now >= look:
                look = now + SLICE
                if not alive() and not path.exists():
                    raise ConnectionError("the peer has ended")
            if now >= deadline:
                raise TimeoutError("no message in time")
            time.sleep(sleep)
            sleep = min(LONGEST_SLEEP, 1.2 * sleep)

    def close(self) -> None:
        """Remove the messages that nobody read, and the folder where it was made for them; a second call does
        nothing."""
        for folder in (self._out, self._in):
            shutil.rmtree(folder, ignore_errors=True)
        if self.own is not None:
            self.own.close()


def sweep(folder: Path) -> None:
    """Remove what exchanges in `folder` have left whose processes were killed."""
    folders.sweep(folder, PREFIX, set(DIRECTIONS))


class FileServer:
    """Waits for the gas solver in `folder`. `address` is what the solver is told: "file:<folder>"."""

    def __init__(self, secret: str, folder: Path):
        self._secret, self._accepted = secret, False
        self._folder = Path(folder).resolve()
        self._folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        if any(self._folder.iterdir()):
            raise FileExistsError(f"{self._folder} is in use by another run: it is not empty")
        self._connection = FileConnection(self._folder)
        self.address = f"file:{self._folder}"

    @classmethod
    def inside(cls, secret: str, folder: Path) -> FileServer:
        """One in a new folder in `folder`, which goes when the connection is closed."""
        own = folders.OwnFolder(folder, PREFIX)
        server = cls(secret, own.path)
        server._connection.own = own
        return server

    def accept(self, timeout: float, alive: Callable[[], bool] = always, limit: int = ABSOLUTE_LIMIT):
        """(connection, first message) of the solver of this run."""
        self._connection.limit = GREETING_LIMIT
        first = self._connection.receive(timeout, alive)
        if not secret_fits(first, self._secret):
            raise ConnectionError(f"{self._folder} holds a message of another run: its secret is wrong")
        self._connection.limit, self._accepted = limit, True
        return self._connection, first

    def close(self) -> None:
        """Stop listening; where nobody came, nothing of the exchange stays."""
        if not self._accepted:
            self._connection.close()
