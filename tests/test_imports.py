"""Any module can be the first that is imported: users begin where they like."""

import ast
import subprocess
import sys

from sdph.scenes import paths

ROOT = paths.PACKAGE.parent
# Each argument, names of modules, in a process of its own, forked from one that knows all but sdph and coupling.
FIRST = """
import importlib, os, sys
import numba, scipy.optimize, scipy.sparse.linalg, scipy.spatial.transform, tomli_w
assert not [name for name in sys.modules if name.split(".")[0] in ("sdph", "coupling")]
for names in sys.argv[1:]:
    child = os.fork()
    if not child:
        for name in names.split():
            importlib.import_module(name)
        os._exit(0)
    if os.waitpid(child, 0)[1]:
        print(names)
"""


def modules() -> dict:
    """Name -> file of every module of both packages."""
    files = [file for package in ("sdph", "coupling") for file in sorted((ROOT / package).rglob("*.py"))]
    dotted = {".".join(file.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__"): file for file in files}
    return {name: file for name, file in dotted.items() if "data" not in name.split(".")}


def imported(name: str, file, known) -> set[str]:
    """What a module imports as it is imported itself, the packages that this is in included."""
    found = set()
    for node in ast.parse(file.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            found |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
    parts = [other.split(".") for other in {name, *found}]
    whole = {".".join(part[:n]) for part in parts for n in range(1, len(part) + 1)}
    return (whole & known) - {name}


def on_circles(graph: dict[str, set[str]]) -> list[str]:
    """The modules that import themselves by way of others."""

    def reached(start: str) -> set[str]:
        seen, left = set(), [start]
        while left:
            new = graph[left.pop()] - seen
            seen |= new
            left += new
        return seen

    return [name for name in graph if name in reached(name)]


def test_any_module_can_be_imported_first():
    """Order matters on circles alone (a package and the modules that it takes up are one): each module on one is tried
    as the first, and the rest is imported together."""
    known = modules()
    graph = {name: imported(name, file, known.keys()) for name, file in known.items()}
    assert len(graph) > 150 and all(graph[name] for name in graph if "." in name)
    tried = [*on_circles(graph), "sdph.engine.walls.sides", "sdph.running.simulation", " ".join(graph)]
    done = subprocess.run(
        [sys.executable, "-c", FIRST, *tried], cwd=ROOT, capture_output=True, text=True, timeout=240, check=True
    )
    assert not done.stdout, f"cannot be imported first: {done.stdout}\n{done.stderr[-2000:]}"
