"""A copy of the tree that faults are planted in, with the kernels that were compiled for the original.

Numba does not notice an edited callee in another file, so a fault gets its own cache: that of the clean copy without
what was compiled from the faulty file or from one that takes kernels or constants from it.
"""

from __future__ import annotations

import ast
import hashlib
import os
import shutil
from pathlib import Path

from sdph.engine import device

from .fault import Fault

LEFT_OUT = shutil.ignore_patterns(".*", "runs", "build", "dist", "site", "__pycache__", "*.egg-info")
PACKAGES = ("sdph", "coupling", "tests")


class Tree:
    """The copy at `place`/tree; caches beside it."""

    def __init__(self, root: Path, place: Path):
        self.root, self.clean_cache, self.fault_cache = place / "tree", place / "clean", place / "fault"
        shutil.copytree(root, self.root, ignore=LEFT_OUT)
        shutil.copy2(root / ".importlinter", self.root)
        self.needs = _imports(self.root)
        self.clean_cache.mkdir()
        _take_over(root, self.root, self.clean_cache)

    def environment(self, cache: Path) -> dict[str, str]:
        """Of a process in the copy."""
        own = {"PYTHONPATH": str(self.root), "NUMBA_CACHE_DIR": str(cache), "PYTHONDONTWRITEBYTECODE": "1"}
        own |= {"PYTEST_ADDOPTS": ""}  # may name what the copy lacks
        return os.environ | own

    def plant(self, fault: Fault) -> None:
        """Write the fault, and leave in its cache what it cannot touch."""
        path = self.root / fault.file
        os.rename(path, f"{path}.kept")
        path.write_bytes(fault.planted(Path(f"{path}.kept").read_bytes()))
        shutil.rmtree(self.fault_cache, ignore_errors=True)
        self._share(self.clean_cache, self.fault_cache, fault)

    def stale(self, file: str) -> set[tuple[str, str]]:
        """(folder of the cache, module) of the files whose kernels hold anything of `file`."""
        found, left = {file}, [file]
        plain = not _compiles(self.root / file)  # its constants may pass through packages that hold no kernel
        while left:
            taken = left.pop()
            for user, needed in self.needs.items():
                carries = _compiles(self.root / user) or (plain and user.endswith("__init__.py"))
                if taken in needed and carries and user not in found:
                    found.add(user)
                    left.append(user)
        return {(_subfolder((self.root / name).parent), Path(name).stem) for name in found}

    def restore(self, fault: Fault) -> None:
        """Take the fault out; the file is as old as it was, so that its kernels are still good, and what a trial
        compiled besides is kept."""
        os.replace(self.root / f"{fault.file}.kept", self.root / fault.file)
        self._share(self.fault_cache, self.clean_cache, fault)

    def _share(self, one: Path, other: Path, fault: Fault) -> None:
        """Kernels of one cache that hold nothing of the fault, also in the other one."""
        stale = self.stale(fault.file)
        for file in one.glob("*/*.nb[ic]"):
            if (file.parent.name, file.name.split(".")[0]) not in stale:
                own = other / file.parent.name / file.name
                own.parent.mkdir(parents=True, exist_ok=True)
                own.unlink(missing_ok=True)
                os.link(file, own)


def _compiles(file: Path) -> bool:
    return b"compiled" in file.read_bytes()


def _imports(root: Path) -> dict[str, set[str]]:
    """File -> files that it imports, packages only where something is taken from them itself."""
    files = {str(file.relative_to(root)) for package in PACKAGES for file in (root / package).rglob("*.py")}
    modules = {name.removesuffix(".py").removesuffix("/__init__").replace("/", "."): name for name in files}
    needs = {}
    for name in files:
        taken = set()
        for node in ast.walk(ast.parse((root / name).read_bytes())):
            if isinstance(node, ast.ImportFrom) and node.module:
                taken |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
            elif isinstance(node, ast.Import):
                taken |= {alias.name for alias in node.names}
        needs[name] = {modules[module] for module in taken if module in modules}
    return needs


def _subfolder(folder: Path) -> str:
    """Where numba keeps the kernels of the files in a folder (numba.core.caching)."""
    return f"{folder.name}_{hashlib.sha1(str(folder).encode()).hexdigest()}"


def _take_over(root: Path, copy: Path, cache: Path) -> None:
    """Kernels that were compiled for the original are good for the copy, whose files are of the same date."""
    device.prepare()
    compiled = Path(os.environ["NUMBA_CACHE_DIR"])
    for folder in {file.parent for package in PACKAGES for file in (copy / package).rglob("*.py")}:
        own = compiled / _subfolder(root / folder.relative_to(copy))
        if own.is_dir():
            shutil.copytree(own, cache / _subfolder(folder))
