"""Compilation of laws: cached on disk, IEEE division (1/0 is inf, as in numpy), no fast-math."""

from numba import njit

law = njit(cache=True, error_model="numpy")
