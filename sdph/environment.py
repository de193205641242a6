"""What has to be set before numba is imported: where kernels are cached, and how threads wait."""

from __future__ import annotations

import hashlib
import os
from pathlib import Path

CACHE = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "sdph"


def prepare() -> None:
    """Environment of numba; what the user has set stays.

    The cache is keyed by all sources, because numba does not notice an edited callee in another file. Threads
    sleep between loops, so that they do not take the cores from the gas solver.
    """
    os.environ.setdefault("NUMBA_CACHE_DIR", str(CACHE / "kernels" / _sources()))
    os.environ.setdefault("OMP_WAIT_POLICY", "passive")


def _sources() -> str:
    """Hash of every source file that holds a kernel or a law."""
    package = Path(__file__).parent
    digest = hashlib.sha256()
    for folder in (package, package.parent / "coupling"):
        for file in sorted(folder.rglob("*.py")):
            source = file.read_bytes()
            if b"njit" in source or b"@law" in source:
                digest.update(source)
    return digest.hexdigest()[:16]
