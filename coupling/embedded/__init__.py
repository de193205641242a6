"""An in-process finite-volume gas solver; see `coupling.embedded.solver`."""

from coupling.embedded.solver import EmbeddedGas

__all__ = ["EmbeddedGas"]
