"""Weakly compressible liquids, with a second phase or without."""
