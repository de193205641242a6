"""Wire format: C++ and Python mean the same by it."""

import subprocess

import numpy as np
import pytest

from coupling.openfoam.programs import install
from coupling.transport.messages import Kind, Message, decode, encode


@pytest.fixture(scope="module")
def wire_echo(tmp_path_factory):
    """The C++ side of the wire format alone: reads a message, writes it again."""
    folder = tmp_path_factory.mktemp("wire")
    (folder / "echo.C").write_text("""
        #include "wire.H"
        #include <iostream>
        #include <iterator>
        int main()
        {
            const std::string in((std::istreambuf_iterator<char>(std::cin)), std::istreambuf_iterator<char>());
            try
            {
                std::cout << wire::encode(wire::decode(in, wire::absoluteLimit));
                return 0;
            }
            catch (const wire::Error& error) { std::cerr << error.what(); return 3; }
        }
    """)
    program = folder / "echo"
    flags = ["-std=c++14", "-O1", "-Wall", "-Werror", f"-I{install.GAS_SOLVER}"]
    subprocess.run(["g++", *flags, str(folder / "echo.C"), "-o", str(program)], check=True)
    return lambda data: subprocess.run([program], input=data, capture_output=True)


def test_both_languages_mean_the_same_format(wire_echo):
    message = Message(
        Kind.STATE,
        {
            "a": np.arange(12.0).reshape(4, 3),
            "b": 7,
            "c": "wärme",
            "d": np.float64(0.1),
            "e": np.zeros((0, 3)),
            "f": "",
        },
        {"a": "m/s"},
    )
    echoed = decode(wire_echo(encode(message)).stdout)
    assert encode(echoed) == encode(message)
    rng = np.random.default_rng(3)
    data = encode(message)
    for _ in range(200):
        damaged = bytearray(data)
        damaged[rng.integers(len(data))] ^= int(rng.integers(1, 256))
        done = wire_echo(bytes(damaged[: rng.integers(len(data) + 1)] if rng.random() < 0.5 else damaged))
        assert done.returncode in (0, 3)
        if done.returncode == 0:
            assert done.stdout[6:8] != data[6:8]  # only the kind lies outside the checksum


def test_the_last_word_of_a_header_is_named_by_cpp_too(wire_echo):
    data = encode(Message(Kind.DONE))
    done = wire_echo(data[:20] + b"\x07\0\0\0" + data[24:])
    assert done.returncode == 3 and b"the last word of its header is 7; one of sdph has 0" in done.stderr
