"""Compilation of laws and of small functions: cached on disk, IEEE division (1/0 is inf, as in numpy), no fast-math."""

from numba import njit

law = njit(cache=True, error_model="numpy")
# What stands in every loop over pairs, or takes the whole state, is part of the loop: a call costs more than what it
# computes. LLVM takes such functions in by itself only when a loop comes from the cache: the process that compiles
# `rates` ran it 2.4 times slower.
inlined = njit(cache=True, error_model="numpy", forceinline=True)
