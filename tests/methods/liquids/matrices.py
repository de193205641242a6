"""The matrices of `sdph.methods.liquids.correction`, particle by particle."""

import numpy as np

from sdph.engine import kernels as smoothing
from sdph.engine.state import positions
from sdph.methods.liquids import correction


def corrections(own):
    """B (N, 3, 3) of every particle that is not at the surface, 1 of the others; nothing of the walls."""
    r, B = positions(own.state), np.full((len(own.state.x), 3, 3), np.nan)
    for i in own.active:
        d = r[i] - r
        d = np.delete(d, i, axis=0)
        share = np.delete(np.abs(own.volume), i) * np.array(
            [smoothing.slope.py_func(own.kernel, q) for q in np.linalg.norm(d, axis=1)]
        )
        M = -np.einsum("j,ja,jb->ab", share, d, d)
        if own.case.dimensions == 2:
            M[2, 2] = 1.0
        B[i] = np.linalg.inv(M) if np.linalg.det(M) > correction.SURFACE else np.eye(3)
    return B
