"""Decorators of compiled functions: `law` and `serial` (one thread), `inlined` (part of a loop), `parallel`, `inner`
(a loop that compiled functions call), `in_turn` (loops one after the other); all are cached on disk, with IEEE division
(1/0 is inf, as in numpy); `fast_` ones may sum in any order.

Functions that only loops call get no way in from Python, a State goes to all of them as one pointer
(sdph.laws.by_reference), and a process of one thread compiles loops without threads: what else makes a cold start long
(benchmarks/README.md).
"""

from __future__ import annotations

import types

from sdph.laws.cached import ALONE, Cached

# Sums may be reordered and vectorised: 2.3 times as fast. nan and inf keep their meaning, so that a run that bursts is
# noticed.
FAST = {"reassoc", "nsz", "arcp", "contract", "afn"}
COMMON = {"error_model": "numpy", "no_cfunc_wrapper": True}


class Compiled(Cached):
    """A compiled function whose way in from Python is compiled apart, when Python first calls it."""

    _entry = None

    def __call__(self, *arguments, **named):
        if self._entry is None:
            options = {name: value for name, value in self.targetoptions.items() if name != "no_cpython_wrapper"}
            self._entry = Cached(self._twin(), targetoptions=options)
        return self._entry(*arguments, **named)

    def _twin(self):
        """The same function by another name: numba's cache knows functions by their names."""
        own = self.py_func
        twin = types.FunctionType(own.__code__, own.__globals__, own.__name__, own.__defaults__, own.__closure__)
        twin.__module__, twin.__qualname__, twin.__doc__ = own.__module__, f"{own.__qualname__}.called", own.__doc__
        return twin


def _within(kind=Compiled, **options):
    """Decorator: a function that other compiled ones call, and Python too."""

    def decorate(function) -> Compiled:
        return kind(function, targetoptions=dict(options, nopython=True, no_cpython_wrapper=True))

    return decorate


class Loop(Cached):
    """A compiled loop over particles. `elsewhere`, where it is set, is called instead with the loop and what it takes:
    of arrays that lie on a device (sdph.engine.gpu) the device runs it."""

    elsewhere = None
    largest = False  # of what threads find: the largest values are returned, not the sums

    def __call__(self, *arguments):
        return self.here(*arguments) if Loop.elsewhere is None else Loop.elsewhere(self, arguments)

    here = Cached.__call__


class Inner(Loop, Compiled):
    """A loop that compiled functions call as a rule: its way in from Python is compiled apart."""

    here = Compiled.__call__


class InTurn(Compiled):
    """Loops one after the other, compiled as one; where `Loop.elsewhere` is set Python calls them one by one."""

    def __call__(self, *arguments):
        return super().__call__(*arguments) if Loop.elsewhere is None else self.py_func(*arguments)


def _over_particles(largest=False, parallel=True, **options):
    """Decorator: a loop whose rounds threads share; with `parallel` False those of a device alone."""
    shared = parallel and not ALONE

    def decorate(function) -> Loop:
        made = Loop(function, targetoptions=dict(COMMON, **options, nopython=True, parallel=shared))
        made.largest = largest
        return made

    return decorate


law = serial = _within(**COMMON)
# What stands in every loop over pairs, or takes the whole state, is part of the loop: a call costs more than what it
# computes. LLVM takes such functions in by itself only when a loop comes from the cache: the process that compiles
# `rates` ran it 2.4 times slower.
inlined = _within(**COMMON, forceinline=True)
fast_inlined = _within(**COMMON, forceinline=True, fastmath=FAST)
parallel = _over_particles()
parallel_largest = _over_particles(largest=True)  # returns the largest of what threads find; other loops return sums
in_order = _over_particles(parallel=False)  # sums up in the order of the particles, however many threads there are
inner = _within(Inner, **COMMON)  # in that order too
in_turn = _within(InTurn, **COMMON)
fast_parallel = _over_particles(fastmath=FAST)
