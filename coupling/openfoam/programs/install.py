"""`sdph openfoam setup` and `sdph doctor`: OpenFOAM from apt, and what sdph compiles for it."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from coupling.gas import GasError
from coupling.openfoam.programs.build import build, built, silent
from coupling.openfoam.programs.installation import INSTALL_LINE, Installation, find, require

HERE = Path(__file__).parents[1]
GAS_SOLVER = HERE / "sdphGasFoam"
TWO_FLUID_SOLVER = HERE / "twoPhaseEulerFoam"
DROPLET_SOLVER = HERE / "reactingParcelFoam"
TWO_FLUID_CLOSURES = HERE / "twoFluidClosures"
CODE_GUARD = HERE / "codeGuard"
GAS_TURBULENCE = HERE / "gasTurbulence"
YIELD = "mpi_yield_when_idle"  # of Open MPI: who waits for a message lets others have the core

__all__ = [
    "Row",
    "build",
    "code_guard",
    "doctor",
    "droplet_solver",
    "environment",
    "find",
    "gas_solver",
    "gas_turbulence",
    "mpirun",
    "require",
    "setup",
    "two_fluid_closures",
    "two_fluid_solver",
]


def gas_solver(status: Callable[[str], None] = silent) -> Path:
    """sdphGasFoam, compiled if it must be."""
    return build(GAS_SOLVER, status)


def two_fluid_solver(status: Callable[[str], None] = silent) -> Path:
    """twoPhaseEulerFoam as it must be on cells that are no boxes, compiled if it must be."""
    return build(TWO_FLUID_SOLVER, status)


def droplet_solver(status: Callable[[str], None] = silent) -> Path:
    """reactingParcelFoam as it must be on cells that are no boxes, compiled if it must be."""
    return build(DROPLET_SOLVER, status)


def two_fluid_closures(status: Callable[[str], None] = silent) -> Path:
    """The library of closures for twoPhaseEulerFoam, compiled if it must be."""
    return build(TWO_FLUID_CLOSURES, status)


def gas_turbulence(status: Callable[[str], None] = silent) -> Path:
    """The library of the turbulence of sdphGasFoam, compiled if it must be."""
    return build(GAS_TURBULENCE, status)


def code_guard(status: Callable[[str], None] = silent) -> Path:
    """The library that keeps programs from loading libraries of a case, compiled if it must be."""
    return build(CODE_GUARD, status)


def environment() -> dict[str, str]:
    """Environment variables for OpenFOAM's programs."""
    return require().environment()


def mpirun(ranks: int) -> list[str]:
    """The head of a command on `ranks` processes of this machine.

    Gas and particles wait for each other in turn, and processes of Open MPI else keep their cores busy meanwhile: on
    two cores with other jobs a window of two ranks of gas took 493 ms, and 96 so. OMPI_MCA_mpi_yield_when_idle=0 has
    them do so.
    """
    as_root = ["--allow-run-as-root"] if os.geteuid() == 0 else []
    waits = ["--mca", YIELD, os.environ.get(f"OMPI_MCA_{YIELD}", "1")]
    return ["mpirun", *as_root, "--oversubscribe", *waits, "-np", str(ranks)]


def setup(install: bool = False, status: Callable[[str], None] = print) -> None:
    """Find OpenFOAM (or get it with apt, when `install`), and compile what sdph needs of it. Quick the second time."""
    if install and (find() is None or shutil.which("g++") is None or shutil.which("mpirun") is None):
        _apt_install(status)
    found = require()
    status(f"OpenFOAM {found.version} in {found.project}")
    for made in (gas_solver, two_fluid_solver, two_fluid_closures, droplet_solver, code_guard):
        product = made(status)
        status(f"{product.name} is ready: {product}")


def _apt_install(status: Callable[[str], None]) -> None:
    become_root = [] if os.geteuid() == 0 else ["sudo"]
    status(f"{' '.join([*become_root, INSTALL_LINE])} ...")
    environment = dict(os.environ) | {"DEBIAN_FRONTEND": "noninteractive"}
    for command in (["apt-get", "update"], [*INSTALL_LINE.split(), "--yes"]):
        done = subprocess.run([*become_root, *command], env=environment, capture_output=True, text=True)
        if done.returncode != 0:
            last = done.stderr.strip().splitlines()[-1:]
            raise GasError(f"{' '.join(command)} failed: {''.join(last)}")


@dataclass(frozen=True)
class Row:
    """A line of `sdph doctor`: what, whether it is there, which, and the command that mends it."""

    what: str
    found: bool
    detail: str
    mend: str

    def __str__(self) -> str:
        return f"{self.what:24}{self.detail}" if self.found else f"{self.what:24}missing; mend it with: {self.mend}"


def doctor() -> list[Row]:
    """Rows of `sdph doctor`: each part of OpenFOAM, whether it is there, and what mends it."""
    found = find()
    get = "sdph openfoam setup --install"
    rows = [Row("OpenFOAM", found is not None, f"{found.version} in {found.project}" if found else "", get)]
    rows += [_program(name, get) for name in ("blockMesh", "mpirun")]
    rows.append(_compiler(found, get))
    made = (GAS_SOLVER, TWO_FLUID_SOLVER, TWO_FLUID_CLOSURES, DROPLET_SOLVER, CODE_GUARD)
    rows += [_product(source, found) for source in made]
    return rows


def _program(name: str, mend: str) -> Row:
    found = find()
    path = shutil.which(name, path=found.environment().get("PATH")) if found else shutil.which(name)
    return Row(name, path is not None, path or "", mend)


def _compiler(found: Installation | None, mend: str) -> Row:
    if found is not None and found.wmake:
        return Row("compiler", True, f"wmake in {found.project / 'wmake'}", mend)
    path = shutil.which("g++")
    version = subprocess.run([path, "-dumpfullversion"], capture_output=True, text=True).stdout.strip() if path else ""
    return Row("compiler", path is not None, f"g++ {version}", mend)


def _product(source: Path, found: Installation | None) -> Row:
    product = built(source, found) if found is not None else None
    there = product is not None and product.exists()
    return Row(source.name, there, str(product), "sdph openfoam setup")
