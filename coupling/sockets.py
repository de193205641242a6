"""Messages over a socket: a Unix socket in a private folder, or TCP on the loopback.

The particles listen and the gas solver calls. Whoever does not know the secret of the run is turned away;
once the solver is in, the listening socket is closed, so that nobody else can connect.
"""

from __future__ import annotations

import hmac
import os
import shutil
import socket
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from coupling.messages import ABSOLUTE_LIMIT, HEADER, Kind, Message, MessageError, decode_body, encode, read_header

SLICE = 0.2  # s between two looks at whether the peer is alive
PIECE = 2**20  # bytes of memory taken at first for a message
GREETING_TIME = 30.0  # s that somebody who connected has to say HELLO


def always() -> bool:
    """A peer that nobody watches."""
    return True


def secret_fits(first: Message, secret: str) -> bool:
    """Whether the first message (HELLO, or ERROR) carries the secret of the run, compared in constant time."""
    given = first.values.get("secret")
    return isinstance(given, str) and hmac.compare_digest(given.encode(), secret.encode())


class SocketConnection:
    """One peer. `limit` [bytes] bounds each message in either direction."""

    def __init__(self, connection: socket.socket, limit: int = ABSOLUTE_LIMIT):
        self._socket = connection
        self.limit = limit

    def send(self, message: Message) -> None:
        """Hand over the whole message."""
        data = encode(message, self.limit)
        self._socket.settimeout(GREETING_TIME)
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
            _check_wait(deadline, alive)
            return 0
        except OSError as error:
            raise ConnectionError(f"connection lost: {error}") from None
        if got == 0:
            raise ConnectionError("the peer closed the connection")
        return got

    def close(self) -> None:
        """Close the connection; a second call does nothing."""
        self._socket.close()


def _check_wait(deadline: float, alive: Callable[[], bool]) -> None:
    if not alive():
        raise ConnectionError("the peer has ended")
    if time.monotonic() >= deadline:
        raise TimeoutError("no message in time")


def _sweep() -> None:
    """Remove the folders of sockets whose owners were killed before the solver had called."""
    for folder in Path(tempfile.gettempdir()).glob("sdph-*-*"):
        owner = folder.name.split("-")[1]
        if owner.isdigit() and folder.stat().st_uid == os.getuid() and not Path("/proc", owner).exists():
            shutil.rmtree(folder, ignore_errors=True)


class SocketServer:
    """Waits for the gas solver. `address` is what the solver is told: "unix:<path>" or "tcp:<host>:<port>"."""

    def __init__(self, secret: str, tcp: bool = False):
        self._secret = secret
        self._folder = None
        if tcp:
            self._socket = socket.create_server(("127.0.0.1", 0), backlog=1)
            self.address = "tcp:{}:{}".format(*self._socket.getsockname())
        else:
            _sweep()
            self._folder = Path(tempfile.mkdtemp(prefix=f"sdph-{os.getpid()}-"))  # made with mode 0700
            self._socket = socket.socket(socket.AF_UNIX)
            self._socket.bind(str(self._folder / "gas"))
            self._socket.listen(1)
            self.address = f"unix:{self._folder / 'gas'}"

    def accept(self, timeout: float, alive: Callable[[], bool] = always, limit: int = ABSOLUTE_LIMIT):
        """(connection, first message) of the first caller who knows the secret; then nobody else can call.

        The message is HELLO, or ERROR when the solver could not start.
        """
        deadline = time.monotonic() + timeout
        while True:
            connection = SocketConnection(self._call(deadline, alive), limit)
            first = self._greeting(connection, deadline, alive)
            if first is not None:
                self.close()
                return connection, first
            connection.close()

    def _call(self, deadline: float, alive: Callable[[], bool]) -> socket.socket:
        while True:
            self._socket.settimeout(SLICE)
            try:
                connection, _ = self._socket.accept()
            except TimeoutError:
                _check_wait(deadline, alive)
                continue
            if connection.family != socket.AF_UNIX:
                connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            return connection

    def _greeting(self, connection: SocketConnection, deadline: float, alive: Callable[[], bool]) -> Message | None:
        """The first message of the solver; None when the caller is a stranger, who is told so."""
        left = deadline - time.monotonic()
        try:
            first = connection.receive(min(left, GREETING_TIME), alive)
            if secret_fits(first, self._secret):
                return first
            connection.send(Message(Kind.ERROR, {"text": "refused: you are not the solver of this run"}))
        except (MessageError, ConnectionError, TimeoutError):
            _check_wait(deadline, alive)
        return None

    def close(self) -> None:
        """Stop listening and remove the folder of the socket; a second call does nothing."""
        self._socket.close()
        if self._folder is not None:
            shutil.rmtree(self._folder, ignore_errors=True)
