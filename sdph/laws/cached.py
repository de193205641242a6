"""Compiled functions that are kept on disk: each once for all processes that share the cache, and without a search for
garbage meanwhile."""

from __future__ import annotations

import contextlib
import fcntl
import functools
import gc
import hashlib
import os
import time
from collections.abc import Iterator
from pathlib import Path

from numba import config
from numba.core import event
from numba.core.caching import FunctionCache, NullCache
from numba.core.compiler_lock import global_compiler_lock
from numba.core.registry import CPUDispatcher

ALONE = config.NUMBA_NUM_THREADS == 1  # this process will never have a second thread to share loops with


class Watch(event.Listener):
    """Time [s] that this process has compiled for. Meanwhile Python looks for no garbage: numba makes many objects that
    live until it is done, and to look through them takes a tenth of a cold start and more (benchmarks/README.md)."""

    def __init__(self):
        self.depth, self.begun, self.spent, self.collects = 0, 0.0, 0.0, True

    def on_start(self, event) -> None:
        self.depth += 1
        if self.depth == 1:
            self.begun, self.collects = time.perf_counter(), gc.isenabled()
            gc.disable()

    def on_end(self, event) -> None:
        self.depth -= 1
        if self.depth == 0:
            self.spent += time.perf_counter() - self.begun
            if self.collects:
                gc.enable()


WATCH = Watch()
event.register("numba:compile", WATCH)


class Cache(FunctionCache):
    """Keeps what processes of one thread compile apart from what others do, and loses none of what several keep."""

    def __init__(self, function):
        super().__init__(function)
        self.name = f"{function.__module__}.{function.__qualname__}"

    def _index_key(self, signature, codegen):
        return *super()._index_key(signature, codegen), ALONE

    def save_overload(self, signature, data):
        with _in_turn(self.name):  # the list of a function's kernels is read, made longer and written
            super().save_overload(signature, data)


class Cached(CPUDispatcher):
    """A compiled function that is kept on disk. Of processes that begin together, ranks or workers, one compiles it and
    the others wait and load what it made."""

    def compile(self, signature):
        if isinstance(self._cache, NullCache):  # asked for late: a process compiles few of the functions that it knows
            self._cache = Cache(self.py_func)
        with global_compiler_lock, _in_turn(f"{self._cache.name} {signature} {ALONE}"):
            return super().compile(signature)


@contextlib.contextmanager
def _in_turn(name: str) -> Iterator[None]:
    """Within the context no other process has this name, where the cache can be locked. A caller holds its own name and
    waits for those of its callees, never the other way round, so that none waits for ever."""
    place = int.from_bytes(hashlib.sha256(name.encode()).digest()[:7])  # of a byte that stands for the name
    try:
        lock = _lock(config.CACHE_DIR)
        try:
            fcntl.lockf(lock, fcntl.LOCK_EX | fcntl.LOCK_NB, 1, place)
        except BlockingIOError:  # to wait for what another compiles is to compile, for who tells of it and counts it
            with event.trigger_event("numba:compile"):
                fcntl.lockf(lock, fcntl.LOCK_EX, 1, place)
    except OSError:  # of file systems without locks: each compiles for itself
        yield
        return
    try:
        yield
    finally:
        fcntl.lockf(lock, fcntl.LOCK_UN, 1, place)


@functools.cache
def _lock(folder: str) -> int:
    """The file of a cache that processes lock; open as long as this one lives, as to close it would unlock it all."""
    if not folder:
        raise FileNotFoundError("numba keeps what it compiles beside each source")
    Path(folder).mkdir(parents=True, exist_ok=True)
    return os.open(Path(folder) / "lock", os.O_RDWR | os.O_CREAT, 0o644)
