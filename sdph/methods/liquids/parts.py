"""Named walls of a tank: what its wall particles feel, shared out among those that `run.forces` names.

It is the sum that the ledger has (sdph.methods.liquids.account). A side of a box has what its particles feel (by
sdph.engine.walls.parts.sides). A part has the pressure on its own surface, and of friction what the particles behind it
feel: in corners, and in plates that are wet on both sides, whose particle it is does not say which face bears the load.
By as little as the pressure on all patches of the surface has to change for it, rather by one share everywhere (least
squares, weighed by what presses each), the sum over all of them is what presses all wall particles. What an outlet
pipe, bodies and particles that became walls feel is in the ledger alone.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from sdph.effects.around import tank
from sdph.engine import state as particles
from sdph.engine.walls import parts, patches, shapes
from sdph.laws.constants import TINY
from sdph.methods.liquids import walls

UNMOVED = 1e-3  # of the largest of what loads do: no wall that is wet has a normal along it; our choice
# times as much as by their directions, pressures change by one share everywhere: liquid stands a little further than
# half a spacing from every wall, so that their sum is too large by what the gap would hold; our choice (blocks are
# lifted to 4 % by 3 and 30 too)
EVENLY = 10.0


def sides(case, places: np.ndarray) -> dict[str, np.ndarray]:
    """Share (W, 3) in the force on each wall particle at `places` (W, d) [m], by its components, of the sides of a box
    and of the whole tank (sdph.engine.walls.parts)."""
    shape = tank.shape_of(case)
    inside = shape.tank if isinstance(shape, shapes.Joined) else shape
    of_box = parts.sides(places, inside.lower, inside.upper) if isinstance(inside, shapes.Box) else {}
    return of_box | {tank.ALL: np.ones((len(places), 3))}


class Surface:
    """The surface of a tank in patches, and of named parts the area (n, P, 3) [m^(d-1)] of each patch along its normal,
    and the share (n, W) of wall particles at `places` (W, d) [m]; parts that no wall is in are left out."""

    def __init__(self, case, names, places: np.ndarray):
        spacing, deep = case.resolution.spacing, ((0, 0), (0, 3 - case.dimensions))
        own = patches.found(tank.shape_of(case), places, spacing)
        inside = {name: parts.within(case.parts[name], own.places, shapes.ROUND_OFF * spacing) for name in names}
        self.names = tuple(name for name, here in inside.items() if here.any())
        number, area = len(self.names), np.pad(own.area, deep)
        chosen = np.array([inside[name] for name in self.names]).reshape(number, len(own.places))
        self.areas = np.array([own.sums(area * here[:, None]) for here in chosen]).reshape(number, len(own.particle), 3)
        held = own.sums(np.column_stack((np.ones(len(own.places)), chosen.T)))
        nearest = cKDTree(own.middle).query(places)[1]
        self.rubbed = (held[:, 1:] / np.maximum(held[:, :1], 1.0)).T[:, nearest]
        self.particle, self.middle, self.area = own.particle, np.pad(own.middle, deep), own.sums(area)

    def pressed(self, stepper, at: np.ndarray, whole: np.ndarray) -> np.ndarray:
        """(n, P, 3) [N] that presses each part by patches, 0 of those of other processes, where the wall particles
        stand `at` (W,) in a stepper, -1 for elsewhere; all are pressed by `whole` (3,) [N]."""
        size = np.linalg.norm(self.area, axis=1)
        here, normal = (at[self.particle] >= 0) & (size > 0.0), self.area / np.maximum(size, TINY)[:, None]
        pressure = np.zeros(len(here))
        pressure[here] = walls.on_surface(stepper, at[self.particle[here]], self.middle[here], normal[here])
        push, size = np.abs(pressure), size * here
        square = np.einsum("p,pi,pj->ij", push, normal, self.area)
        even, missing = push @ self.area, whole - pressure @ self.area
        told = stepper.world.sum(np.concatenate((square.ravel(), even, missing, [push @ size, size.sum()])))
        by, missing = np.column_stack((told[:9].reshape(3, 3), EVENLY * told[9:12])), told[12:15]
        change = np.linalg.pinv(by, rcond=UNMOVED / EVENLY) @ missing
        share = (push / told[15] if told[15] else here / told[16]) * np.linalg.norm(self.areas, axis=2)
        rest = share[..., None] * (missing - by @ change)
        return (pressure + push * (normal @ change[:3] + EVENLY * change[3]))[:, None] * self.areas + rest


class Parts:
    """Forces on the names in the walls of a tank, whose particles have the numbers `own`."""

    def __init__(self, case, state, own: range):
        places = particles.positions(state)[own.start : own.stop, : case.dimensions]
        known = [name for name in case.run.forces if name in tank.names(case)]
        asked, whole = [name for name in known if name in case.parts], sides(case, places) if known else {}
        self.own, self.surface = own, Surface(case, asked, places) if asked else None
        found = {name: whole[name] for name in known if name in whole and whole[name].any()}
        self.shares = np.array(list(found.values())).reshape(len(found), len(own), 3)
        self.names = (*found, *(self.surface.names if self.surface else ()))

    def pushed(self, stepper, felt: np.ndarray) -> np.ndarray:
        """(9 n,) of the n names, as of sdph.engine.walls.parts.gathered, from what the walls of a stepper feel, (W, 8)
        of sdph.methods.liquids.walls.wall_force."""
        number = stepper.state.ident[stepper.walls] - self.own.start
        here = (number >= 0) & (number < len(self.own))
        own, number, rubbed = stepper.walls[here], number[here], felt[here, 5:]
        pressed, places = felt[here, :3] - rubbed, particles.positions(stepper.state)[own]
        shares = self.shares[:, number]
        given = parts.gathered(places, shares * pressed, places, shares * rubbed)
        if self.surface:
            at = np.full(len(self.own), -1)
            at[number] = own
            of_parts = self.surface.pressed(stepper, at, pressed.sum(axis=0))
            more = parts.gathered(self.surface.middle, of_parts, places, self.surface.rubbed[:, number, None] * rubbed)
            given = np.concatenate((given, more))
        return given.ravel()
