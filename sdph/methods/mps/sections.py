"""The section [method]: which method moves the liquid of a case, and the numbers of the moving-particle method."""

from __future__ import annotations

from sdph.schema import choice, quantity, record, whole

NAMES = ("weakly_compressible", "mps")


@record
class LiquidMethod:
    """`weakly_compressible` (delta-SPH), or `mps`: moving particles whose pressure solves a Poisson equation.

    All but the name is of `mps`; lengths in spacings.
    """

    name: str = choice(*NAMES)
    reach: float = quantity("", 2.1, above=1.5, most=4.1)  # r_e; 3.1 for drops in two dimensions (swirl-sheet.md)
    # gamma: share of a surplus of n that the pressure takes out in a step; 0.01 in pools
    compression: float = quantity("", 0.05, least=0.0, most=1.0)
    tolerance: float = quantity("", 1e-3, above=0.0, most=0.1)  # of the pressure's equations
    iterations: int = whole(1000, least=1)  # of them, at most
    collision: float = quantity("", 0.7, least=0.0, most=0.95)  # distance at which two that approach collide
    restitution: float = quantity("", 0.2, least=0.0, most=1.0)  # of a collision
    # distance up to which two are of one piece: two alone rest at 1.5, where tension turns round; our choice
    piece: float = quantity("", 1.8, above=1.0, most=2.1)
