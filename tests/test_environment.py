"""Guards against what numba does without a word: slow thread layers, stale caches, dropped writes, lost nans."""

import ast
import importlib.util
import subprocess
import sys

import pytest

from sdph import paths

SOURCES = [file for folder in ("sdph", "coupling") for file in sorted((paths.PACKAGE.parent / folder).rglob("*.py"))]
NO_NANS = {"fast", "nnan", "ninf"}  # flags by which a run that bursts is not noticed
PROBE = """
import sdph, numba
@numba.njit(parallel=True)
def total(n):
    t = 0
    for i in numba.prange(n):
        t += i
    return t
total(10)
print(numba.threading_layer())
"""


def kernels():
    """(file, function, decorator) of every function that is compiled."""
    for file in SOURCES:
        tree = ast.parse(file.read_text(encoding="utf-8"))
        for function in (node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)):
            for decorator in function.decorator_list:
                if isinstance(decorator, ast.Call) and getattr(decorator.func, "id", "") == "njit":
                    yield file, function, {word.arg: word.value for word in decorator.keywords}


def test_there_are_kernels():
    assert sum("parallel" in words for _, _, words in kernels()) > 20


def test_threads_are_launched_by_openmp():
    if importlib.util.find_spec("numba.np.ufunc.omppool") is None:
        pytest.skip("this numba has no OpenMP")
    found = subprocess.run([sys.executable, "-c", PROBE], capture_output=True, text=True, check=True)
    assert found.stdout.split() == ["omp"]


def test_an_edited_callee_changes_the_cache(tmp_path):
    """numba does not notice one in another file."""
    package = tmp_path / "sdph"
    (tmp_path / "coupling").mkdir()
    package.mkdir()
    (package / "environment.py").write_text((paths.PACKAGE / "environment.py").read_text())
    spec = importlib.util.spec_from_file_location("copied_environment", package / "environment.py")
    copied = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(copied)
    (package / "law.py").write_text("@law\ndef f(x):\n    return x\n")
    before = copied._sources()
    (package / "law.py").write_text("@law\ndef f(x):\n    return 2 * x\n")
    assert copied._sources() != before


def written(function):
    """What stands before the [...] of each place that a function writes to."""
    for node in ast.walk(function):
        targets = node.targets if isinstance(node, ast.Assign) else [node.target] if isinstance(node, ast.AugAssign) else []
        for target in (t for target in targets for t in (target.elts if isinstance(target, ast.Tuple) else [target])):
            if isinstance(target, ast.Subscript):
                yield target.value


def test_no_parallel_loop_writes_to_unpacked_arguments():
    """`X, Y = outputs` drops what a prange writes to X and Y; the outputs must be arguments of their own."""
    for file, function, words in kernels():
        if "parallel" in words:
            unpacked = {
                name.id for node in ast.walk(function) if isinstance(node, ast.Assign) and isinstance(node.value, ast.Name)
                for target in node.targets if isinstance(target, ast.Tuple) for name in target.elts
            }  # fmt: skip
            names = {place.id for place in written(function) if isinstance(place, ast.Name)}
            assert not unpacked & names, f"{file.name}: {function.name}"


def test_no_parallel_loop_writes_to_a_field_of_an_argument():
    """`s.x[i] = ...` of a NamedTuple s is dropped in a prange."""
    for file, function, words in kernels():
        if "parallel" in words:
            assert not any(isinstance(place, ast.Attribute) for place in written(function)), f"{file.name}: {function.name}"


def test_fast_arithmetic_keeps_nans():
    for file, function, words in kernels():
        flags = words.get("fastmath")
        named = {node.value for node in ast.walk(flags) if isinstance(node, ast.Constant)} if flags else set()
        assert not named & NO_NANS and True not in named, f"{file.name}: {function.name}"


def test_loops_are_not_cut_into_chunks():
    """set_parallel_chunksize(1) costs 2 to 4 times as much."""
    assert not [file.name for file in SOURCES if "set_parallel_chunksize" in file.read_text(encoding="utf-8")]
