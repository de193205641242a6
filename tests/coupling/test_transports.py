"""Both transports: the same messages bit for bit, strangers refused, dead and silent peers noticed."""

import os
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

from coupling.files import FileConnection, FileServer
from coupling.messages import HEADER, Kind, Message, MessageError, encode
from coupling.sockets import SocketConnection, SocketServer

SECRET = "a" * 64
RNG = np.random.default_rng(7)
BIG = Message(Kind.ADVANCE, {"dt": 1e-3, "drag": RNG.normal(size=(40000, 3)), "write": 1}, {"dt": "s", "drag": "N/m3"})


def call(address: str) -> SocketConnection:
    """What the gas solver does first."""
    if address.startswith("unix:"):
        s = socket.socket(socket.AF_UNIX)
        s.connect(address.removeprefix("unix:"))
    else:
        _, host, port = address.split(":")
        s = socket.create_connection((host, int(port)))
    return SocketConnection(s)


def hello(secret=SECRET):
    return Message(Kind.HELLO, {"secret": secret, "cells": 3})


def unix(tmp_path):
    return SocketServer(SECRET), call


def tcp(tmp_path):
    return SocketServer(SECRET, tcp=True), call


def files(tmp_path):
    return FileServer(SECRET, tmp_path / "exchange"), lambda address: FileConnection(
        Path(address.removeprefix("file:")), outgoing="to_sdph", incoming="to_gas"
    )


@pytest.fixture(params=[unix, tcp, files], ids=["unix", "tcp", "files"])
def pair(request, tmp_path):
    """(our end, the gas solver's end) of a connection."""
    server, connect = request.param(tmp_path)
    peer = connect(server.address)
    peer.send(hello())
    ours, first = server.accept(5.0)
    assert first["secret"] == SECRET
    yield ours, peer
    for end in (ours, peer, server):
        end.close()


def test_messages_pass_unchanged_both_ways(pair):
    ours, peer = pair
    sender = threading.Thread(target=ours.send, args=(BIG,))
    sender.start()
    received = peer.receive(10.0)
    sender.join()
    assert encode(received) == encode(BIG)
    peer.send(Message(Kind.STATE, {"time": 0.1 + 0.2}, {"time": "s"}))
    peer.send(Message(Kind.DONE))
    assert ours.receive(5.0)["time"] == 0.1 + 0.2
    assert ours.receive(5.0).kind is Kind.DONE


def test_a_silent_peer_times_out(pair):
    ours, _ = pair
    begin = time.monotonic()
    with pytest.raises(TimeoutError):
        ours.receive(0.3)
    assert 0.25 < time.monotonic() - begin < 2.0


def test_a_dead_peer_is_noticed_within_a_second(pair):
    ours, _ = pair
    process = subprocess.Popen([sys.executable, "-c", "pass"])
    process.wait()
    begin = time.monotonic()
    with pytest.raises(ConnectionError):
        ours.receive(60.0, lambda: process.poll() is None)
    assert time.monotonic() - begin < 1.0


def test_too_long_a_message_is_refused_unread(pair):
    ours, peer = pair
    ours.limit = 1000
    threading.Thread(target=_try, args=(peer,), daemon=True).start()
    with pytest.raises(MessageError, match="at most"):
        ours.receive(5.0)
    with pytest.raises(MessageError, match="at most"):
        ours.send(BIG)


def _try(peer):
    """Send what nobody will read to its end."""
    try:
        peer.send(BIG)
    except ConnectionError:
        return


@pytest.mark.parametrize("make", [unix, tcp])
def test_strangers_are_turned_away_and_the_solver_still_gets_in(make, tmp_path):
    server, connect = make(tmp_path)
    stranger, babbler = connect(server.address), connect(server.address)
    stranger.send(hello("b" * 64))
    babbler._socket.sendall(b"GET / HTTP/1.0\r\n\r\n" + bytes(HEADER.size))
    result = []
    waiting = threading.Thread(target=lambda: result.append(server.accept(10.0)))
    waiting.start()
    assert stranger.receive(5.0).kind is Kind.ERROR
    solver = connect(server.address)
    solver.send(hello())
    waiting.join(10.0)
    ours, first = result[0]
    assert first.kind is Kind.HELLO
    with pytest.raises(OSError):
        connect(server.address)  # nobody else can call any more
    for end in (ours, stranger, babbler, solver):
        end.close()


def test_socket_lies_in_a_private_folder_that_goes_away():
    server = SocketServer(SECRET)
    folder = Path(server.address.removeprefix("unix:")).parent
    assert folder.stat().st_mode & 0o777 == 0o700
    server.close()
    assert not folder.exists()


def test_file_exchange_refuses_a_used_folder_and_a_wrong_secret(tmp_path):
    (tmp_path / "used" / "to_gas").mkdir(parents=True)
    with pytest.raises(FileExistsError, match="in use"):
        FileServer(SECRET, tmp_path / "used")
    server, connect = files(tmp_path)
    connect(server.address).send(hello("b" * 64))
    with pytest.raises(ConnectionError, match="secret is wrong"):
        server.accept(5.0)


def test_a_file_is_never_seen_half_written(tmp_path):
    """The reader looks for the final name only; the draft has another."""
    server, connect = files(tmp_path)
    peer = connect(server.address)
    draft = tmp_path / "exchange" / "to_sdph" / "draft"
    draft.write_bytes(encode(hello())[:20])
    with pytest.raises(TimeoutError):
        server.accept(0.2)
    peer.send(hello())
    assert server.accept(5.0)[1].kind is Kind.HELLO
    assert not os.listdir(tmp_path / "exchange" / "to_sdph")
