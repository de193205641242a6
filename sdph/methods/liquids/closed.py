"""The pressure of closed voids, whose push on the liquid has neither a net force nor a moment.

A uniform pressure on a closed face pushes nothing as a whole: p times the integral of n dS is 0, and so is that of
r x n dS. The sum over particles misses that by the disorder behind the face, and a closed droplet would set itself off.
What is missed is taken back where the void pushes, by how hard it does; `bubble_impulse_rel` tells how much that was.
"""

from __future__ import annotations

import numpy as np


def close(place, force) -> tuple[np.ndarray, np.ndarray, float]:
    """Part (N, 2) of a force (N, 2) [N] at places (N, 2) [m] that pushes and turns all together, as particles have it;
    its sum (2,) and the sum of the sizes of all forces [N]."""
    net, size = force.sum(axis=0), np.hypot(*force.T)
    whole = float(size.sum())
    if not whole > 0.0:
        return np.zeros_like(force), net, 0.0
    arm = place - size @ place / whole
    turning = float((arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0]).sum())
    inertia = float(size @ (arm**2).sum(axis=1))
    turned = np.stack([-arm[:, 1], arm[:, 0]], axis=1) * (turning / inertia if inertia > 0.0 else 0.0)
    return size[:, None] * (net / whole + turned), net, whole
