"""Kernels compiled for a device that need not be there: registers, spills and occupancy, from NVIDIA's assembler.

Needs numba-cuda and the wheel nvidia-cuda-nvcc, which are no part of what a run asks for.
"""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

from numba import typeof

from sdph.engine.gpu.card import LOOP
from sdph.engine.gpu.toolkit import assembly
from sdph.engine.gpu.translation import function_of, results
from sdph.engine.rows import Abreast, Rows
from sdph.laws.compiled import Loop

CAPABILITY = (9, 0)  # of an H100 or H200
REGISTERS, THREADS, GRAIN, WARP = 65536, 2048, 8, 32  # of a multiprocessor of these; registers come by 8 a thread
COUNTED = {
    "registers": r"Used (\d+) registers",
    "stack": r"(\d+) bytes stack frame",
    "stored": r"(\d+) bytes spill stores",
    "loaded": r"(\d+) bytes spill loads",
}


class Assembled(NamedTuple):
    """Kernel of a loop: registers of a thread, bytes of its stack and of what spills, calls that were not taken in,
    bytes of arguments, threads of a multiprocessor over the most, and the text in PTX."""

    registers: int
    stack: int
    spills: int
    calls: int
    arguments: int
    occupancy: float
    text: str

    def told(self) -> tuple:
        """Registers, spills, calls, arguments, occupancy."""
        return self.registers, self.spills, self.calls, self.arguments, self.occupancy


class Heard:
    """Loops that were called, with the types of what they took: `loops` {(loop, types)}. Within its context those over
    pairs are not run, and return zeros: it takes long to compile them, and nobody asks what they compute."""

    def __init__(self):
        self.loops = {}

    def __enter__(self):
        Loop.elsewhere = self.hear
        return self

    def __exit__(self, *error) -> None:
        Loop.elsewhere = None

    def note(self, loop, arguments) -> None:
        """Note a call, with rows as they are on a device."""
        there = (Abreast(*own) if isinstance(own, Rows) else own for own in arguments)
        self.loops[loop, tuple(map(typeof, there))] = None

    def hear(self, loop, arguments):
        """Note a call, and run it unless it is over pairs."""
        self.note(loop, arguments)
        many = results(loop)
        if not any(hasattr(own, "entries") for own in arguments):  # rows, of walls too
            return loop.here(*arguments)
        return None if not many else 0.0 if many == 1 else (0.0,) * many


def name_of(loop) -> str:
    """Name of a loop, with its module's."""
    return f"{loop.py_func.__module__.removeprefix('sdph.')}.{loop.py_func.__name__}"


def assembled(loop, taken: tuple) -> Assembled:
    """The kernel of a loop for arguments of the types `taken`."""
    return read(assembly(function_of(loop), taken, CAPABILITY, parts=bool(results(loop))))


def assembler() -> str | None:
    """Path of ptxas from the wheel nvidia-cuda-nvcc; None where it is not installed."""
    known = (Path(folder) / "nvidia/cu13/bin/ptxas" for folder in sys.path)
    return next((str(file) for file in known if file.is_file()), None)


def read(text: str) -> Assembled:
    """Find out from the assembler what a kernel in PTX takes."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "kernel.ptx"
        file.write_text(text, encoding="ascii")
        target = f"-arch=sm_{CAPABILITY[0]}{CAPABILITY[1]}"
        command = [assembler(), target, "-v", str(file), "-o", f"{folder}/kernel.cubin"]
        told = subprocess.run(command, capture_output=True, text=True, check=True)
    found = {name: max(map(int, re.findall(form, told.stdout + told.stderr))) for name, form in COUNTED.items()}
    return Assembled(
        found["registers"], found["stack"], found["stored"] + found["loaded"], len(re.findall(r"\bcall\b", text)),
        _arguments(text), occupancy(found["registers"], LOOP[1]), text,
    )  # fmt: skip


def _arguments(text: str) -> int:
    """Bytes of the arguments of the kernel in a text."""
    head = text[text.index(".entry") :]
    parts = re.findall(r"\.param (?:\.align \d+ )?\.[a-z](\d+) \w+(?:\[(\d+)\])?", head[: head.index("{")])
    return sum(int(bits) // 8 * int(many or 1) for bits, many in parts)


def occupancy(registers: int, block: int) -> float:
    """Threads that a multiprocessor holds at once, of its most, in blocks of so many."""
    each = -(-registers // GRAIN) * GRAIN * WARP  # of a warp
    warps = REGISTERS // each
    return min(warps // (block // WARP) * block, THREADS) / THREADS
