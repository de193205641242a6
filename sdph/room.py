"""Whether a case fits into the memory of this machine, told before anything of it is made."""

from __future__ import annotations

import math
from pathlib import Path

from sdph import case as cases
from sdph.schema import CaseError

MEMINFO, CGROUP = Path("/proc/meminfo"), Path("/sys/fs/cgroup/memory.max")
ROUND = {2: math.pi, 3: 4.0 / 3.0 * math.pi}  # of a disc and a sphere over radius^dimensions


def refuse_too_large(case) -> None:
    """CaseError where the case needs more memory than is free."""
    from sdph.explain import estimate

    count = sum(_volume(case, part) for part in (*case.particles.values(), *case.pools.values())) / case.resolution.spacing**case.dimensions
    cells = 0 if case.liquid else math.prod(cases.cells(case))
    needed, free = estimate.memory(case, count, cells), available()
    if needed > free:
        raise CaseError(
            f"the case has about {count:.3g} particles and {cells:.3g} gas cells and needs about {needed / 1e9:.3g} GB of memory; "
            f"{free / 1e9:.3g} GB are free here: raise resolution.spacing_mm or resolution.cell_mm, or take a larger machine"
        )


def available() -> float:
    """Bytes that a program can still have: what the system says is free, or what its group is allowed; inf where neither is told."""
    found = [math.inf]
    if MEMINFO.exists():
        lines = dict(line.split(":") for line in MEMINFO.read_text(encoding="ascii").splitlines())
        found.append(1024.0 * float(lines["MemAvailable"].split()[0]))
    if CGROUP.exists() and (limit := CGROUP.read_text(encoding="ascii").strip()) != "max":
        found.append(float(limit))
    return min(found)


def _volume(case, part) -> float:
    """[m2] or [m3] that a region or a pool fills at most."""
    if part.radius is not None:
        return ROUND[case.dimensions] * part.radius**case.dimensions
    if part.upper is not None:
        return math.prod(high - low for low, high in zip(part.lower, part.upper))
    return math.prod(case.domain.size)
