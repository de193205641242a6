"""Compiling for OpenFOAM: a folder with Make/files and Make/options -> a program or library in the user's cache.

wmake does it where it is installed (the packages of openfoam.com and openfoam.org); for Debian's package,
which has neither wmake nor headers, one g++ line made of the same two files does.
"""

from __future__ import annotations

import contextlib
import fcntl
import hashlib
import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

from coupling.gas import GasError
from coupling.openfoam import headers
from coupling.openfoam.programs.installation import Installation, require
from sdph.schema import CaseError

FLAGS = (
    "-std=c++14", "-O3", "-fPIC", "-pthread", "-DWM_DP", "-DWM_LABEL_SIZE=32", "-DNoRepository", "-ftemplate-depth-100",
    "-w",
)  # fmt: skip
# Debian links with --as-needed, which would drop what only a constructor of a library registers
LINK = ("-Wl,--no-as-needed", "-lOpenFOAM", "-lPstream", "-ldl", "-lm")


def cache() -> Path:
    """Folder of built things: $XDG_CACHE_HOME/sdph/openfoam."""
    base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(base) / "sdph" / "openfoam"


def silent(_: str) -> None:
    """Drop a message."""


def build(source: Path, status: Callable[[str], None] = silent) -> Path:
    """The program or library of the folder `source`, compiled unless the cache has it."""
    installation = require()
    product = built(source, installation)
    if product.exists():
        return product
    with _lock(cache()):
        if not product.exists():
            status(f"compiling {product.name} for OpenFOAM {installation.version} (once) ...")
            _compile(source, installation, product, status)
    return product


def built(source: Path, installation: Installation) -> Path:
    """Path of the product of `source`, built or not: the folder is named by OpenFOAM's version and a hash of all that
    goes in."""
    digest = hashlib.sha256(repr((FLAGS, LINK, installation.package)).encode())
    for path in sorted(p for p in source.rglob("*") if p.suffix in (".C", ".H") or p.parent.name == "Make"):
        digest.update(f"{path.relative_to(source)}\0".encode() + path.read_bytes())
    kind, name = _product(source)
    name = name if kind == "EXE" else f"{name}.so"
    return cache() / f"{installation.version}-{digest.hexdigest()[:12]}" / name


def _compile(source: Path, installation: Installation, product: Path, status: Callable[[str], None]) -> None:
    with tempfile.TemporaryDirectory(dir=cache(), prefix="build-") as scratch:
        copy, out = Path(scratch) / "source", Path(scratch) / "out"
        shutil.copytree(source, copy)
        out.mkdir()
        compile_with = _wmake if installation.wmake else _gxx
        compile_with(copy, out / product.name, installation, status)
        product.parent.mkdir(exist_ok=True)
        os.rename(out / product.name, product)


def _wmake(copy: Path, product: Path, installation: Installation, status: Callable[[str], None]) -> None:
    places = {"FOAM_USER_APPBIN": str(product.parent), "FOAM_USER_LIBBIN": str(product.parent)}
    _run(["wmake"], copy, product, installation.environment() | places)


def _gxx(copy: Path, product: Path, installation: Installation, status: Callable[[str], None]) -> None:
    if shutil.which("g++") is None:
        raise CaseError("g++ was not found; it is needed once to compile the gas solver: sudo apt-get install g++")
    tree = header_folder(installation)
    if not tree.exists():
        headers.fetch(tree, status)
    _run(gxx_command(copy, product, installation, tree), copy, product, dict(os.environ))


def header_folder(installation: Installation) -> Path:
    """Folder of the headers of an installation without its own, named by its version and a hash of what is taken."""
    taken = hashlib.sha256(repr(headers.NEEDED).encode()).hexdigest()[:8]
    return cache() / f"headers-{installation.package}-{taken}"


def gxx_command(copy: Path, product: Path, installation: Installation, tree: Path) -> list[str]:
    """The g++ line that Make/files and Make/options amount to."""
    kind, _ = _product(copy)
    places = {"LIB_SRC": str(tree / "src"), "FOAM_SOLVERS": str(tree / "applications" / "solvers")}
    options = _make_variables((copy / "Make" / "options").read_text(), places)
    always = [f"-I{tree}/src/OpenFOAM/lnInclude", f"-I{tree}/src/OSspecific/POSIX/lnInclude"]
    sources = [line for line in (copy / "Make" / "files").read_text().split("\n") if line.strip().endswith(".C")]
    shared = ["-shared"] if kind == "LIB" else []
    compile_part = [
        "g++",
        *FLAGS,
        f"-DOPENFOAM={installation.version}",
        f"-I{copy}",
        *options["EXE_INC"].split(),
        *always,
    ]
    return [*compile_part, *shared, *sources, "-o", str(product), LINK[0], *options[f"{kind}_LIBS"].split(), *LINK[1:]]


def _product(source: Path) -> tuple[str, str]:
    """("EXE" | "LIB", file name) of Make/files."""
    found = re.search(r"^(EXE|LIB)\s*=\s*\S*/(\S+)", (source / "Make" / "files").read_text(), re.MULTILINE)
    return found.group(1), found.group(2)


def _make_variables(text: str, values: dict[str, str]) -> dict[str, str]:
    """The variables that a Make/options sets, with $(NAME) put in from `values` and from above."""
    values = dict(values)
    for name, value in re.findall(r"^(\w+)\s*=\s*(.*)$", text.replace("\\\n", " "), re.MULTILINE):
        values[name] = re.sub(r"\$\((\w+)\)", lambda match: values[match.group(1)], value)
    return values


def _run(command: list[str], folder: Path, product: Path, environment: dict[str, str]) -> None:
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)
    if done.returncode == 0 and product.exists():
        return
    log = cache() / f"{product.name}.log"
    log.write_text(f"{' '.join(command)}\n{done.stdout}{done.stderr}")
    errors = [line for line in done.stderr.splitlines() if "error" in line.lower()] or ["no message"]
    raise GasError(f"{product.name} could not be compiled: {errors[0]} (all of it: {log})")


@contextlib.contextmanager
def _lock(folder: Path) -> Iterator[None]:
    """One build at a time; a second one waits for the first."""
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / "lock", "w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield
