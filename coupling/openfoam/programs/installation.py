"""Installation of OpenFOAM on this machine, and the environment that its programs need."""

from __future__ import annotations

import functools
import os
import re
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

from sdph.engine import world
from sdph.schema import CaseError

DEBIAN_PROJECT = Path("/usr/share/openfoam")
# packages of openfoam.com and openfoam.org
PACKAGED = ("/usr/lib/openfoam/openfoam*/etc/bashrc", "/opt/openfoam*/etc/bashrc")
OF_RANK = re.compile(r"OMPI_(?!ALLOW_RUN_AS_ROOT)|PMIX_|PRTE_")  # what MPI tells one process, and is not of its own
INSTALL_LINE = "apt-get install --no-install-recommends openfoam openmpi-bin g++ libc6-dev"


@dataclass(frozen=True)
class Installation:
    """An OpenFOAM: its version ("1912"), its folder, the package it came in, and its bashrc where one must be read."""

    version: str
    project: Path
    package: str
    bashrc: Path | None = None

    @property
    def wmake(self) -> bool:
        """True where it can compile by itself."""
        return (self.project / "wmake" / "wmake").exists()

    def environment(self) -> dict[str, str]:
        """Environment variables for its programs, less $PWD: OpenFOAM takes no blanks in that, and where it is not
        set asks the system for the folder that the program was started in (links.py)."""
        if self.bashrc is not None:
            found = dict(_sourced(self.bashrc))
        else:
            found = dict(os.environ) | {"WM_PROJECT_DIR": str(self.project)}
        found.pop("PWD", None)
        if world.here().number == 1:
            return found
        return {name: value for name, value in found.items() if not OF_RANK.match(name)}


def find() -> Installation | None:
    """The OpenFOAM to use: $SDPH_OPENFOAM (its folder), the sourced one, Debian's, or the newest under PACKAGED."""
    wanted = os.environ.get("SDPH_OPENFOAM")
    if wanted is not None:
        return _at(Path(wanted))
    sourced = os.environ.get("WM_PROJECT_DIR")
    return (_at(Path(sourced)) if sourced else None) or _debian() or _packaged()


def require() -> Installation:
    """The OpenFOAM to use, or the error that says how to get one."""
    found = find()
    if found is None:
        raise CaseError(f"OpenFOAM was not found; get it with `sdph openfoam setup --install` or `sudo {INSTALL_LINE}`")
    return found


def _at(project: Path) -> Installation | None:
    if project == DEBIAN_PROJECT:
        return _debian()
    bashrc = project / "etc" / "bashrc"
    version = re.search(r"\d+$", os.environ.get("WM_PROJECT_VERSION", "") or project.name)
    if not bashrc.exists() or version is None:
        return None
    is_sourced = os.environ.get("WM_PROJECT_DIR") == str(project) and "FOAM_LIBBIN" in os.environ
    return Installation(version.group(), project, project.name, None if is_sourced else bashrc)


def _debian() -> Installation | None:
    if not (DEBIAN_PROJECT / "etc" / "controlDict").exists() or shutil.which("blockMesh") is None:
        return None
    done = subprocess.run(["dpkg-query", "-W", "-f", "${source:Version}", "openfoam"], capture_output=True, text=True)
    version = re.match(r"\d+", done.stdout)
    return Installation(version.group(), DEBIAN_PROJECT, f"debian-{done.stdout}") if version else None


def _packaged() -> Installation | None:
    bashrcs = [path for pattern in PACKAGED for path in Path("/").glob(pattern.lstrip("/"))]
    found = [_at(path.parent.parent) for path in bashrcs]
    return max((f for f in found if f is not None), key=lambda f: int(f.version), default=None)


@functools.cache
def _sourced(bashrc: Path) -> tuple[tuple[str, str], ...]:
    """The environment after `source bashrc` (which would read arguments of the shell as files to source too)."""
    script = 'rc=$1; shift; source "$rc"; env -0'
    done = subprocess.run(["bash", "-c", script, "bash", str(bashrc)], capture_output=True, text=True)
    pairs = (entry.partition("=") for entry in done.stdout.split("\0") if entry)
    return tuple((name, value) for name, _, value in pairs)
