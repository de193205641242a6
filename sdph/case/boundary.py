"""A patch of the gas mesh as a case gives it."""

from __future__ import annotations

import math

from sdph.engine.geometry import SIDES
from sdph.schema import choice, flag, quantity, record, vector

PEAK = {"uniform": 1.0, "parabolic": 1.5}  # profile of an inlet -> its largest velocity over the mean


@record
class Boundary:
    """A patch of the gas mesh: a side (or part of it: `span`), or without a side all that is left over."""

    kind: str = choice("wall", "slip_wall", "velocity_inlet", "pressure_outlet")
    side: str | None = choice(*SIDES, default=None)
    span: tuple | None = vector("m", None)
    velocity: tuple | None = vector("m_s", None)  # of the gas that comes in, or with which a wall slides along itself
    velocities: tuple | None = vector("", None)  # or rows [time s, velocity m/s] of the gas (sdph.case.inlets)
    profile: str = choice(*PEAK)  # of that gas along its side (sdph.case.inlet_profiles); `velocity` is its mean
    temperature: float | None = quantity("K", None, above=0.0)
    vapour_mass_fraction: float | None = quantity("", None, least=0.0, most=1.0)
    pressure: float | None = quantity("Pa", None)
    catches: bool = flag(False)  # a wall that grains and droplets stick to: they leave the run there, by `outflow`

    @property
    def lets_out(self) -> bool:
        """True where grains leave: through an outlet, or into a wall that they stick to."""
        return self.kind == "pressure_outlet" or self.catches

    @property
    def lets_in(self) -> bool:
        """True where gas comes in by a given velocity; a wall may have one too, with which it slides."""
        return self.kind == "velocity_inlet" and bool(self.strongest)

    @property
    def strongest(self) -> tuple | None:
        """Velocity [m/s], where it changes in time that of the row that is fastest."""
        rows = [row[1:] for row in self.velocities or ()]
        return max(rows, key=lambda row: math.hypot(*row)) if rows else self.velocity

    @property
    def fastest(self) -> float:
        """Largest speed [m/s] of the gas that comes in, at any time, or of the wall."""
        return PEAK[self.profile] * math.hypot(*(self.strongest or ()))
