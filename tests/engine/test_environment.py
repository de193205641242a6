"""Guards against what numba does without a word: slow thread layers, stale caches, dropped writes, lost nans."""

import ast
import importlib.util
import os
import subprocess
import sys

import numba
import pytest

from sdph.engine import device as environment
from sdph.laws.compiled import FAST
from sdph.scenes import paths

SOURCES = [file for folder in ("sdph", "coupling") for file in sorted((paths.PACKAGE.parent / folder).rglob("*.py"))]
NO_NANS = {"fast", "nnan", "ninf"}  # flags by which a run that bursts is not noticed
USES = "from sdph.laws.compiled import law\n"
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


def loops():
    """(file, function) of every parallel loop."""
    for file in SOURCES:
        tree = ast.parse(file.read_text(encoding="utf-8"))
        for function in (node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)):
            if {"parallel", "fast_parallel"} & {getattr(own, "id", "") for own in function.decorator_list}:
                yield file, function


def test_there_are_loops():
    assert len(list(loops())) > 60


def test_threads_are_launched_by_openmp():
    if importlib.util.find_spec("numba.np.ufunc.omppool") is None:
        pytest.skip("this numba has no OpenMP")
    found = subprocess.run([sys.executable, "-c", PROBE], capture_output=True, text=True, check=True)
    assert found.stdout.split() == ["omp"]


def written(function):
    """What stands before the [...] of each place that a function writes to."""
    for node in ast.walk(function):
        targets = (
            node.targets if isinstance(node, ast.Assign) else [node.target] if isinstance(node, ast.AugAssign) else []
        )
        for target in (t for whole in targets for t in (whole.elts if isinstance(whole, ast.Tuple) else [whole])):
            if isinstance(target, ast.Subscript):
                yield target.value


def test_no_parallel_loop_writes_to_unpacked_arguments():
    """`X, Y = outputs` drops what a prange writes to X and Y; the outputs must be arguments of their own."""
    for file, function in loops():
        unpacked = {
            name.id for node in ast.walk(function) if isinstance(node, ast.Assign) and isinstance(node.value, ast.Name)
            for target in node.targets if isinstance(target, ast.Tuple) for name in target.elts
        }  # fmt: skip
        names = {place.id for place in written(function) if isinstance(place, ast.Name)}
        assert not unpacked & names, f"{file.name}: {function.name}"


def test_no_parallel_loop_writes_to_a_field_of_an_argument():
    """`s.x[i] = ...` of a NamedTuple s is dropped in a prange."""
    for file, function in loops():
        assert not any(isinstance(place, ast.Attribute) for place in written(function)), f"{file.name}: {function.name}"


def test_fast_arithmetic_keeps_nans():
    assert not FAST & NO_NANS
    with_flags = [file.name for file in SOURCES if "fastmath" in file.read_text(encoding="utf-8")]
    assert with_flags == ["compiled.py"]


def test_every_compiled_function_is_compiled_by_one_file():
    assert [file.name for file in SOURCES if "targetoptions=" in file.read_text(encoding="utf-8")] == ["compiled.py"]
    assert not [file.name for file in SOURCES if "njit" in file.read_text(encoding="utf-8")]


def test_loops_are_not_cut_into_chunks():
    """set_parallel_chunksize(1) costs 2 to 4 times as much."""
    assert not [file.name for file in SOURCES if "set_parallel_chunksize" in file.read_text(encoding="utf-8")]


@pytest.mark.parametrize(("layer", "count"), [("omp", 0), ("workqueue", 1)])
def test_the_work_queue_is_told(monkeypatch, layer, count):
    monkeypatch.setattr(numba, "threading_layer", lambda: layer)
    assert len(environment.warnings()) == count


def test_before_any_parallel_loop_there_is_nothing_to_tell(monkeypatch):
    def unknown():
        raise ValueError("Threading layer is not initialized.")

    monkeypatch.setattr(numba, "threading_layer", unknown)
    assert environment.warnings() == []


@pytest.fixture
def settings():
    """Settings of numba as they were before the test."""
    yield
    numba.config.reload_config()


def test_what_the_user_has_set_stays(settings, monkeypatch):
    monkeypatch.setenv("NUMBA_CPU_FEATURES", "+sse2")
    monkeypatch.setenv("NUMBA_THREADING_LAYER_PRIORITY", "workqueue")
    environment.prepare()
    assert (os.environ["NUMBA_CPU_FEATURES"], os.environ["NUMBA_THREADING_LAYER_PRIORITY"]) == ("+sse2", "workqueue")


def test_an_edited_law_gets_kernels_of_its_own(monkeypatch, tmp_path):
    """numba itself does not notice that a callee in another file was edited."""
    package = tmp_path / "sdph"
    (package / "engine").mkdir(parents=True)
    (package / "law.py").write_text(f"{USES}@law\ndef drag(): return 1\n")
    monkeypatch.setattr(environment, "__file__", str(package / "engine" / "device.py"))
    before = environment.sources(of_kernels=True)
    (package / "law.py").write_text(f"{USES}@law\ndef drag(): return 2\n")
    assert environment.sources(of_kernels=True) != before


def test_an_edit_of_what_loops_take_by_reference_is_another_cache(tmp_path, monkeypatch):
    """Kernels know where each member lies by its number."""
    package = tmp_path / "sdph"
    (package / "engine").mkdir(parents=True)
    monkeypatch.setattr(environment, "__file__", str(package / "engine" / "device.py"))
    group = "from typing import NamedTuple\n\nfrom sdph.laws.by_reference import by_reference\n\n\n@by_reference\n"
    found = set()
    for members in ("x: float\n    y: float", "y: float\n    x: float"):
        (package / "group.py").write_text(f"{group}class Group(NamedTuple):\n    {members}\n")
        found.add(environment.sources(of_kernels=True))
    assert len(found) == 2


def test_numba_imported_first_caches_by_the_sources_too():
    told = (
        "import numba, sdph; from sdph.engine import device as environment; "
        "print(numba.config.CACHE_DIR.endswith(environment.sources(of_kernels=True)))"
    )
    variables = {name: value for name, value in os.environ.items() if name != "NUMBA_CACHE_DIR"}
    found = subprocess.run([sys.executable, "-c", told], capture_output=True, text=True, check=True, env=variables)
    assert found.stdout.split() == ["True"]
