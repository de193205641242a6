"""Grains or droplets in a gas, as a run needs them (sdph.methods.method.Method): stepper, nozzles, what leaves."""

from __future__ import annotations

import numpy as np

from sdph import effects
from sdph.effects.around import by_nozzle
from sdph.effects.around.outflow import leaving, refuse_to_leave
from sdph.effects.around.source import Source
from sdph.effects.gas import micro_explosion
from sdph.engine import arrays, ashore, surface, world
from sdph.engine import state as particles
from sdph.engine.clock import Clock
from sdph.engine.kept import Unfit
from sdph.engine.ledger import vector
from sdph.engine.state import INFLOW
from sdph.engine.walls import facets
from sdph.engine.walls.parts import Pushed
from sdph.methods.grains import aboard, account, start
from sdph.methods.grains.history import Warmed, of_materials, tracked
from sdph.methods.grains.method import Stepper

# arrays of the state that are in fields
SHOWN = "ident", "kind", "mass", "density", "temperature", "diameter", "material", "nozzle", "theta", "sealed"
CAME_IN = ("mass", "energy", "motion", "masses", "momentum")  # what a source counts
APART = ("friction", "granular_pressure")  # effects that keep dense grains apart
PACKED = 1.02  # of the packing limit: less is noise of single particles; our choice
CROWDED = 1.2  # of it, in a cell of the gas, whose kernel sees an even bed up to 8 % off where cells jump; our choice
NOTHING_LEFT = {"left_kg": 0.0, "left_J": 0.0, "left_motion_J": 0.0} | vector("impulse_of_outflow", np.zeros(3))


class Grains:
    """Grains of a case and what they do in a window; their ledger is that of the gas too, which the run keeps."""

    matter = "grains"
    KEPT = ("time", "windows", "stepper", "source", "pushed", "warmed")  # see sdph.engine.kept

    def __init__(self, case):
        names = effects.arrays(case)
        self.case, self.moves = case, effects.moving(case)
        self.parameters = {row.name: effects.kernel_of(row, case) for row in effects.REGISTRY.values()}
        self.notices: list[str] = []  # on how the case was filled
        self.filled: dict[str, float] = {}  # mass [kg] of each region at the start
        own = world.ALONE if self.parameters["inflow"] else world.here()  # what nozzles give is numbered by all
        state = start.fill(case, names, self.notices, self.filled, own)
        self.made = own.sum(len(state.x))  # by all processes, at the start
        self.notices += start.never_there(case, self.made)
        self.source = Source(case, names, len(state.x) + 1) if self.parameters["inflow"] else None
        self.stepper = Stepper(case, self.parameters, state, self.source, Clock(case.run).shortest)
        self.world, self.stepper.domain.parted = self.stepper.world, own.number > 1
        self.time, self.windows, self.came, self.left = 0.0, 0, self._came_in(), self._nothing_left()
        self.pushed = Pushed("grain", "friction", self.stepper.parts, case.dimensions, case.run.average_from)
        self.warmed = Warmed(self.stepper.hot, case.run.average_from)
        self.gone = None  # State of what has left in the window
        self.packed = self.crowded = False  # True once it was told that they, or cells, are packed beyond their limit
        self.torn = dict(micro_explosion.NOTHING_TORN)  # in the window

    @property
    def state(self):
        """The particles of this process."""
        return self.stepper.own

    def ashore(self):
        """Context in which the particles lie in memory, for who reads them."""
        return ashore.ashore(self.stepper)

    @property
    def inside(self):
        """Particles of this process that are in the gas."""
        return particles.grains(self.state)

    @property
    def steps(self) -> int:
        return self.stepper.steps

    @property
    def heated(self) -> tuple[str, ...]:
        """Names of the walls that heat them."""
        return self.warmed.names

    @property
    def limit(self) -> str:
        return self.stepper.limit

    def admit(self, kept: dict) -> None:
        """Unfit where particles have numbers that nobody gave."""
        if self.source:
            self.source.admit_at(kept["time"], kept["source"])
        given = kept["source"]["next_ident"] if self.source else self.made + 1
        ident = kept["stepper"]["state"]["ident"]
        if ident.min(initial=1) < 1 or ident.max(initial=1) > max(1, given - 1):
            raise Unfit(f"a particle has a number that is not among 1 to {given - 1}")

    def start(self) -> None:
        """Let in what the nozzles give at first, and make room between grains and walls."""
        self.renew(self.case.coupling.window_largest)
        self.stepper.stand_off()
        self.stepper.tell()

    def begin(self) -> None:
        """Remember the state to go back to, before a window; the particles go where the case has them."""
        aboard.board(self.stepper)
        self.stepper.guard.begin(self)
        self.came, self.left, self.gone = self._came_in(), self._nothing_left(), None
        self.begun = self.time

    def force(self, warmth, push, damping) -> None:
        """Take heat (N,) [J], acceleration (N, 3) [m/s2] and damping (N,) [1/s] of theta that hold over the window;
        what has evaporated or burned is taken out."""
        self.stepper.force(warmth, push, damping)
        left = self.state.mass > 0.0
        if self.world.any(not left.all()):
            self.stepper.replace(particles.take(self.state, left))
            self.stepper.prepare()

    def advance(self, end: float) -> None:
        if len(self.state.warming):
            self.state.begun_temperature[:] = self.state.temperature
        (self.stepper.move if self.moves else self.stepper.conduct)(end - self.time)
        if len(self.state.warming):
            self.state.warming[:] = (self.state.temperature - self.state.begun_temperature) / (end - self.time)
        if own := self.parameters["micro_explosion"]:
            self.torn = micro_explosion.swollen(own, self.state, end - self.time)
        self.time, self.windows = end, self.windows + 1

    def close(self) -> None:
        """End the window, of which the history has a row; `way` and `damped` are what `Stepper.release` tells of it."""
        self._tell_packed()
        self.pushed.new_row()
        self.pushed.add(self.stepper.pushed(), self.begun, self.time)
        self.warmed.add(self.world.sum(self.stepper.account.gave), self.begun, self.time)
        self.way, self.damped = self.stepper.release()
        if self.source and self.world.number > 1:
            for name, before in zip(CAME_IN, self.came):  # through the mouths of all processes
                came = self.world.sum(getattr(self.source, name) - before)
                setattr(self.source, name, before + came)

    def renew(self, longest: float) -> bool:
        """Take out what has left, and make what comes in within `longest` [s]; tell whether particles are others, or
        elsewhere."""
        state, gone = self.state, leaving(self.case, self.state) if self.moves else np.zeros(len(self.state.x), bool)
        if gone.any():
            if not self.parameters["outflow"]:
                refuse_to_leave(self.case, state, gone, self.time)
            self.gone = particles.take(state, gone)
            self.left = self._of(self.gone)
            state = particles.take(state, ~gone)
        if self.source:
            state = self.stepper.domain.admitted(self.source.fill(state, self.time, longest))
        replaced = self.world.any(len(state.x) != len(self.state.x) or bool(gone.any()))
        if replaced:
            self.stepper.replace(state)
        changed = replaced or bool(self.parameters["evaporation"] or self.parameters["reaction"])
        if changed or self.windows == 0:  # those that moved are prepared
            self.stepper.prepare()
        return changed or self.moves

    def share_inside(self, after: float = 0.0) -> np.ndarray:
        """Share of each particle (N,) that is in the gas, or will be `after` [s]: none of those that will have left."""
        share = self.source.inside(self.state, after) if self.source else arrays.ones(len(self.state.x), self.state.x)
        if after and self.parameters["outflow"]:
            s = self.state
            ways = {x: getattr(s, x) + after * getattr(s, u) for x, u in zip("xyz", "uvw")}
            share[leaving(self.case, s._replace(**ways), foreseen=True)] = 0.0
        return share

    def places(self, after: float = 0.0) -> np.ndarray:
        """Positions (N, 3) [m] where the particles are, or will be `after` [s]. Those upstream of a nozzle exchange
        nothing; they stand in for the nearest place in the box."""
        places = particles.positions(self.state) + particles.velocities(self.state) * after
        if self.source:
            waiting = self.state.kind == INFLOW
            domain = self.case.domain
            places[waiting] = np.clip(places[waiting], (*domain.corner, 0.0)[:3], (*domain.upper, 0.0)[:3])
        return places

    def fastest(self) -> float:
        """Speed of the fastest particle [m/s]."""
        speed = float(particles.lengths(particles.velocities(self.state)).max(initial=0.0)) if self.moves else 0.0
        return self.world.most(speed)

    def columns(self) -> dict[str, float]:
        """Ledger columns of the window: what the grains got from where, and what came and left."""
        found = self.world.sums(account.columns(self.stepper.account) | self.torn | self.left)
        names = ("injected_kg", "injected_J", "injected_motion_J")
        found |= {name: now - before for name, now, before in zip(names, self._came_in(), self.came)}
        masses, momentum = (now - before for now, before in zip(self._came_in()[-2:], self.came[-2:]))
        found |= by_nozzle.columns(self.case, "injected", masses)
        found |= {key: found[key] + value for key, value in vector("impulse_of_inflow", momentum).items()}
        return found

    def totals(self) -> dict[str, float]:
        """Ledger columns of what there is in the gas: mass, thermal energy, motion, agitation, momentum."""
        state = self.inside
        velocity = particles.velocities(state)
        row = {"particle_mass_kg": float(state.mass.sum())}
        row["particle_kinetic_energy_J"] = float(0.5 * np.einsum("i,ij,ij->", state.mass, velocity, velocity))
        row["particle_fluctuation_energy_J"] = float(1.5 * state.mass @ state.theta) if len(state.theta) else 0.0
        gravity = -np.asarray(self.parameters["gravity"] or (0.0, 0.0, 0.0))
        row["particle_potential_energy_J"] = float(state.mass @ (particles.positions(state) @ gravity))
        row |= vector("particle_momentum", np.einsum("i,ij->j", state.mass, velocity))
        thermal = self.world.exact(self._enthalpy(state))
        return {"particles": self.world.sum(len(state.x)), "particle_energy_J": thermal} | self.world.sums(row)

    def row(self) -> dict[str, float]:
        """Columns of history.csv."""
        return tracked(self.case, self.stepper) | of_materials(self.case, self.inside) | self.warmed.row()

    def held(self) -> dict[str, float]:
        """Shares that its limiters hold, by column of history.csv."""
        return self.stepper.held

    def points(self):
        """Particles in the gas as pyvista points with their arrays and alpha_p."""
        with self.ashore():
            return self._points()

    def _points(self):
        import pyvista

        state = self.inside
        points = pyvista.PolyData(particles.positions(state))
        if not points.n_points:  # pyvista knows no empty arrays
            return points
        points["velocity"] = particles.velocities(state)
        points["alpha_p"] = state.density / particles.by_material(state.grain_density, self.case.grains.density)
        for name in SHOWN:
            if len(getattr(state, name)):
                points[name] = getattr(state, name)
        return points

    def walls(self):
        """Meshes of walls as a pyvista surface; None where there are none: sides of the domain are seen anyway."""
        own = self.case.parameters["walls"] if self.parameters["walls"] else None
        return facets.drawn(own.mesh, self.case.dimensions, surface.unit(own)) if own and own.mesh else None

    def summary(self) -> dict[str, float]:
        """Its part of summary.json."""
        own = {"sub_steps": self.steps, "wall_contacts": self.stepper.contacts} | self.warmed.summary()
        own |= {f"filled_{name}_kg": mass for name, mass in self.filled.items()}
        own |= ashore.told(self.stepper)
        return own | self.stepper.domain.summary(self.steps - self.stepper.steps_before)

    def warnings(self) -> list[str]:
        """Nothing that the ledger does not tell."""
        return []

    def _enthalpy(self, state) -> np.ndarray:
        if not len(state.temperature):
            return np.zeros(1)
        capacity = particles.by_material(state.grain_capacity, self.case.grains.heat_capacity)
        own = state.mass * state.temperature * capacity
        return own + state.bubble_heat if len(state.bubble_heat) else own

    def _came_in(self):
        """Mass [kg], enthalpy, energy of motion [J], mass of each [kg] and momentum [kg m/s] through the nozzles."""
        own = self.source
        return tuple(getattr(own, name) for name in CAME_IN) if own else (0.0, 0.0, 0.0, np.zeros(0), np.zeros(3))

    def _nothing_left(self) -> dict[str, float]:
        return NOTHING_LEFT | by_nozzle.columns(self.case, "left", np.zeros(len(self.case.nozzles)))

    def _tell_packed(self) -> None:
        """Tell once where grains are packed denser than their limit: something that keeps them apart is missing."""
        own = self.inside
        packed = own.density / particles.by_material(own.grain_density, self.case.grains.density)
        densest, most = self.world.most(float(packed.max(initial=0.0))), self.case.grains.packing_limit
        if self.packed or densest <= PACKED * most:
            return
        self.packed = True
        off = [name for name in APART if name not in self.case.effects]
        why = f"; {' and '.join(off)} would keep them apart: add to effects" if off else ""
        self.notices.append(
            f"t = {self.time:.4g} s: alpha_p is {densest:.3g}, beyond grains.packing_limit = {most:g}{why}"
        )

    def tell_crowded(self, alpha_g, centres) -> None:
        """Tell once of the cell of the gas, of those with `centres` (C, 3) [m], that is fullest beyond what packs:
        particles lie upon each other there, which a sum over neighbours does not show."""
        fullest, most = int(np.argmin(alpha_g)), self.case.grains.packing_limit
        if self.crowded or 1.0 - alpha_g[fullest] <= CROWDED * most:
            return
        self.crowded = True
        place = ", ".join(f"{x:.4g}" for x in centres[fullest, : self.case.dimensions])
        parts = "" if "grain_shifting" in self.case.effects else "; the effect grain_shifting parts them"
        self.notices.append(
            f"t = {self.time:.4g} s: the gas's cell at ({place}) m holds alpha_p = {1.0 - alpha_g[fullest]:.3g}, above "
            f"grains.packing_limit = {most:g}: particles lie upon each other there{parts}, and smaller ones "
            "(resolution.spacing_mm) do so less"
        )

    def _of(self, left) -> dict[str, float]:
        """Ledger columns of the grains that left."""
        momentum = np.einsum("i,ij->j", left.mass, particles.velocities(left))
        found = {"left_kg": float(left.mass.sum()), "left_J": float(self._enthalpy(left).sum())}
        found["left_motion_J"] = particles.energy_of_motion(left)
        if self.source:
            found |= by_nozzle.columns(self.case, "left", by_nozzle.masses(self.case, left.nozzle, left.mass))
        return found | vector("impulse_of_outflow", -momentum)
