"""Both transports: the same messages bit for bit, strangers refused, dead and silent peers noticed."""

import contextlib
import os
import socket
import subprocess
import sys
import tempfile
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from knocking import connected

from coupling.transport import callers, sockets
from coupling.transport.callers import MOST
from coupling.transport.files import FileConnection, FileServer
from coupling.transport.messages import HEADER, MAGIC, VERSION, Kind, Message, MessageError, encode
from coupling.transport.sockets import SocketConnection, SocketServer

SECRET = "a" * 64
RNG = np.random.default_rng(7)
BIG = Message(Kind.ADVANCE, {"dt": 1e-3, "drag": RNG.normal(size=(40000, 3)), "write": 1}, {"dt": "s", "drag": "N/m3"})


def call(address: str) -> SocketConnection:
    """What the gas solver does first."""
    s = connected(address)
    s.settimeout(None)
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


@pytest.mark.parametrize("make", [unix, tcp])
def test_slow_callers_keep_nobody_waiting(make, tmp_path):
    """Some say nothing, some half a greeting, more than are listened to at once; the solver comes last."""
    server, connect = make(tmp_path)
    result = []
    waiting = threading.Thread(target=lambda: result.append(server.accept(60.0)))
    waiting.start()
    slow = [connect(server.address) for _ in range(MOST + 10)]
    for caller in slow[-2 * (MOST // 4) :: 2]:  # the first have been turned away by now
        caller._socket.sendall(encode(hello())[:-1])
    solver = connect(server.address)
    solver.send(hello())
    begin = time.monotonic()
    waiting.join(15.0)
    assert time.monotonic() - begin < 10.0
    ours, _ = result[0]
    solver.send(Message(Kind.DONE))
    assert ours.receive(5.0).kind is Kind.DONE
    for end in (ours, solver, *slow):
        end.close()


@pytest.mark.parametrize("make", [unix, tcp])
def test_who_does_not_tell_the_secret_is_turned_away_in_time(make, tmp_path, monkeypatch):
    monkeypatch.setattr(callers, "GREETING_TIME", 0.5)
    server, connect = make(tmp_path)
    caller = connect(server.address)
    with pytest.raises(TimeoutError):
        server.accept(2.0)
    assert caller.receive(5.0).kind is Kind.ERROR
    with pytest.raises(ConnectionError):
        caller.receive(5.0)
    server.close()


@pytest.mark.parametrize("make", [unix, tcp])
def test_little_is_read_before_the_secret_is_known(make, tmp_path):
    server, connect = make(tmp_path)
    waiting = threading.Thread(target=lambda: _accept(server), daemon=True)
    waiting.start()
    stranger = connect(server.address)
    stranger._socket.settimeout(5.0)
    sent = 0
    with pytest.raises(OSError):  # the door is shut after the header
        stranger._socket.sendall(HEADER.pack(MAGIC, VERSION, Kind.HELLO, 700 * 2**20, 0, 0))
        while sent < 700:
            stranger._socket.sendall(bytes(2**20))
            sent += 1
    assert sent < 16  # MiB, what the system itself holds for a socket
    waiting.join(15.0)
    server.close()


def _accept(server):
    """Wait for a solver that does not come."""
    try:
        server.accept(3.0)
    except TimeoutError:
        return


def test_bytes_that_keep_coming_do_not_put_off_the_deadline():
    ours, theirs = socket.socketpair()
    with ours, theirs:
        theirs.sendall(encode(hello()))
        with pytest.raises(TimeoutError):
            SocketConnection(ours).receive(-1.0)


def test_a_place_for_temporary_files_with_a_long_path_is_no_hindrance(tmp_path, monkeypatch):
    """A Unix socket elsewhere, and TCP where there is no such place."""
    deep = tmp_path / ("d" * 60) / ("e" * 60)
    deep.mkdir(parents=True)
    monkeypatch.setattr(tempfile, "tempdir", str(deep))
    for shared, kind in (("/tmp", "unix:"), (str(deep), "tcp:127.0.0.1:")):
        monkeypatch.setattr(sockets, "SHARED", shared)
        server = SocketServer(SECRET)
        assert server.address.startswith(kind)
        peer = call(server.address)
        peer.send(hello())
        ours, _ = server.accept(5.0)
        for end in (ours, peer, server):
            end.close()
        assert not list(deep.iterdir())


def test_socket_lies_in_a_private_folder_that_goes_away():
    server = SocketServer(SECRET)
    folder = Path(server.address.removeprefix("unix:")).parent
    assert folder.stat().st_mode & 0o777 == 0o700
    server.close()
    assert not folder.exists()


def test_nothing_of_an_exchange_stays(tmp_path):
    with contextlib.closing(FileServer.inside(SECRET, tmp_path)) as server:  # nobody comes
        assert len(list(tmp_path.iterdir())) == 1
        with pytest.raises(TimeoutError):
            server.accept(0.1)
    assert not list(tmp_path.iterdir())
    server = FileServer.inside(SECRET, tmp_path)
    FileConnection(Path(server.address.removeprefix("file:")), "to_sdph", "to_gas").send(hello())
    ours, _ = server.accept(5.0)
    server.close()
    ours.send(BIG)
    ours.close()
    assert not list(tmp_path.iterdir())


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


@pytest.mark.parametrize("tcp", [False, True])
def test_a_gas_that_takes_its_time_to_call_is_waited_for(tcp):
    with contextlib.closing(SocketServer(SECRET, tcp)) as server, ThreadPoolExecutor(1) as other:
        waited = other.submit(server.accept, 20.0)
        time.sleep(0.3)
        assert not waited.done()
        peer = call(server.address)
        peer.send(hello())
        ours, _ = waited.result(20.0)
        for end in (ours, peer):
            end.close()
