"""Settings made before kernels are compiled: the cache of kernels, and how threads wait."""

from __future__ import annotations

import hashlib
import os
import sys
from pathlib import Path

OF_KERNELS = (b"laws.compiled", b"laws.cached", b"CPUDispatcher", b"by_reference")  # in sources that kernels depend on
CACHE = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "sdph"


def prepare() -> None:
    """Environment of numba; what the user has set stays.

    The cache is keyed by all sources, because numba does not notice an edited callee in another file. Threads
    sleep between loops, so that they do not take the cores from the gas solver. OpenMP launches a loop in 2 us, numba's
    own work queue in 141 us. Loops of pairs run 1.2 (Intel) to 1.3 times (AMD) as fast without the gathers and the
    512-bit registers of processors that have these (benchmarks/README.md).
    """
    if _has_avx512():
        import llvmlite.binding

        features = llvmlite.binding.get_host_cpu_features().flatten()
        os.environ.setdefault("NUMBA_CPU_FEATURES", f"{features},+prefer-no-gather,+prefer-256-bit")
    os.environ.setdefault("NUMBA_THREADING_LAYER_PRIORITY", "omp tbb workqueue")
    os.environ.setdefault("NUMBA_CACHE_DIR", str(CACHE / "kernels" / sources(of_kernels=True)))
    os.environ.setdefault("OMP_WAIT_POLICY", "passive")
    if "numba" in sys.modules:  # who imports numba before sdph would else share kernels between versions
        sys.modules["numba"].config.reload_config()


def warnings() -> list[str]:
    """Warnings of what slows the kernels down that have run so far, and what mends it."""
    import numba

    try:
        layer = numba.threading_layer()
    except ValueError:  # none has run in parallel
        return []
    slow = (
        "loops ran on numba's own work queue, which takes 0.14 ms to start one and OpenMP 0.002 ms; install OpenMP "
        "(libgomp1)"
    )
    return [slow] if layer == "workqueue" else []


def _has_avx512() -> bool:
    """True where Linux tells of AVX-512; elsewhere the compiler's own choice stands."""
    try:
        described = Path("/proc/cpuinfo").read_text(encoding="utf-8").split("\n\n")[0]
    except OSError:
        return False
    return "avx512f" in described


def sources(*, of_kernels: bool = False) -> str:
    """Hash of all our source files, or of those that hold a kernel, a law, or what these take by reference."""
    package = Path(__file__).parents[1]
    digest = hashlib.sha256()
    for folder in (package, package.parent / "coupling"):
        for file in sorted(folder.rglob("*.py")):
            source = file.read_bytes()
            if not of_kernels or any(mark in source for mark in OF_KERNELS):
                digest.update(source)
    return digest.hexdigest()[:16]
