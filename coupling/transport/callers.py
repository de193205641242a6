"""Callers at the door: whoever connects has a short time and few bytes to tell the secret of the run; nobody waits for
another."""

from __future__ import annotations

import contextlib
import selectors
import socket
import time
from collections.abc import Callable

from coupling.transport.messages import (
    GREETING_LIMIT,
    HEADER,
    Kind,
    Message,
    MessageError,
    decode,
    encode,
    read_header,
    secret_fits,
)
from coupling.transport.waiting import SLICE, always, check_wait

GREETING_TIME = 5.0  # s that a caller has to tell the secret, which the solver does at once; our choice
MOST = 64  # callers that are listened to at once; the oldest has to go for the next. Our choice
REFUSAL = encode(Message(Kind.ERROR, {"text": "refused: you are not the solver of this run"}))


class _Caller:
    """Somebody who has connected and not yet said who he is."""

    def __init__(self, connection: socket.socket):
        connection.setblocking(False)
        self.socket, self.deadline, self.data = connection, time.monotonic() + GREETING_TIME, b""

    def hear(self) -> Message | None:
        """Read some more of his first message, and not beyond; the message once it is whole."""
        piece = self.socket.recv(self._missing())
        if not piece:
            raise ConnectionError("the caller has hung up")
        self.data += piece
        return None if self._missing() else decode(self.data, GREETING_LIMIT)

    def _missing(self) -> int:
        """Bytes up to the end of the header, or of the message whose header is there."""
        body = read_header(self.data[: HEADER.size], GREETING_LIMIT)[1] if len(self.data) >= HEADER.size else 0
        return HEADER.size + body - len(self.data)


class Callers:
    """All who call at a listening socket."""

    def __init__(self, listening: socket.socket, secret: str):
        listening.setblocking(False)
        self._listening, self._secret, self._waiting = listening, secret, []  # the oldest first
        self._selector = selectors.DefaultSelector()
        self._selector.register(listening, selectors.EVENT_READ)

    def find(self, deadline: float, alive: Callable[[], bool]) -> tuple[socket.socket, Message]:
        """The first who knows the secret, and his message."""
        while True:
            ready = self._selector.select(SLICE)
            for key, _ in ready:
                first = self._hear(key.data) if key.data else self._let_in()
                if first:
                    self._forget(key.data)
                    return key.data.socket, first
            self._turn_away_late()
            check_wait(deadline, always if ready else alive)  # one that has ended may still be heard

    def close(self) -> None:
        """Turn away all who are left."""
        for caller in list(self._waiting):
            self._turn_away(caller)
        self._selector.close()

    def _let_in(self) -> None:
        with contextlib.suppress(OSError):  # he has gone again
            caller = _Caller(self._listening.accept()[0])
            self._waiting.append(caller)
            self._selector.register(caller.socket, selectors.EVENT_READ, caller)
        if len(self._waiting) > MOST:
            self._turn_away(self._waiting[0])

    def _hear(self, caller: _Caller) -> Message | None:
        """His first message where it has the secret; who says anything else is turned away."""
        if caller not in self._waiting:  # turned away since he was found ready
            return None
        try:
            first = caller.hear()
        except BlockingIOError:
            return None
        except (MessageError, OSError):
            self._turn_away(caller)
            return None
        if first and not secret_fits(first, self._secret):
            self._turn_away(caller)
            return None
        return first

    def _turn_away_late(self) -> None:
        for caller in [c for c in self._waiting if time.monotonic() >= c.deadline]:
            self._turn_away(caller)

    def _turn_away(self, caller: _Caller) -> None:
        with contextlib.suppress(OSError):  # he does not listen
            caller.socket.send(REFUSAL)
        self._forget(caller)
        caller.socket.close()

    def _forget(self, caller: _Caller) -> None:
        self._waiting.remove(caller)
        self._selector.unregister(caller.socket)
