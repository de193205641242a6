"""Devices of this machine, told without making use of one."""

from __future__ import annotations

import importlib.util

from numba import config

GET = "pip install 'sdph[cuda]'"


def missing() -> str | None:
    """Tell what lacks to run on a device, and what to do; None where nothing does."""
    if config.ENABLE_CUDASIM:
        return None
    if importlib.util.find_spec("numba_cuda") is None:
        return f"numba-cuda is not installed: {GET}"
    from sdph.engine.gpu.toolkit import cuda

    if not cuda.is_available():
        return f"there is no CUDA device here ({_why(cuda)}): take a machine with one and NVIDIA's driver"
    return None


def _why(cuda) -> str:
    """Reason that the driver gives."""
    try:
        return f"{len(cuda.gpus)} devices"
    except Exception as error:  # whatever loading a driver stumbles on
        return str(error).strip().splitlines()[-1] if str(error).strip() else type(error).__name__


def described() -> str:
    """Name, compute capability, memory and driver of the device, or why there is none."""
    if lacking := missing():
        return f"none: {lacking}"
    from sdph.engine.gpu.toolkit import SIMULATED, cuda

    if SIMULATED:
        return "the simulator of numba (NUMBA_ENABLE_CUDASIM), in Python"
    device = cuda.get_current_device()
    name = device.name.decode() if isinstance(device.name, bytes) else device.name
    free, whole = cuda.current_context().get_memory_info()
    major, minor = device.compute_capability
    driver = ".".join(map(str, cuda.cudadrv.driver.driver.get_version()))
    memory = f"{free / 1e9:.1f} of {whole / 1e9:.1f} GB free"
    return f"{name}, compute capability {major}.{minor}, {memory}, driver for CUDA {driver}"
