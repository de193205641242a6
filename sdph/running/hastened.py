"""A droplet that grows slowly, in fewer steps: liquid and shell go by a time of their own until the shell tears.

`sdph.effects.liquids.time_scaling`: S seconds pass for heat and rates in each second of the motion. Ledgers go by the
motion's time, history and outputs by that of the droplet. After the first cut S is 1, the bubble vents through the
tear, and rows and outputs stand as close as the jet asks for.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from sdph.effects.liquids import time_scaling
from sdph.engine import motion, polygons
from sdph.running.alone import STRIDE, Alone
from sdph.running.tear import Tear
from sdph.running.together import Together

BREATH = 2e-5  # s of the motion, over which the pressure that inertia takes is a mean; our choice
ROWS, OUTPUTS = 40, 8  # of the history and of fields from the tear to the end; our choice


class Hastened(Together):
    """A liquid in a shell with a bubble in it."""

    # see sdph.engine.kept
    KEPT = (
        "windows", "wall", "clock", "bodies", "method", "limiters", "now", "pace", "speed", "inertia", "inertia_most",
        "viscous", "viscous_most", "most", "tear",
    )  # fmt: skip

    def __init__(self, case, ledger: Path):
        self.now, self.pace, self.speed = 0.0, 1.0, 0.0
        super().__init__(case, ledger)
        self.p = self.stepper.p["time_scaling"]
        self.inertia = self.inertia_most = 0.0  # pressure [Pa] that inertia takes, and the most over the bubble's
        self.viscous = self.viscous_most = 0.0  # the same of the gel's viscosity
        self.most = {"diameter_ratio_max": 1.0, "pressure_max_Pa": 0.0}
        self.tear, self.followed = Tear(self), False
        self.first, self.vapour = self._rim(), self.stepper.void.mass  # at the start
        self.radius = self._inner()

    @property
    def time(self) -> float:
        """Time [s] of the droplet."""
        return self.now

    @staticmethod
    def time_of(kept: dict) -> float:
        return kept["now"]

    def revive(self) -> None:
        """Set S as it was, and rows after a tear, once a checkpoint was put back."""
        self.bodies.hasten(self.pace, 1.0)
        if self.tear.time is None:
            self.radius = self._inner()
        else:
            self._follow()

    def start(self) -> None:
        super().start()
        self._hasten(time_scaling.pace(self.p, self.speed, self._mach(), self.pace))

    def _advance(self) -> None:
        self.bodies.begin()
        self.method.begin()
        begun, landmark = self.method.time, self.clock.next(self.now)
        end = begun + (landmark - self.now) / self.pace
        self.method.advance(end, STRIDE)
        passed = self.method.time - begun
        self.now = landmark if self.method.time == end else self.now + self.pace * passed
        self.tear.look(self.now)
        self.method.close()
        self.bodies.close(self.method.time, self.method.limit)
        self._learn(passed)

    def _learn(self, passed: float) -> None:
        """Speed of the wall, and S for the next window; from a tear on there is no wall."""
        if self.tear.time is not None:
            if self.pace != 1.0:
                self._hasten(1.0)
            if not self.followed:
                self._follow()
            return
        radius = self._inner()
        share, old = -math.expm1(-passed / self.p.averaging), self.speed
        self.speed += share * ((radius - self.radius) / passed - self.speed)
        self.radius = radius
        self.most["pressure_max_Pa"] = max(self.most["pressure_max_Pa"], self.stepper.void.pressure)
        self.most["diameter_ratio_max"] = max(self.most["diameter_ratio_max"], self.diameter_ratio())
        self._weigh(old, passed)
        self._hasten(time_scaling.pace(self.p, self.speed, self._mach(), self.pace))

    def _weigh(self, old: float, passed: float) -> None:
        """Mean pressure that inertia takes, and the most over that of the bubble."""
        void, case = self.stepper.void, self.case
        rate = (self.speed - old) / (passed * self.speed) if self.speed else 0.0
        outer = self._rim()
        taken = time_scaling.pressure(case.liquid.density, void.radius, outer, self.speed, rate)
        share = -math.expm1(-passed / BREATH)
        self.inertia += share * (taken - self.inertia)
        viscosity = case.liquid.viscosity if "laminar_viscosity" in case.effects else 0.0
        self.viscous = time_scaling.viscous_pressure(viscosity, void.radius, outer, self.speed)
        if void.pressure > 0.1 * self.most["pressure_max_Pa"] and void.pressure > 0.1 * self._around():
            self.inertia_most = max(self.inertia_most, abs(self.inertia) / void.pressure)
            self.viscous_most = max(self.viscous_most, abs(self.viscous) / void.pressure)

    def _around(self) -> float:
        return self.stepper.void.p.around

    def _hasten(self, pace: float) -> None:
        kick = pace / self.pace
        self.method.hasten(pace, kick)
        self.bodies.hasten(pace, kick)
        self.pace, self.speed = pace, self.speed * kick

    def _follow(self) -> None:
        """Rows and outputs from the tear on, and the end: a while after it, or when the run was to end before that."""
        clock, tear, self.followed = self.clock, self.tear.time, True
        clock.end = min(tear + self.p.after_tear, self.case.run.end_time)
        last = clock.end - tear
        ways = tear + last * np.arange(1, ROWS + 1) / ROWS
        shows = tear + last * np.arange(1, OUTPUTS + 1) / OUTPUTS
        clock.outputs = np.union1d(clock.outputs[clock.outputs <= tear], shows)
        clock.landmarks = np.union1d(clock.landmarks[clock.landmarks <= tear], np.union1d(ways, shows))
        clock.shortest = 1e-9 * last

    def _mach(self) -> float:
        """Highest speed of the gel over its sound's [-]."""
        own = self.stepper
        return math.sqrt(motion.fastest(own.state, own.active, own.acceleration)[0]) / self.case.liquid.sound_speed

    def _inner(self) -> float:
        """Radius [m] of a circle as large as the shell's lining."""
        points, _ = self.bodies.lining()
        return math.sqrt(polygons.area(*points.T) / math.pi)

    def _rim(self) -> float:
        """Mean distance [m] of the outermost circle from its middle."""
        points = self.bodies.hull()
        return float(np.hypot(*(points - points.mean(axis=0)).T).mean())

    def diameter_ratio(self) -> float:
        """D/D0 [-] of the shell's outermost circle."""
        return self._rim() / self.first

    def row(self) -> dict[str, float]:
        told = super().row() | {
            "time_s": self.now, "scaled_time_s": self.method.time, "time_scale": self.pace,
            "wall_speed_m_s": self.speed, "diameter_ratio": self.diameter_ratio(),
            "inertial_pressure_Pa": self.inertia, "viscous_pressure_Pa": self.viscous,
        }  # fmt: skip
        return told | self.stepper.heat.row() | self.tear.row()

    def summary(self, out) -> dict[str, float]:
        heat = self.stepper.heat.summary()
        return super().summary(out) | self.most | heat | self.tear.summary() | self._closure() | {
            "scaled_time_s": self.method.time, "inertial_pressure_largest_rel": self.inertia_most,
            "viscous_pressure_largest_rel": self.viscous_most,
        }  # fmt: skip

    def _closure(self) -> dict[str, float]:
        """Mass of gel and vapour, and energy of the motion, over what the bubble gave."""
        liquid, solid, void = self.ledger, self.solids.ledger, self.stepper.void
        gel = liquid.last["mass_kg"]
        first = liquid.first["mass_kg"] + self.vapour
        missing = liquid.sums["numerical_work_J"] + solid.sums["numerical_work_J"]
        given = abs(liquid.sums["work_of_bubble_J"])
        return {
            "whole_mass_drift_rel": abs(gel + void.mass + void.vented - void.owed - first) / first,
            "energy_drift_rel": abs(missing) / given if given else 0.0,
        }

    def warnings(self) -> list[str]:
        found = {"inertia": self.inertia_most, "the gel's viscosity": self.viscous_most}
        return super().warnings() + [
            f"{name} took {100.0 * most:.1f} % of the bubble's pressure at most (2 % is the specification's limit): "
            "lower time_scaling.wall_speed_cap_m_s"
            for name, most in found.items()
            if most > 0.02
        ]


def of(case, ledger: Path) -> Alone:
    """The run of a case without a gas."""
    if "time_scaling" in case.effects:
        return Hastened(case, ledger)
    return (Together if len(case.matters) > 1 else Alone)(case, ledger)
