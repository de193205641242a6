"""Headers of Debian's OpenFOAM, which its packages lack: fetched as the source package, kept in the user's cache.

The package list and the archive live in a folder of their own, so that neither root nor a change to the
system's apt sources is needed; apt checks signatures and sums as always.
"""

from __future__ import annotations

import os
import re
import subprocess
import tarfile
import tempfile
from collections.abc import Callable
from pathlib import Path

from coupling.gas import GasError

# of the source tree: what sdphGasFoam and the solvers of the comparisons include
NEEDED = (
    "src/OpenFOAM/", "src/OSspecific/POSIX/", "src/finiteVolume/", "src/meshTools/", "src/thermophysicalModels/",
    "src/TurbulenceModels/", "src/transportModels/", "src/lagrangian/", "src/regionModels/", "src/ODE/",
    "src/combustionModels/", "src/sampling/", "applications/solvers/multiphase/twoPhaseEulerFoam/",
    "applications/solvers/lagrangian/reactingParcelFoam/", "applications/solvers/combustion/reactingFoam/",
)  # fmt: skip
ARCHIVES = {"debian": "http://deb.debian.org/debian", "ubuntu": "http://archive.ubuntu.com/ubuntu"}
KEYRINGS = {name: Path(f"/usr/share/keyrings/{name}-archive-keyring.gpg") for name in ARCHIVES}


def fetch(target: Path, status: Callable[[str], None]) -> None:
    """Make `target` hold the headers of the OpenFOAM package that is installed, with lnInclude folders."""
    with tempfile.TemporaryDirectory(dir=target.parent, prefix="headers-") as scratch:
        scratch = Path(scratch)
        status("fetching the source of OpenFOAM for its headers (45 MB, once) ...")
        archive = _download(scratch)
        status("unpacking the headers ...")
        _unpack(archive, scratch / "tree")
        _link_includes(scratch / "tree")
        os.rename(scratch / "tree", target)


def _download(scratch: Path) -> Path:
    (scratch / "lists" / "partial").mkdir(parents=True)
    (scratch / "cache" / "archives" / "partial").mkdir(parents=True)
    sources = scratch / "sources.list"
    sources.write_text("".join(f"{line}\n" for line in _source_lines()))
    options = {
        "Dir::Etc::SourceList": sources, "Dir::Etc::SourceParts": "-", "Dir::State::Lists": scratch / "lists",
        "Dir::Cache": scratch / "cache", "APT::Sandbox::User": "",
    }  # fmt: skip
    apt = ["apt-get", *(f"-o{key}={value}" for key, value in options.items())]
    # the archive alone: mirrors have been seen without the .dsc beside it
    _run([*apt, "update"], scratch)
    _run([*apt, "source", "--download-only", "--tar-only", f"openfoam={_source_version()}"], scratch)
    archives = list(scratch.glob("openfoam_*.orig.tar.*"))
    if len(archives) != 1:
        raise GasError("apt-get source gave no archive of OpenFOAM's source")
    return archives[0]


def _source_version() -> str:
    done = _run(["dpkg-query", "-W", "-f", "${source:Version}", "openfoam"], Path("/"))
    return done.stdout.strip()


def _source_lines() -> list[str]:
    """deb-src lines for the distribution's own archives that apt knows, else for its official one."""
    system = _os_release()
    name = "ubuntu" if "ubuntu" in (system.get("ID"), system.get("ID_LIKE")) else "debian"
    key = f"[signed-by={KEYRINGS[name]}] " if KEYRINGS[name].exists() else ""
    form = "$(ORIGIN)|$(REPO_URI)|$(RELEASE)|$(COMPONENT)"
    done = subprocess.run(
        ["apt-get", "indextargets", "--format", form, "Created-By: Packages"], capture_output=True, text=True
    )
    rows = {tuple(line.split("|")[1:]) for line in done.stdout.splitlines() if line.lower().startswith(f"{name}|")}
    if not rows:
        component = "universe" if name == "ubuntu" else "main"
        rows = {(ARCHIVES[name], system["VERSION_CODENAME"], component)}
    return [f"deb-src {key}{uri} {release} {component}" for uri, release, component in sorted(rows)]


def _os_release() -> dict[str, str]:
    text = Path("/etc/os-release").read_text(encoding="utf-8")
    return {key: value.strip('"') for key, value in re.findall(r"^(\w+)=(.*)$", text, re.MULTILINE)}


def _unpack(archive: Path, tree: Path) -> None:
    """Regular files only, and none outside `tree` (Debian 12's Python has no extraction filters yet)."""
    with tarfile.open(archive, "r|*") as source:
        for member in source:
            name = member.name.partition("/")[2]
            wanted = name.endswith((".H", ".C")) or "/Make/" in name
            if member.isfile() and wanted and name.startswith(NEEDED) and ".." not in name.split("/"):
                (tree / name).parent.mkdir(parents=True, exist_ok=True)
                (tree / name).write_bytes(source.extractfile(member).read())


def _link_includes(tree: Path) -> None:
    """As wmakeLnInclude: a library (it has a folder Make) gets links to all its files in lnInclude."""
    for make in list(tree.rglob("Make")):
        include = make.parent / "lnInclude"
        files = [path for path in make.parent.rglob("*.[HC]") if "lnInclude" not in path.parts]
        include.mkdir()
        for path in files:
            link = include / path.name
            if not link.is_symlink():
                link.symlink_to(os.path.relpath(path, include))


def _run(command: list[str], folder: Path) -> subprocess.CompletedProcess:
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    if done.returncode != 0:
        last = (done.stderr.strip() or done.stdout.strip()).splitlines()[-1:]
        words = [word for word in command if not word.startswith("-")]
        raise GasError(f"{' '.join(words)} failed: {''.join(last)}")
    return done
