"""What is compiled is kept on disk, once for all processes that begin together."""

import os
import subprocess
import sys

import numba
import pytest

from sdph.laws import cached, compiled

TWO = """
import one
print(one.outer(1.0), *(sum(own.stats.cache_misses.values()) for own in (one.inner, one.outer, one.outer._entry)))
"""
ONE = """
from sdph.laws.compiled import law

@law
def inner(x):
    return x + 1.0

@law
def outer(x):
    return 2.0 * inner(x)
"""


@pytest.fixture
def double(monkeypatch, tmp_path):
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))
    return compiled.law(lambda x: 2.0 * x)


def test_processes_that_begin_together_compile_a_function_once(tmp_path):
    (tmp_path / "one.py").write_text(ONE)
    around = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "kernels")}
    started = [
        subprocess.Popen([sys.executable, "-c", TWO], env=around, cwd=tmp_path, stdout=subprocess.PIPE, text=True)
        for _ in range(4)
    ]
    found = [process.communicate(timeout=300)[0].split() for process in started]
    assert {own[0] for own in found} == {"4.0"}
    # whoever loads `outer.called` needs no `outer` and no `inner`
    assert [sum(int(own[k]) for own in found) for k in (1, 2, 3)] == [1, 0, 1]


def test_where_nothing_can_be_locked_each_compiles(double, monkeypatch, tmp_path):
    (tmp_path / "lock").mkdir()
    assert double(3.0) == 6.0
    monkeypatch.setattr(numba.config, "CACHE_DIR", "")
    with cached._in_turn("any"):
        assert not os.path.exists("lock")


def test_kernels_of_one_thread_lie_apart(double, monkeypatch):
    keys, own = set(), cached.Cache(double.py_func)
    for alone in (True, False):
        monkeypatch.setattr(cached, "ALONE", alone)
        keys.add(own._index_key(("float64",), double.targetctx.codegen()))
    assert len(keys) == 2


def test_the_list_of_kernels_is_written_by_one_process_at_a_time(double, monkeypatch):
    """Whatever the types: two that add to it at once would lose one of them."""
    held, before = [], cached._in_turn
    monkeypatch.setattr(cached, "_in_turn", lambda name: held.append(name) or before(name))
    double(3.0)
    called, saved = held
    assert called.startswith(f"{saved} (float64,)")
