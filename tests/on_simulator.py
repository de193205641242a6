"""`python on_simulator.py ARGUMENTS`: sdph with those arguments, its CUDA device simulated by numba.

An array of a real device knows no operators and few of numpy's attributes, where the simulator's knows all: those are
taken away here, so that what would not run on a device does not run here either.
"""

import os
import shutil
import subprocess
import sys
import threading

import numpy as np

OPERATORS = ("eq", "ne", "lt", "le", "gt", "ge", "add", "sub", "mul", "floordiv", "truediv", "mod", "pow")
KNOWN = {"dtype", "size", "ndim", "strides", "flags", "squeeze"}  # of numba.cuda's DeviceNDArray


def make_strict() -> None:
    """Take away from simulated arrays what those of a device lack."""
    from numba.cuda.simulator.cudadrv.devicearray import FakeCUDAArray
    from numba.cuda.simulator.kernel import BlockManager

    BlockManager.run = _one_after_another
    for name in OPERATORS:
        delattr(FakeCUDAArray, f"__{name}__")
    FakeCUDAArray.__hash__ = object.__hash__
    FakeCUDAArray.__getattr__ = _known


class _InKernel(np.ndarray):
    """An array as a kernel has it: of single values, rows of them and its shape."""

    __array_ufunc__ = None


for _name in (*OPERATORS, *(f"{way}{name}" for way in "ir" for name in OPERATORS[6:])):
    setattr(_InKernel, f"__{_name}__", None)


def _in_kernel(given):
    if isinstance(given, tuple):
        own = [_in_kernel(part) for part in given]
        return type(given)(*own) if hasattr(given, "_fields") else tuple(own)
    for name in ("_item", "_ary"):  # the simulator's wrappers
        given = getattr(given, "__dict__", {}).get(name, given)
    return given.view(_InKernel) if isinstance(given, np.ndarray) else given


def _one_after_another(block, point, *given) -> None:
    """Go through the threads of a block: kernels of ours wait for no other, and one of Python's for each is dear."""
    from numba.cuda.simulator.kernel import Dim3

    me = threading.current_thread()
    me.blockIdx = Dim3(*point)
    own = _in_kernel(given)
    for thread in np.ndindex(*block._block_dim):
        me.threadIdx = Dim3(*thread)
        block._f(*own)


def _known(array, name: str):
    if name not in KNOWN:
        raise AttributeError(f"an array of a device has no {name}")
    return getattr(array._ary, name)


def simulated(*words, file=__file__, **more) -> subprocess.CompletedProcess:
    """The finished process of sdph, or of another `file` of tests, with a simulated device."""
    around = os.environ | {"NUMBA_ENABLE_CUDASIM": "1", "NUMBA_NUM_THREADS": "1"} | more
    command = [sys.executable, str(file), *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True, timeout=900, check=False, env=around)


def on_device(folder, *given: str):
    """The folder of a run of sdph on a device, a simulated one where there is none."""
    from sdph.cli import main
    from sdph.engine.gpu import found

    words = (*given, *(() if "--resume" in given else ("--out", str(folder))), "--device", "cuda")
    if found.missing():
        done = simulated(*words)
        assert done.returncode == 0, done.stderr[-3000:]
    else:
        assert main(list(words)) == 0
    return folder


def on_cpu(folder, *given: str):
    """The folder of a run of sdph on the processor."""
    from sdph.cli import main

    assert main([*given, "--out", str(folder)]) == 0
    return folder


def there_and_back(folder, whole, until: str, alike) -> None:
    """Run the words `whole`; go on to `until` from the processor on a device, and back: `alike` compares with a run
    that went on where it was."""
    from sdph.cli import main

    cpu, cuda, later = on_cpu(folder / "cpu", *whole), on_device(folder / "cuda", *whole), ("--until", until)
    for source, copy in ((cpu, "cpu_cuda"), (cuda, "cuda_cpu"), (cpu, "cpu_cpu")):
        shutil.copytree(source, folder / copy)
    on_device(folder / "cpu_cuda", "run", "--resume", str(folder / "cpu_cuda"), *later)
    for copy in ("cuda_cpu", "cpu_cpu"):
        assert main(["run", "--resume", str(folder / copy), *later, "--device", "cpu"]) == 0
    for copy in ("cpu_cuda", "cuda_cpu"):
        alike(folder / copy, folder / "cpu_cpu")


if __name__ == "__main__":
    from sdph import cli

    make_strict()
    sys.exit(cli.main(sys.argv[1:]))
