"""Everything between particles and gas: the gas door, kernel transfer, messages, transports, gas solvers."""

import sdph  # noqa: F401  (sets the kernel cache before numba is imported)
