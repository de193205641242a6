"""Messages over a socket: a Unix socket in a private folder, or TCP on the loopback.

The particles listen and the gas solver calls, its first message being HELLO with the secret of the run. Whoever does
not know that is turned away; once the solver is in, the listening socket is closed, so that nobody else can connect.
"""

from __future__ import annotations

import contextlib
import os
import socket
import tempfile
import time
from collections.abc import Callable

from coupling.transport.callers import MOST, Callers
from coupling.transport.folders import OwnFolder, sweep
from coupling.transport.messages import ABSOLUTE_LIMIT, HEADER, Message, decode_body, encode, read_header
from coupling.transport.waiting import SLICE, always, check_wait

PIECE = 2**20  # bytes of memory taken at first for a message
SENDING_TIME = 30.0  # s in which a peer has to take a message
PREFIX, NAME = "sdph-gas", "gas"  # of the folder of a socket, and the socket in it
LONGEST_PATH = 107  # bytes of the path of a Unix socket (unix(7): sun_path)
SHARED = "/tmp"  # where a socket can be when the user's own place for temporary files has too long a path


class SocketConnection:
    """One peer. `limit` [bytes] bounds each message in either direction."""

    def __init__(self, connection: socket.socket, limit: int = ABSOLUTE_LIMIT):
        self._socket = connection
        self.limit = limit

    def send(self, message: Message) -> None:
        """Hand over the whole message."""
        data = encode(message, self.limit)
        self._socket.settimeout(SENDING_TIME)
        try:
            self._socket.sendall(data)
        except OSError as error:
            raise ConnectionError(f"the gas solver does not take {message.kind.name}: {error}") from None

    def receive(self, timeout: float, alive: Callable[[], bool] = always) -> Message:
        """The next message; TimeoutError after `timeout` [s], ConnectionError when the peer is gone."""
        deadline = time.monotonic() + timeout
        kind, length, crc = read_header(bytes(self._read(HEADER.size, deadline, alive)), self.limit)
        return decode_body(kind, crc, self._read(length, deadline, alive))

    def _read(self, length: int, deadline: float, alive: Callable[[], bool]) -> bytearray:
        """`length` bytes; memory is taken as they come, not as the peer promises."""
        data, place = bytearray(min(length, PIECE)), 0
        while place < length:
            if place == len(data):
                data += bytes(min(len(data), length - place))
            place += self._read_some(memoryview(data)[place:], deadline, alive)
        return data

    def _read_some(self, room: memoryview, deadline: float, alive: Callable[[], bool]) -> int:
        """Bytes that came into `room`; 0 when none did for a while, which `alive` and the deadline judge."""
        self._socket.settimeout(max(1e-3, min(SLICE, deadline - time.monotonic())))
        try:
            got = self._socket.recv_into(room)
        except TimeoutError:
            check_wait(deadline, alive)
            return 0
        except OSError as error:
            raise ConnectionError(f"connection lost: {error}") from None
        if got == 0:
            raise ConnectionError("the peer closed the connection")
        check_wait(deadline, always)  # one who sends byte by byte has no more time than others
        return got

    def close(self) -> None:
        """Close the connection; a second call does nothing."""
        self._socket.close()


def _own_folder() -> OwnFolder | None:
    """A folder for a socket, where the path is short enough for one; None where there is no such place. Those of dead
    owners go."""
    for where in _places():
        sweep(where, PREFIX, {NAME})
        try:
            folder = OwnFolder(where, PREFIX)
        except OSError:
            continue  # nothing can be made there
        if len(os.fsencode(folder.path / NAME)) <= LONGEST_PATH:
            return folder
        folder.close()
    return None


def _places() -> list[str]:
    try:
        return list(dict.fromkeys((tempfile.gettempdir(), SHARED)))
    except OSError:  # there is no place for temporary files
        return []


class SocketServer:
    """Waits for the gas solver. `address` is what the solver is told: "unix:<path>" or "tcp:<host>:<port>".

    TCP on the loopback is taken where it is asked for, and where no folder can hold a Unix socket.
    """

    def __init__(self, secret: str, tcp: bool = False):
        self._secret, self._folder = secret, None if tcp else _own_folder()
        if self._folder is None:
            self._socket = socket.create_server(("127.0.0.1", 0), backlog=MOST)
            self.address = "tcp:{}:{}".format(*self._socket.getsockname())
        else:
            path = str(self._folder.path / NAME)
            self._socket = socket.socket(socket.AF_UNIX)
            self._socket.bind(path)
            self._socket.listen(MOST)
            self.address = f"unix:{path}"

    def accept(self, timeout: float, alive: Callable[[], bool] = always, limit: int = ABSOLUTE_LIMIT):
        """(connection, first message) of the first caller who knows the secret; then nobody else can call."""
        with contextlib.closing(Callers(self._socket, self._secret)) as callers:
            connection, first = callers.find(time.monotonic() + timeout, alive)
        self.close()
        if connection.family != socket.AF_UNIX:
            connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return SocketConnection(connection, limit), first

    def close(self) -> None:
        """Stop listening and remove the folder of the socket; a second call does nothing."""
        self._socket.close()
        if self._folder is not None:
            self._folder.close()
