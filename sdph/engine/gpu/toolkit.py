"""Compiler and driver of CUDA: the one file that knows the package they are from (numba-cuda).

Without that package numba has a part of the same name, whose simulator runs kernels in Python
(NUMBA_ENABLE_CUDASIM=1): tests of kernels need no device.
"""

from __future__ import annotations

import types
import warnings

import numba
import numpy as np
from numba import config, cuda

SIMULATED = bool(config.ENABLE_CUDASIM)


def device(function):
    """A function that kernels call; the simulator calls it as it stands."""
    return function if SIMULATED else cuda.jit(device=True)(function)


def kernel(function):
    """A kernel, compiled when it is first launched for arguments of these types."""
    return cuda.jit(function)


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
