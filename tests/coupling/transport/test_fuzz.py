"""Ten thousand messages (more with SDPH_FUZZ) that were harmed on purpose, to each side: every one is read or refused,
in bounded time and memory."""

import contextlib
import dataclasses
import os
import socket
import struct
import subprocess
import threading
import time
import tracemalloc
import zlib

import numpy as np
import pytest
from fuzzing import FACTOR, SEED
from knocking import connected

from coupling.gas import IMPULSES, Budget
from coupling.openfoam import told
from coupling.transport.files import FileConnection
from coupling.transport.messages import GREETING_LIMIT, HEADER, MAGIC, VERSION, Kind, Message, MessageError, encode
from coupling.transport.sockets import SocketConnection, SocketServer

COUNT = 10_000 * FACTOR
LIMIT = 2**16  # bytes of a message
WHOLE = [
    Message(Kind.ADVANCE, {"dt": 1e-3, "write": 1, "drag": np.arange(24.0).reshape(8, 3)}, {"dt": "s"}),
    Message(Kind.STATE, {"time": 0.5, "temperature": np.full(8, 300.0), "budget_momentum": np.zeros(3)}, {"time": "s"}),
    Message(Kind.HELLO, {"secret": "a" * 64, "dimensions": 2, "centres": np.ones((8, 3)), "solver": "gas"}),
    Message(Kind.ERROR, {"text": "it blew up"}),
    Message(Kind.CHECKPOINT, {"folder": "/nowhere"}),
    Message(Kind.CLOSE),
]
LENGTHS = (0, 1, 2**16 - 1, 2**31, 2**32 - 1, 2**40, 2**63, 2**64 - 1)


def flipped(rng, data):
    place = rng.integers(len(data))
    return data[:place] + bytes([data[place] ^ int(rng.integers(1, 256))]) + data[place + 1 :]


def truncated(rng, data):
    return data[: rng.integers(len(data))]


def longer(rng, data):
    return data + rng.bytes(int(rng.integers(1, 40)))


def other_length(rng, data):
    return data[:8] + struct.pack("<Q", LENGTHS[rng.integers(len(LENGTHS))]) + data[16:]


def garbage(rng, data):
    return rng.bytes(int(rng.integers(0, 200)))


def other_body(rng, data):
    """Harm that the checksum does not show: it reaches the reader of the fields."""
    body = bytearray(data[HEADER.size :])
    for _ in range(int(rng.integers(1, 4))):
        if rng.random() < 0.5:
            body[rng.integers(len(body))] = int(rng.integers(256))
        else:
            place = int(rng.integers(max(1, len(body) - 3)))
            body[place : place + 4] = struct.pack("<I", LENGTHS[rng.integers(5)] & 0xFFFFFFFF)
    if rng.random() < 0.3:
        body = body[: rng.integers(len(body) + 1)]
    return HEADER.pack(MAGIC, VERSION, data[6], len(body), zlib.crc32(body), 0) + bytes(body)


def other_shape(rng, data):
    """A body of one field without data, whose extents are 0 and beyond all bounds."""
    extents = [(0, 1, 3, 2**16, 2**31, 2**32 - 1)[k] for k in rng.integers(6, size=rng.integers(5))]
    head = (
        struct.pack("<IB1sB", 1, 1, b"T", 0)
        + struct.pack("<BB", rng.integers(3), len(extents))
        + struct.pack(f"<{len(extents)}I", *extents)
    )
    body = head + bytes(-len(head) % 8) + bytes(8 * int(rng.integers(3)))
    return HEADER.pack(MAGIC, VERSION, data[6], len(body), zlib.crc32(body), 0) + body


HARMS = (flipped, truncated, longer, other_length, garbage, other_shape, other_body, other_body, other_body)


def harmed(count, seed=11):
    """(count) messages in bytes."""
    rng = np.random.default_rng(seed + SEED)
    whole = [encode(message) for message in WHOLE]
    return [HARMS[rng.integers(len(HARMS))](rng, whole[rng.integers(len(whole))]) for _ in range(count)]


def test_the_particles_read_or_refuse_each(tmp_path):
    read = refused = 0
    tracemalloc.start()
    for data in harmed(COUNT):
        ours, theirs = socket.socketpair()
        with ours, theirs:
            theirs.sendall(data)
            theirs.shutdown(socket.SHUT_WR)
            try:
                SocketConnection(ours, LIMIT).receive(5.0)
                read += 1
            except (MessageError, ConnectionError):
                refused += 1
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert read + refused == COUNT
    assert refused > 0.7 * COUNT and read > 100  # what follows a whole message is the next one's matter
    assert peak < 8 * 2**20


def test_files_are_read_or_refused_each(tmp_path):
    for number, data in enumerate(harmed(1000 * FACTOR, 12)):
        connection = FileConnection(tmp_path / str(number), limit=LIMIT)
        (tmp_path / str(number) / "to_sdph" / "0").write_bytes(data)
        with contextlib.suppress(MessageError, ConnectionError):
            connection.receive(5.0)


@pytest.mark.parametrize(
    "make",
    [os.mkfifo, os.mkdir, lambda path: os.symlink("/dev/zero", path), lambda path: os.symlink("/etc/hostname", path)],
)
def test_what_is_no_plain_file_is_refused(tmp_path, make):
    connection = FileConnection(tmp_path, limit=LIMIT)
    make(tmp_path / "to_sdph" / "0")
    with pytest.raises(MessageError, match="message 0"):
        connection.receive(5.0)


def test_a_large_file_is_refused_unread(tmp_path):
    connection = FileConnection(tmp_path, limit=LIMIT)
    with open(tmp_path / "to_sdph" / "0", "wb") as file:
        file.truncate(2**40)
    with pytest.raises(MessageError, match="at most"):
        connection.receive(5.0)


@pytest.mark.parametrize("tcp", [False, True], ids=["unix", "tcp"])
def test_whatever_calls_the_solver_gets_in(tcp):
    """Harmed first messages at the door, all at once and left open; none gets more than the few bytes of a greeting."""
    server, callers = SocketServer("b" * 64, tcp), []
    result, waiting = run_in_background(lambda: server.accept(30.0))
    for data in harmed(200 * FACTOR, 14):
        caller = connected(server.address)
        callers.append(caller)
        try:
            caller.sendall(data)
        except OSError:  # turned away in the middle of it
            continue
    solver = connected(server.address)
    solver.sendall(encode(Message(Kind.HELLO, {"secret": "b" * 64})))
    waiting.join(15.0)
    ours, first = result[0]
    assert first.kind is Kind.HELLO
    for end in (ours, solver, *callers):
        end.close()


def run_in_background(function):
    result = []
    thread = threading.Thread(target=lambda: result.append(function()), daemon=True)
    thread.start()
    return result, thread


def test_what_has_the_form_of_a_message_but_not_its_content_is_refused():
    """States and meshes of which fields are missing, or are of another type or shape."""
    rng, cells = np.random.default_rng(15 + SEED), 4
    vectors, scalars = ("velocity", "pressure_gradient"), ("pressure", "temperature", "density", "power")
    of_budget = {"momentum", *IMPULSES}
    numbers = {field.name for field in dataclasses.fields(Budget)} - of_budget - {"residuals", "held"}
    budget = {f"budget_{name}": 1.0 for name in sorted(numbers)}
    state = {"time": 1.0, "residual_T": 1e-9} | {f"budget_{name}": np.zeros(3) for name in sorted(of_budget)} | budget
    state |= {name: np.ones((cells, 3)) for name in vectors} | {name: np.ones(cells) for name in scalars}
    mesh = {"centres": np.ones((cells, 3)), "volumes": np.ones(cells), "dimensions": 2, "depth": 1.0}
    others = (
        "text",
        "",
        7,
        2.5,
        np.zeros(0),
        np.zeros((cells, 2)),
        np.zeros((3, cells)),
        np.zeros((1, 1, 1)),
        np.zeros(cells, int),
    )
    told.state(Message(Kind.STATE, state), cells, False)
    told.mesh(Message(Kind.MESH, mesh))
    for read, whole in ((lambda m: told.state(m, cells, False), state), (told.mesh, mesh)):
        for _ in range(300 * FACTOR):
            values, name = dict(whole), list(whole)[rng.integers(len(whole))]
            values[name] = others[rng.integers(len(others))]
            if rng.random() < 0.3:
                del values[name]
            try:
                read(Message(Kind.STATE, values))
            except MessageError as error:
                assert "\n" not in str(error)


def test_the_first_message_is_short():
    with pytest.raises(MessageError, match="at most"):
        encode(WHOLE[2], 64)
    assert len(encode(Message(Kind.HELLO, {"secret": "a" * 64}))) < GREETING_LIMIT


def test_a_promise_of_much_takes_no_memory():
    ours, theirs = socket.socketpair()
    with ours, theirs:
        theirs.sendall(HEADER.pack(MAGIC, VERSION, Kind.HELLO, 2**31, 0, 0) + b"x" * 1000)
        tracemalloc.start()
        begun = time.monotonic()
        with pytest.raises(TimeoutError):
            SocketConnection(ours).receive(0.5)
        assert time.monotonic() - begun < 2.0
        assert tracemalloc.get_traced_memory()[1] < 4 * 2**20
        tracemalloc.stop()


@pytest.mark.openfoam
def test_the_gas_reads_or_refuses_each(tmp_path):
    """The C++ reader of the wire format under the sanitizers of memory and of undefined behaviour."""
    from coupling.openfoam.programs import install

    (tmp_path / "fuzz.C").write_text("""
        #include "wire.H"
        #include <iostream>
        int main()
        {
            uint32_t length, read = 0, refused = 0;
            while (std::cin.read(reinterpret_cast<char*>(&length), 4))
            {
                std::string data(length, 0);
                std::cin.read(&data[0], length);
                try
                {
                    const wire::Message message = wire::decode(data, 65536);
                    if (wire::encode(message).size() < wire::headerSize) return 2;
                    ++read;
                }
                catch (const wire::Error&) { ++refused; }
            }
            std::cout << read << " " << refused;
        }
    """)
    sanitize = ["-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-g"]
    command = ["g++", "-std=c++14", "-O1", *sanitize, f"-I{install.GAS_SOLVER}", "fuzz.C", "-o", "fuzz"]
    subprocess.run(command, cwd=tmp_path, check=True)
    data = b"".join(struct.pack("<I", len(one)) + one for one in harmed(COUNT, 13))
    done = subprocess.run([tmp_path / "fuzz"], input=data, capture_output=True, timeout=120)
    assert done.returncode == 0, done.stderr[-2000:]
    read, refused = map(int, done.stdout.split())
    assert read + refused == COUNT
    assert refused > 0.7 * COUNT


@pytest.mark.openfoam
@pytest.mark.parametrize("number", range(6))
def test_the_solver_itself_ends_with_a_word(tmp_path, number):
    """A harmed message to sdphGasFoam while it runs: it ends by itself and in time, whatever it got."""
    import sys
    from pathlib import Path

    sys.path.insert(0, str(Path(__file__).parents[1] / "openfoam"))
    from gas_boxes import box

    rng = np.random.default_rng(number)
    with box(tmp_path, (0.1, 0.06), 0.01) as gas:
        gas.start(None, ())
        data = (flipped, garbage, other_length, other_body, truncated, other_body)[number](
            rng, encode(WHOLE[0])
        ) or b"?"
        gas._connection._socket.sendall(data)
        gas._connection._socket.shutdown(socket.SHUT_WR)
        gas._process.wait(10.0)
        assert "sdphGasFoam:" in (tmp_path / "gas" / "log.sdphGasFoam").read_text()
