"""Compiler and driver of CUDA: the one file that knows the package they are from (numba-cuda).

Without that package numba has a part of the same name, whose simulator runs kernels in Python
(NUMBA_ENABLE_CUDASIM=1): tests of kernels need no device.
"""

from __future__ import annotations

import warnings

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
    """What kernels take for numpy's rint, which CUDA does not know of one number."""
    return np.rint if SIMULATED else cuda.libdevice.rint


def lies_there(array) -> bool:
    """True of an array of a device."""
    return hasattr(array, "copy_to_host")


def strict() -> None:
    """Let a kernel that would copy arrays of the host both ways at every launch fail."""
    if not SIMULATED:
        from numba.cuda.core.errors import NumbaPerformanceWarning

        warnings.simplefilter("error", NumbaPerformanceWarning)
