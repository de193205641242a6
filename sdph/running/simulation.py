"""One run: particles, gas, exchange, ledger. `Simulation.window` reads as the algorithm of the paper's figure 1."""

from __future__ import annotations

import time as clock

import numpy as np

from coupling.gas import GasError, Unfinished
from coupling.transfer import Transfer, gather
from sdph import effects
from sdph.effects.around.inflow import Source
from sdph.effects.around.outflow import leaving, refuse_to_leave
from sdph.engine import state as particles
from sdph.engine.kept import Unfit
from sdph.engine.state import GRAIN, INFLOW
from sdph.engine.walls import sides as boundary
from sdph.exchange.exchange import Exchange
from sdph.exchange.window import Window, learned
from sdph.methods.grains import start
from sdph.methods.grains.method import Stepper
from sdph.methods.grains.window import Tally, of_those_that_left
from sdph.running import history, output
from sdph.running.beside import Beside

PART = 4.0  # a window that the gas cannot finish is taken again, so much shorter (our choice),
REPEATS = 4  # so often at most: down to 1/256
SAME_TIME = 1e-6  # of the end time: the gas sums up its windows with round-off; our choice


class Simulation:
    """Particles of a case coupled to a gas; call `window` until `time` is the end."""

    at_row = True  # the history has a row of every window
    # see sdph.engine.kept
    KEPT = ("time", "windows", "repeated", "wall", "stepper", "exchange", "clock", "ledger", "source", "beside")

    def __init__(self, case, gas, ledger):
        self.case, self.gas, self.ledger = case, gas, ledger
        self.parameters, self.source, self.stepper, self.clock = parts_of(case)
        self.moves = effects.moving(case)
        self.transfer = Transfer(gas.mesh, case.smoothing_length, case.domain.size)
        self.exchange = Exchange(case, gas.mesh, self.parameters)
        self.time, self.windows, self.repeated, self.grid = 0.0, 0, 0, None
        self.notices: list[str] = []  # for the user, until somebody has passed them on
        self._weights_now = None
        self.beside = Beside()  # other methods
        self.wall = {"particles": 0.0, "exchange": 0.0, "gas": 0.0}

    @staticmethod
    def time_of(kept: dict) -> float:
        """Time [s] of what was kept."""
        return kept["time"]

    def tables(self) -> list:
        """Ledgers that are open."""
        return [self.ledger.table, *(method.ledger.table for method in self.beside.methods.values())]

    @property
    def state(self):
        return self.stepper.state

    @property
    def weights(self):
        """Transfer weights of where the particles are between windows, made when somebody asks."""
        if self._weights_now is None:
            self._weights_now = self._weights()
        return self._weights_now

    @property
    def grains(self):
        """The particles that are in the gas."""
        return particles.grains(self.state)

    def start(self) -> None:
        """Initial fields of both sides, and the first window."""
        self._turn_over(self.case.coupling.window_largest)
        one_way = self.case.coupling.one_way
        alpha_g = (
            None
            if one_way or not self.case.coupling.voidage
            else self.exchange.alpha_g(self.state, self.weights, self._inside())
        )
        self.gas_state = self.gas.start(alpha_g, () if one_way else self.exchange.sources, self.exchange.fields)
        self.clock.obey(effects.window_limits(self.parameters, self.case, self.state))
        if not one_way:
            rate, stake, thickening, grip = self.exchange.pace(self.state, self.weights, self.gas_state)
            self.clock.begin(rate, stake)
            self.clock.thicken(1.0, thickening)
            self.clock.hold(grip)
        self.ledger.open(self.grains, self.gas_state.budget)
        self.beside.start()
        self.clock.touch(self.beside.limit(self.state))

    def admit(self, kept: dict) -> None:
        """Unfit where time is not that of the ledger, or particles have numbers that nobody gave."""
        if kept["time"] != kept["ledger"]["last"]["time_s"]:
            raise Unfit("its time is not that of the ledger")
        self.beside.refuse_other_times(kept["beside"], kept["time"])
        if self.source:
            self.source.admit_at(kept["time"], kept["source"])
        given = kept["source"]["next_ident"] if self.source else len(self.state.x) + 1
        ident = kept["stepper"]["state"]["ident"]
        if ident.min(initial=1) < 1 or ident.max(initial=1) > max(1, given - 1):
            raise Unfit(f"a particle has a number that is not among 1 to {given - 1}")

    def take_up(self, checkpoint) -> None:
        """Go back to the gas of a checkpoint, instead of `start`; what else was kept is put back next."""
        sources = () if self.case.coupling.one_way else self.exchange.sources
        self.gas_state = self.gas.restore(checkpoint.gas, sources, self.exchange.fields)
        self.stepper.guard.admit_gas(self.gas_state.fields)
        if abs(self.gas_state.time - checkpoint.time) > SAME_TIME * self.case.run.end_time:
            raise Unfit(f"its gas is at {self.gas_state.time:g} s, its particles are at {checkpoint.time:g} s")

    def window(self) -> None:
        """One window: exchange prepared, gas advanced, reaction taken, particles advanced."""
        end, handed = self._with_gas(self.clock.choose(self.time))
        dt = end - self.time
        taken = self._timed("exchange", self.exchange.take, self.state, handed, self.gas_state)
        self.clock.hold(self.exchange.grip(self.state, handed.damping))
        self.exchange.settle(self.state, handed)
        exchanged, body = learned(self.state, taken.heat, dt), self._body(handed)
        weight = np.einsum("i,ij->j", self.state.mass * (self.state.kind == GRAIN) * dt, body)
        momentum = self.state.mass[:, None] * dt
        touched = self.beside.touch(self.state, dt)
        pushed = np.divide(taken.impulse + touched, momentum, out=np.zeros_like(body), where=momentum > 0.0)
        self.stepper.force(taken.warming, body + pushed, handed.damping)
        self._without_finished()
        tally = Tally(self)
        self._timed("particles", self._advance, end)
        self.time, self.windows = end, self.windows + 1
        self.clock.learn(dt, *exchanged, self.gas_state.budget.courant, self._fastest())
        self.clock.thicken(dt, self.exchange.vapour_share(handed, self.gas_state))
        self.clock.obey(effects.window_limits(self.parameters, self.case, self.state))
        exchanged = taken.columns() | tally.columns(
            self, weight, np.einsum("ij->j", taken.impulse), touched.sum(axis=0)
        )
        exchanged |= {"drag_heat_J": self.exchange.drag_heat_of(handed)}
        exchanged |= self._timed("exchange", self._turn_over, self.clock.longest())
        self.clock.touch(self.beside.limit(self.state))
        self.ledger.close_window(end, dt, self.clock.limit, self.grains, self.gas_state, exchanged)

    def _advance(self, end: float) -> None:
        """All methods to `end` [s]."""
        (self.stepper.move if self.moves else self.stepper.conduct)(end - self.time)
        self.beside.advance(end)

    def _with_gas(self, end: float):
        """Gas through the window to `end` [s], or through the part of it that it can finish: where that ends, and what
        was handed."""
        for _ in range(REPEATS + 1):
            self.stepper.guard.begin(self, end - self.time)
            handed = self._timed("exchange", self._hand, end - self.time)
            failure = self._timed("gas", self._advance_gas, handed)
            if failure is None:
                return end, handed
            self.gas_state, tried = self.gas.retreat(), end - self.time
            end, self.repeated = self.time + tried / PART, self.repeated + 1
            self.notices.append(
                f"window {self.windows + 1}, t = {self.time:.6g} s: taken again, a quarter of {tried:.3g} s long, "
                f"because {failure}"
            )
        keys = f"coupling.window_largest_s below {tried:.2g} or coupling.courant (now {self.case.coupling.courant:g})"
        raise GasError(
            f"the gas cannot finish window {self.windows + 1} at t = {self.time:.6g} s, not even {tried:.3g} s of it: "
            f"{failure}; lower {keys}, "
            "or look at what enters there ([boundaries], [nozzles]) and at resolution.cell_mm"
        )

    def _advance_gas(self, handed) -> str | None:
        """Take the gas through a window; why that cannot count, or None."""
        try:
            self.gas_state = self.gas.advance(handed.dt, {} if self.case.coupling.one_way else handed.sources)
        except Unfinished as failure:
            return str(failure)
        return self.stepper.guard.gas(self)

    def row(self) -> dict[str, float]:
        """What history.csv holds; columns of other methods begin with their matter."""
        return history.row(self) | self.beside.named(lambda method: method.row())

    def meshes(self) -> dict:
        """Particles and gas for the timeline."""
        self.grid = self.grid or output.gas_grid(self.gas)
        return {
            "particles": output.particle_points(self.grains, self.case.grains.density),
            "gas": output.with_fields(*self.grid, self.cell_fields()),
        } | self.beside.points()

    def walls(self):
        """Surfaces of walls for pictures (pyvista); None where there are none: sides of the domain are seen anyway."""
        mesh = self.case.parameters["walls"].mesh if self.parameters["walls"] else ""
        parts = [boundary.surface(mesh, self.case.dimensions)] if mesh else []
        parts += self.beside.walls()
        return parts[0].append_polydata(*parts[1:]) if parts else None

    def summary(self, out) -> dict[str, float]:
        """summary.json, its own part; what probes rose by is told from the first and the last row of the history."""
        own = {
            "cells": len(self.gas.mesh.volumes),
            "sub_steps": self.stepper.steps,
            "wall_contacts": self.stepper.contacts,
        }
        own["windows_repeated"] = self.repeated
        for name in self.case.probes:
            own |= {key: out.last[key] for key in (f"{name}_{probed}" for probed in history.PROBED) if key in out.last}
            if (key := f"{name}_temperature_K") in out.last:
                own[f"{name}_rise_K"] = out.last[key] - out.first[key]
        return own | self.beside.named(lambda method: method.summary() | method.ledger.summary())

    def warnings(self) -> list[str]:
        """What the run has to say of itself in the end: of the grains nothing that the ledger does not."""
        return self.beside.warnings()

    def cell_fields(self) -> dict[str, np.ndarray]:
        """Fields of the gas, and alpha_p by cell."""
        return self.gas_state.fields | {
            "alpha_p": 1.0 - self.exchange.alpha_g(self.state, self.weights, self._inside())
        }

    def _hand(self, dt: float):
        """The exchange of a window of `dt`, from where the particles are in its middle (second order in their motion);
        the gas is told where they will be at its end."""
        middle, ahead = (self._weights(0.5 * dt), self._weights(dt)) if self.moves else (self.weights, self.weights)
        return self.exchange.hand(self.state, middle, (ahead, self._inside(dt)), self.gas_state, dt)

    def _inside(self, after: float = 0.0) -> np.ndarray:
        """Share of each particle that is in the gas, or will be `after` [s]."""
        return self.source.inside(self.state, after) if self.source else np.ones(len(self.state.x))

    def _weights(self, after: float = 0.0):
        """Transfer weights of where the particles are, or will be `after` [s]. Those upstream of a nozzle exchange
        nothing; they stand in for the nearest place in the box."""
        places = particles.positions(self.state) + particles.velocities(self.state) * after
        if self.source:
            waiting = self.state.kind == INFLOW
            size = (*self.case.domain.size, 0.0)[:3]
            places[waiting] = np.clip(places[waiting], 0.0, size)
        return self.transfer.weights(places)

    def _without_finished(self) -> None:
        """Particles that have evaporated are no more."""
        left = self.state.mass > 0.0
        if not left.all():
            self.stepper.replace(particles.take(self.state, left))
            self.stepper.prepare()

    def _turn_over(self, longest: float) -> dict[str, float]:
        """Between windows: what has evaporated or left is taken out, what comes in within `longest` [s] is made."""
        state, count = self.state, len(self.state.x)
        gone = leaving(self.case, state) if self.moves else np.zeros(count, bool)
        if gone.any() and not self.parameters["outflow"]:
            refuse_to_leave(self.case, state, gone, self.time)
        left = particles.take(state, gone) if gone.any() else None
        if left is not None:
            state = particles.take(state, ~gone)
        if self.source:
            state = self.source.fill(state, self.time, longest)
        replaced = state is not self.stepper.state
        if replaced:
            self.stepper.replace(state)
        changed = replaced or self.parameters["evaporation"]
        if changed or self.windows == 0:  # those that moved are prepared
            self.stepper.prepare()
        if changed or self.moves:
            self._weights_now = None
        if self.source and self.windows:
            self.clock.stake(self.exchange.stake(self.state, self.weights, self.gas_state))
        return of_those_that_left(self.case, left)

    def _fastest(self) -> float:
        """Speed of the fastest particle [m/s]."""
        return float(particles.lengths(particles.velocities(self.state)).max(initial=0.0)) if self.moves else 0.0

    def _body(self, handed) -> np.ndarray:
        """Gravity and the gas's pressure gradient, held over the window: (N, 3) [m/s2]."""
        body = np.zeros((len(self.state.x), 3))
        if self.parameters["gravity"]:
            body += self.parameters["gravity"]
        if self.parameters["gas_pressure"]:
            body -= gather(handed.weights, self.gas_state.fields["pressure_gradient"]) / self.case.grains.density
        return body

    def _timed(self, part: str, function, *arguments):
        start = clock.perf_counter()
        result = function(*arguments)
        self.wall[part] += clock.perf_counter() - start
        return result


def parts_of(case) -> tuple[dict, Source | None, Stepper, Window]:
    """Kernel parameters by effect, nozzles, stepper and clock of a case: all that a run begins with beside the gas."""
    rows = [effects.REGISTRY[name] for name in case.effects]
    parameters = {row.name: effects.kernel_of(row, case) for row in effects.REGISTRY.values()}
    names = {name for row in rows for name in row.arrays}
    state = start.fill(case, names)
    source = Source(case, names, len(state.x) + 1) if parameters["inflow"] else None
    clock = Window(case)
    return parameters, source, Stepper(case, parameters, state, source, clock.shortest), clock
