"""Compiler and driver of CUDA: the one file that knows the package they are from (numba-cuda).

Without that package numba has a part of the same name, whose simulator runs kernels in Python
(NUMBA_ENABLE_CUDASIM=1): tests of kernels need no device.
"""

from __future__ import annotations

import ctypes
import struct
import types
import warnings

import numba
import numpy as np
from numba import config, cuda

SIMULATED = bool(config.ENABLE_CUDASIM)
WORD = 8  # bytes of whatever a kernel takes but truth values, which take one


def device(function):
    """A function that kernels take in; the simulator calls it as it stands."""
    return function if SIMULATED else cuda.jit(device=True, forceinline=True)(function)


def kernel(function):
    """A kernel, compiled when it is first launched for arguments of these types; kept on disk, unless it is one of
    several of the same text."""
    return cuda.jit(function) if SIMULATED or function.__closure__ else cuda.jit(cache=True)(function)


class Launcher:
    """Launches kernels with their arguments in one buffer, as the driver takes them.

    numba-cuda looks at each of the 500 numbers of a State anew: 0.3 to 1 ms a launch. Here an array remembers its own.
    """

    ROOM = 32764  # bytes of arguments that a kernel may take

    def __init__(self):
        self._known = {}  # function of the driver, by kernel and types of what it takes
        self._room, self._size = ctypes.create_string_buffer(self.ROOM), ctypes.c_size_t()
        buffer, size = ctypes.addressof(self._room), ctypes.addressof(self._size)
        self._extra = (ctypes.c_void_p * 5)(1, buffer, 2, size, 0)  # CU_LAUNCH_PARAM_: buffer, size, end
        if not SIMULATED:
            from cuda.bindings import driver

            self._launch = driver.cuLaunchKernel

    def __call__(self, kernel, size: tuple[int, int], arguments: tuple) -> None:
        if SIMULATED:
            kernel[size](*arguments)
            return
        kinds, words = [kernel], bytearray()
        _pack(arguments, kinds, words)
        kinds = tuple(kinds)
        if kinds not in self._known:
            self._known[kinds] = self._compiled(kernel, arguments)
        self._size.value = len(words)
        ctypes.memmove(self._room, bytes(words), len(words))
        blocks, threads = size
        (failed,) = self._launch(
            self._known[kinds], blocks, 1, 1, threads, 1, 1, 0, 0, 0, ctypes.addressof(self._extra)
        )
        if failed:
            raise RuntimeError(f"the device does not launch {kernel.py_func.__name__}: {failed}")

    @staticmethod
    def _compiled(kernel, arguments: tuple):
        """Function of the driver of a kernel for arguments of these types."""
        found = kernel.compile(tuple(map(kernel.typeof_pyval, arguments)))
        return found._codelibrary.get_cufunc().kernel.handle


def _pack(values: tuple, kinds: list, words: bytearray) -> None:
    """Append the kinds of values, and their bytes as a kernel takes them: each begins at a multiple of its size, which
    is 8 but for truth values."""
    kinds += type(values), len(values)
    for value in values:
        if isinstance(value, tuple):
            _pack(value, kinds, words)
            continue
        if isinstance(value, bool | np.bool_):
            kind, own = bool, struct.pack("<?", value)
        elif lies_there(value):
            kind, own = getattr(value, "words", None) or _of_array(value)
        elif isinstance(value, float):
            kind, own = float, struct.pack("<d", value)
        elif isinstance(value, int | np.int64):
            kind, own = int, struct.pack("<q", value)
        else:
            raise TypeError(f"a kernel takes arrays, float64, int64 and truth values, no {type(value).__name__}")
        if kind is not bool:
            words += bytes(-len(words) % WORD)
        kinds.append(kind)
        words += own


def _of_array(array) -> tuple:
    """Kind of an array, and its bytes: two unused, values and bytes of one, place, shape, strides."""
    kind = array.dtype.str, array.ndim, array.is_c_contiguous()
    numbers = 0, 0, array.size, array.dtype.itemsize, array.device_ctypes_pointer.value or 0
    array.words = kind, struct.pack(f"<{5 + 2 * array.ndim}q", *numbers, *array.shape, *array.strides)
    return array.words


def rint():
    """Function that kernels take for numpy's rint, which CUDA does not know of one number."""
    return np.rint if SIMULATED else cuda.libdevice.rint


def lies_there(array) -> bool:
    """True of an array of a device."""
    return hasattr(array, "copy_to_host")


def strict() -> None:
    """Let a kernel that would copy arrays of the host both ways at every launch fail; that small ones leave most of the
    device idle is meant (sums of sums)."""
    if not SIMULATED:
        from numba.cuda.core.errors import NumbaPerformanceWarning

        warnings.simplefilter("error", NumbaPerformanceWarning)
        warnings.filterwarnings("ignore", ".*under-utilization", NumbaPerformanceWarning)


def assembly(function, taken: tuple, capability: tuple[int, int], *, parts: bool) -> str:
    """PTX of a kernel for arguments of these types, without a device; with `parts` the arguments are one tuple behind
    an array (T, K) of float64, as of sdph.engine.gpu.translation.function_of.

    numba-cuda 0.30 asks for the device that is there as soon as a kernel calls a function: it is told this one.
    """
    own, dispatcher = types.SimpleNamespace(compute_capability=capability), cuda.dispatcher
    given = (numba.float64[:, ::1], numba.types.Tuple(taken)) if parts else taken
    before, dispatcher.get_current_device = dispatcher.get_current_device, lambda: own
    try:
        text, _ = cuda.compile(function, given, device=False, cc=capability, abi="numba", output="ptx")
    finally:
        dispatcher.get_current_device = before
    return text if isinstance(text, str) else text.decode()


def kind_of_arrays() -> type:
    """Class of the arrays of a device."""
    if SIMULATED:
        from numba.cuda.simulator.cudadrv.devicearray import FakeCUDAArray

        return FakeCUDAArray
    from numba.cuda.cudadrv.devicearray import DeviceNDArray

    return DeviceNDArray


def taken_for(kind: type, array):
    """The same array of a device as one of a class that inherits `kind_of_arrays`."""
    if isinstance(array, kind):
        return array
    if SIMULATED:
        return kind(array._ary)
    return kind(array.shape, array.strides, array.dtype, array.stream, array.gpu_data)


def made(kind: type, shape, dtype):
    """A new array of a device of such a class."""
    if SIMULATED:
        return kind(np.empty(shape, dtype))
    shape, dtype = (shape if isinstance(shape, tuple) else (shape,)), np.dtype(dtype)
    strides = [dtype.itemsize]
    for length in reversed(shape[1:]):
        strides.append(strides[-1] * length)
    return kind(shape, tuple(reversed(strides)), dtype)
