"""The section [method]: which method moves the liquid of a case, and the numbers of the moving-particle method."""

from __future__ import annotations

from sdph.schema import choice, quantity, record, whole, words

NAMES = ("weakly_compressible", "mps")


@record
class LiquidMethod:
    """`weakly_compressible` (delta-SPH), or `mps`: moving particles whose pressure solves a Poisson equation.

    All but the name is of `mps`; lengths in spacings.
    """

    name: str = choice(*NAMES)
    reach: float = quantity("", 2.1, above=1.5, most=4.1)  # r_e; 3.1 for drops in two dimensions (swirl-sheet.md)
    # `weakly_compressible`: by the density that follows the velocities, a cross-check of sheets and drops
    pressure: str = choice("poisson", "weakly_compressible")
    # gamma: share of a surplus of n that the pressure takes out in a step
    compression: float | None = quantity("", None, least=0.0, most=1.0)  # None: 0.01 in pools, else 0.05
    tolerance: float = quantity("", 1e-3, above=0.0, most=0.1)  # of the pressure's equations
    iterations: int = whole(1000, least=1)  # of them, at most
    collision: float = quantity("", 0.7, least=0.0, most=0.95)  # distance at which two that approach collide
    restitution: float = quantity("", 0.2, least=0.0, most=1.0)  # of a collision
    # distance up to which two are of one piece: two alone rest at 1.5, where tension turns round; our choice
    piece: float = quantity("", 1.8, above=1.0, most=2.1)
    # pressure by equal and opposite forces of pairs, of sheets and drops, or inside a pool by corrected differences;
    # None: pairs where there is tension or a nozzle
    gradient: str | None = choice("pairs", "corrected", default=None)
    shift: float = quantity("", 0.05, least=0.0, most=0.2)  # by which particles inside a pool are kept apart, a step
    # whether a pool can hold together under a pressure below 0; None: full where there are no walls
    suction: str | None = choice("none", "full", default=None)
    # what a case of the weakly compressible method has that this one does without; filled in as it is read
    left_out: tuple = words(())

    def of_pools(self, case) -> bool:
        """True where the pressure acts by corrected differences."""
        if self.gradient is None:
            return "free_energy_tension" not in case.effects and not case.nozzles
        return self.gradient == "corrected"

    def sees(self, case) -> float:
        """Distance [l0] up to which particles act on each other."""
        pulled = "free_energy_tension" in case.effects
        return max(self.reach, self.piece, case.parameters["free_energy_tension"].reach if pulled else 0.0)

    def share_taken(self, case) -> float:
        """gamma."""
        return (0.01 if self.of_pools(case) else 0.05) if self.compression is None else self.compression

    def holds(self, case) -> bool:
        """True where a pressure below 0 is held at 0."""
        if self.suction is None:
            return "tank" in case.effects or not self.of_pools(case)
        return self.suction == "none"
