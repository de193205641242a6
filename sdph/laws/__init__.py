"""Scalar physics: pure closures without arrays, one file per subject, each named after its author.

Every law takes and returns SI floats, is compiled by numba, and may be called from Python or from other kernels.
"""
