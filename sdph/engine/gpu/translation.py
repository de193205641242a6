"""Kernels of a device from the loops over particles as they stand: one text, compiled twice.

A kernel is the loop's own function with other globals: `prange(n)` is what one thread of many does of n rounds, and
functions that it calls are taken over in the same way, without the flags of fast arithmetic. No equation is written
again.
"""

from __future__ import annotations

import ast
import dis
import functools
import inspect
import textwrap
import types

import numpy as np
from numba import prange
from numba.core.registry import CPUDispatcher

from sdph.engine.gpu.toolkit import cuda, device, kernel, rint

OURS = ("sdph", "coupling", "numpy")  # packages whose modules are looked into


def _strided(many):
    """Rounds of one thread."""
    return range(cuda.grid(1), many, cuda.gridsize(1))


class _Module(types.ModuleType):
    """A module, whose functions are those that kernels take."""

    def __init__(self, own):
        super().__init__(own.__name__)
        self.__own = own

    def __getattr__(self, name: str):
        return _taken_over(getattr(self.__own, name))


@functools.cache
def _module(own) -> _Module:
    return _Module(own)


@functools.cache
def of_device(dispatcher):
    """Function of a device of one that loops call."""
    return device(copied(dispatcher.py_func))


def _taken_over(value):
    """Value that a kernel takes in place of a global one of a loop."""
    if value is np.rint:
        return rint()
    if isinstance(value, CPUDispatcher):
        return of_device(value)
    if isinstance(value, types.ModuleType) and value.__name__.split(".")[0] in OURS:
        return _module(value)
    return value


def copied(function):
    """The function with globals of its own, in which `prange` and what it calls are those of a device."""
    named = {step.argval for step in dis.get_instructions(function) if step.opname == "LOAD_GLOBAL"}
    around = dict(function.__globals__)
    around |= {name: _taken_over(around[name]) for name in named if name in around}
    around["cuda"] = cuda
    for name, value in around.items():
        if value is prange:  # it knows threads by the kernel's own `cuda`, which the simulator puts another in place of
            around[name] = device(types.FunctionType(_strided.__code__, around))
    cells = tuple(types.CellType(_taken_over(cell.cell_contents)) for cell in function.__closure__ or ())
    twin = types.FunctionType(function.__code__, around, function.__name__, function.__defaults__, cells or None)
    twin.__module__, twin.__qualname__ = function.__module__, function.__qualname__
    return twin


@functools.cache
def results(loop) -> int:
    """Number of the values that a loop returns, of which each thread has a part: 0 where it writes into arrays."""
    tree = ast.parse(textwrap.dedent(inspect.getsource(loop.py_func)))
    found = [node.value for node in ast.walk(tree) if isinstance(node, ast.Return) and node.value]
    return 0 if not found else len(found[0].elts) if isinstance(found[0], ast.Tuple) else 1


def _one(part, arguments):
    part[cuda.grid(1), 0] = loop__(*arguments)  # noqa: F821 - a global that `function_of` gives


def _several(part, arguments):
    found = loop__(*arguments)  # noqa: F821
    for c in range(many__):  # noqa: F821
        part[cuda.grid(1), c] = found[c]


def function_of(loop):
    """Function of a loop as `cuda.jit` takes it: of one that returns values, of (part, arguments), where `part` (T, K)
    is for what each of T threads finds."""
    own = copied(loop.py_func)
    if not (many := results(loop)):
        return own
    around = own.__globals__  # one for both, see `copied`
    around["loop__"], around["many__"] = device(own), many
    whole = types.FunctionType((_one if many == 1 else _several).__code__, around, f"{own.__name__}_parts")
    whole.__qualname__ = f"{own.__module__}.{own.__qualname__}_parts"  # by it the disk knows a kernel: no two have one
    return whole


@functools.cache
def kernel_of(loop):
    """Kernel of a loop."""
    return kernel(function_of(loop))
