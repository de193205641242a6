"""Named parts of a tank: what its wall particles feel, shared out among those that `run.forces` names.

It is the sum that the ledger has (sdph.methods.liquids.account), over the particles of each part. What an outlet pipe,
bodies and particles that became walls feel is in the ledger alone.
"""

from __future__ import annotations

import numpy as np

from sdph.effects.around import tank
from sdph.engine import state as particles
from sdph.engine.walls import parts, shapes

STEP = 1e-3  # spacings, to find the way to a surface by differences; our choice


def shares(case, places: np.ndarray) -> dict[str, np.ndarray]:
    """Share (W, 3) in the force on each wall particle at `places` (W, d) [m], by its components, of those names of
    `run.forces` that are walls of the tank (sdph.engine.walls.parts)."""
    known = tank.names(case)
    asked = [name for name in case.run.forces if name in known]
    if not asked:
        return {}
    shape = tank.shape_of(case)
    inside = shape.tank if isinstance(shape, shapes.Joined) else shape
    of_box = parts.sides(places, inside.lower, inside.upper) if isinstance(inside, shapes.Box) else {}
    found = of_box | {tank.ALL: np.ones((len(places), 3))}
    if set(asked) & case.parts.keys():
        feet = _feet(shape, places, STEP * case.resolution.spacing)
        found |= {name: parts.within(own, feet, case.resolution.spacing) for name, own in case.parts.items()}
    return {name: found[name] for name in asked if found[name].any()}


def _feet(shape, places: np.ndarray, step: float) -> np.ndarray:
    """Places (W, d) [m] of the surface in front of wall particles: r - D grad D of the distance D, by differences."""
    ways = step * np.eye(places.shape[1])
    rise = np.stack([shape.distance(places + way) - shape.distance(places - way) for way in ways], axis=1)
    return places - shape.distance(places)[:, None] * rise / (2.0 * step)


class Parts:
    """Shares of the names in the walls of a tank, whose particles have the numbers `own`."""

    def __init__(self, case, state, own: range):
        places = particles.positions(state)[own.start : own.stop, : case.dimensions]
        self.own, found = own, shares(case, places)
        self.names = tuple(found)
        self.shares = np.array(list(found.values())).reshape(len(found), len(own), 3)

    def pushed(self, stepper, felt: np.ndarray) -> np.ndarray:
        """(9 n,) of the n names, as of sdph.engine.walls.parts.gathered, from what the walls of a stepper feel, (W, 8)
        of sdph.methods.liquids.walls.wall_force."""
        number = stepper.state.ident[stepper.walls] - self.own.start
        here = (number >= 0) & (number < len(self.own))
        places, rubbed = particles.positions(stepper.state)[stepper.walls[here]], felt[here, 5:]
        given = parts.gathered(self.shares[:, number[here]], places, felt[here, :3] - rubbed, rubbed)
        return given.ravel()
