"""One run: particles, gas, exchange, ledger. `Simulation.window` reads as the algorithm of the paper's figure 1."""

from __future__ import annotations

import contextlib

import numpy as np

from coupling.gas import Unfinished
from coupling.transfer import Transfer, gather
from sdph import effects
from sdph.effects.around import electric_field
from sdph.engine import arrays, gathered
from sdph.engine import state as particles
from sdph.engine.kept import Unfit
from sdph.exchange import vapour
from sdph.exchange.exchange import Exchange
from sdph.exchange.window import Window, learned
from sdph.methods.grains.grains import Grains
from sdph.running import compiling, fast_gas, forces, haze, history, openings, outlet, output, through_gas
from sdph.running.averages import Averages
from sdph.running.beside import Beside
from sdph.running.limiters import Limiters
from sdph.running.work import Pushes

SAME_TIME = 1e-6  # of the end time: the gas sums up its windows with round-off; our choice


class Simulation:
    """Grains of a case coupled to a gas, and other methods beside them; call `window` until `time` is the end."""

    at_row = True  # the history has a row of every window
    # see sdph.engine.kept
    KEPT = ("repeated", "wall", "grains", "exchange", "clock", "ledger", "beside", "limiters", "outlet", "averages")

    def __init__(self, case, gas, ledger):
        self.case, self.gas, self.ledger = case, gas, ledger
        self.grains, self.clock = Grains(case), Window(case)
        self.parameters = self.grains.parameters
        self.transfer = Transfer(gas.mesh, case.smoothing_length, case.domain.size, case.domain.corner)
        self.exchange = Exchange(case, gas.mesh, self.parameters)
        self.repeated, self.grid, self.world = 0, None, self.stepper.world
        self.notices = self.grains.notices  # for the user, until somebody has passed them on
        self._weights_now, self.at_boundaries = None, {}  # what the gas did there in the last window
        self.beside, self.limiters = Beside(), Limiters()  # other methods; what limiters hold
        self.outlet, self.averages = outlet.beside(case, ledger.table), Averages(case, gas.mesh)
        self.wall = dict.fromkeys(("particles", "exchange", "gas", "compiling"), 0.0)

    @staticmethod
    def time_of(kept: dict) -> float:
        """Time [s] of what was kept."""
        return kept["grains"]["time"]

    @staticmethod
    def windows_of(kept: dict) -> int:
        """Windows of what was kept."""
        return kept["grains"]["windows"]

    def tables(self) -> list:
        """Ledgers that are open."""
        own = [self.outlet.table] if self.outlet else []
        return [self.ledger.table, *own, *(method.ledger.table for method in self.beside.methods.values())]

    @property
    def time(self) -> float:
        return self.grains.time

    @property
    def windows(self) -> int:
        return self.grains.windows

    @property
    def state(self):
        """The particles of this process."""
        return self.grains.state

    @property
    def stepper(self):
        return self.grains.stepper

    @contextlib.contextmanager
    def whole(self):
        """Context in which the first process holds all particles, and no other any; True there."""
        kept = self._weights_now
        with self.grains.ashore(), gathered.whole(self.stepper) as chief:
            self._weights_now = kept if self.world.number == 1 else None
            yield chief
        self._weights_now = kept

    @property
    def methods(self) -> list:
        """Grains, and other methods beside them."""
        return [self.grains, *self.beside.methods.values()]

    @property
    def weights(self):
        """Transfer weights of where the particles are between windows, made when somebody asks."""
        if self._weights_now is None:
            self._weights_now = self.transfer.weights(self.grains.places())
        return self._weights_now

    def start(self) -> None:
        """Initial fields of both sides, and the first window."""
        self.grains.start()
        if self.outlet:
            self.outlet.start()
        one_way = self.case.coupling.one_way
        alpha_g = None if one_way or not self.case.coupling.voidage else self._alpha_g()
        self.gas_state = self.gas.start(alpha_g, () if one_way else self.exchange.sources, self.exchange.fields)
        self._begin_exchange()
        self.ledger.open(self._totals(), self.gas_state.budget)
        self.at_boundaries = self._at_boundaries(None, 0.0)
        held = self.exchange.begin(self.state, self.weights, self.gas_state)
        self._obey_effects()
        self._hear(held | self.gas_state.budget.held)
        self.beside.start()
        self.clock.obey({"contact": self.beside.limit(self.state)})

    def _hear(self, of_exchange: dict[str, float]) -> None:
        """Hear what limiters of the grains, of the exchange and of other methods hold."""
        of_gas = of_exchange | fast_gas.columns(self.case, self.gas_state.fields)
        self.limiters.hear(self.grains.held() | of_gas | self.beside.named(lambda method: method.held()))

    def admit(self, kept: dict) -> None:
        """Unfit where time is not that of the ledger."""
        time = self.time_of(kept)
        if time != kept["ledger"]["last"]["time_s"]:
            raise Unfit("its time is not that of the ledger")
        self.beside.refuse_other_times(kept["beside"], time)

    def take_up(self, checkpoint) -> None:
        """Go back to the gas of a checkpoint, instead of `start`; what else was kept is put back next."""
        sources = () if self.case.coupling.one_way else self.exchange.sources
        self.gas_state = self.gas.restore(checkpoint.gas, sources, self.exchange.fields)
        self.stepper.guard.admit_gas(self.gas_state.fields)
        if abs(self.gas_state.time - checkpoint.time) > SAME_TIME * self.case.run.end_time:
            raise Unfit(f"its gas is at {self.gas_state.time:g} s, its particles are at {checkpoint.time:g} s")

    def window(self) -> None:
        """One window: exchange prepared, gas advanced, reaction taken, particles advanced and renewed."""
        before = self.gas_state.budget
        end, handed = through_gas.advance(self, self.clock.choose(self.time))
        dt = end - self.time
        taken = self.timed("exchange", self.exchange.take, self.state, handed, self.gas_state)
        self.at_boundaries = self._at_boundaries(before, dt)
        changed = self._look_back(handed, taken, dt)
        broken = self.exchange.settle(self.state, handed)
        pushes = self._react(handed, taken, dt)
        self.timed("particles", self._advance, end)
        self.grains.close()
        exchanged = self._exchanged(handed, taken, broken, pushes)
        self._look_ahead(handed, changed, dt)
        self.timed("exchange", self._renew)
        self.clock.obey({"contact": self.beside.limit(self.state)})
        totals, budget = self._totals(), self.gas_state.budget
        self.ledger.close_window(end, dt, self.clock.limit, totals, budget, exchanged | self.grains.columns())
        self.timed("exchange", self.averages.add, self, end - dt, end)

    def _look_back(self, handed, taken, dt: float) -> list[float]:
        """Take note of what the gas did in a window of `dt` [s] to grains as they were handed, which the next one has
        to bear; heat [J] that they exchanged, and how its rate changed [W] (sdph.exchange.window.learned)."""
        self.clock.hold(self.exchange.grip(self.state, handed.damping))
        settling = self.exchange.settling(self.state, handed.damping, handed.force, handed.velocity, handed.around[0])
        self.clock.obey({"settling": settling})
        return self.world.sum(np.array(learned(self.state, taken.heat, dt))).tolist()

    def _exchanged(self, handed, taken, broken, pushes) -> dict[str, float]:
        """Ledger columns of what was exchanged and has `broken`, once the grains have gone their way."""
        way = self.grains.way
        self._hear(handed.held() | self.gas_state.budget.held)
        exchanged = self.world.sums(taken.columns() | handed.columns() | pushes.columns(way) | broken)
        exchanged |= taken.columns_of_gas() | {"drag_heat_J": self.exchange.handed_heat(handed)}
        return exchanged | {"friction_J": self.exchange.rub(handed, taken, self.gas_state, way, self.grains.damped)}

    def _look_ahead(self, handed, changed: list[float], dt: float) -> None:
        """Take note of how long the next window may be, from one of `dt` [s] just done and how heat `changed` in it."""
        self.clock.learn(dt, *changed, self.gas_state.budget.courant, self.grains.fastest())
        self.clock.thicken(dt, *self.exchange.lost(handed, self.gas_state))
        self._obey_effects()

    def _begin_exchange(self) -> None:
        """Limit the first window in which there is something to exchange, by the rates of now: none is learned yet."""
        rate, stake, losing, grip, settling = self.exchange.pace(self.state, self.weights, self.gas_state)
        self.clock.obey({"settling": settling})
        if not self.case.coupling.one_way:
            self.clock.begin(rate, stake)
            self.clock.thicken(1.0, *losing)
            self.clock.hold(grip)

    def _obey_effects(self) -> None:
        """Take note of the longest windows that effects bear now."""
        self.clock.obey(self.world.leasts(effects.window_limits(self.parameters, self.case, self.state)))

    def _react(self, handed, taken, dt: float) -> Pushes:
        """Put on the particles what holds over a window of `dt` [s]: the answer of the gas, gravity, contact."""
        if self.exchange.losing:
            self.stepper.prepare()  # pairs of the masses that are left: else what one gives the other does not get
        body, touched = self._body(handed), self.beside.touch(self.state, dt)
        held = Pushes(self.state, dt, taken.impulse, touched, *body)
        self.grains.force(taken.warming, held.push, handed.damping)
        return held

    def _advance(self, end: float) -> None:
        """All methods to `end` [s]."""
        self.grains.advance(end)
        self.beside.advance(end)

    def _renew(self) -> None:
        """Take, between windows, particles that come and go; there may be more to exchange then."""
        if self.grains.renew(self.clock.longest()):
            self._weights_now = None
        if self.outlet:
            self.outlet.note(self.time, self.grains.gone, self.world)
        if not self.grains.source:
            return
        if self.clock.idle:
            self._begin_exchange()
        else:
            self.clock.stake(self.exchange.stake(self.state, self.weights, self.gas_state))

    def _totals(self) -> dict[str, float]:
        """Ledger columns of the grains, and of heat that is on its way to the gas."""
        return self.grains.totals() | {"heat_on_its_way_J": float(self.exchange.pending @ self.exchange.volumes)}

    def _alpha_g(self) -> np.ndarray:
        """Gas volume fraction of the cells now."""
        return self.exchange.alpha_g(self.state, self.weights, self.grains.share_inside())

    def advance_gas(self, handed) -> str | None:
        """Take the gas through a window with what it is `handed`; why that cannot count, or None."""
        try:
            self.gas_state = self.gas.advance(handed.dt, {} if self.case.coupling.one_way else handed.sources)
        except Unfinished as failure:
            return str(failure)
        return self.stepper.guard.gas(self.gas_state.fields, self.gas.mesh.centres)

    def _at_boundaries(self, before, time: float) -> dict[str, float]:
        """Means over `time` [s], from a budget on (None: since the start), of the gas: its forces on boundaries, and
        what goes through openings."""
        given = self.case, self.gas.mesh.depth, before, self.gas_state.budget, time
        return forces.mean(*given) | openings.mean(*given)

    def row(self) -> dict[str, float]:
        """Columns of history.csv; those of other methods begin with their matter."""
        own = history.row(self) | self.at_boundaries | forces.row(self.methods) | self.limiters.now
        return own | self.beside.named(lambda method: method.row())

    def meshes(self) -> dict:
        """Particles of this process for the timeline, and the gas at the first one."""
        fields, found = self.cell_fields(), {"particles": self.grains.points()}
        if self.world.chief:
            self.grid = self.grid or output.gas_grid(self.gas)
            found["gas"] = output.with_fields(*self.grid, fields)
        return found | self.beside.points()

    def walls(self):
        """Surfaces of walls for pictures (pyvista); None where there are none."""
        parts = [own for own in (self.grains.walls(), *self.beside.walls()) if own is not None]
        return parts[0].append_polydata(*parts[1:]) if parts else None

    def summary(self, out) -> dict[str, float]:
        """summary.json, its own part."""
        own = {"cells": len(self.gas.mesh.volumes)} | self.grains.summary() | {"windows_repeated": self.repeated}
        own |= self.limiters.summary() | (self.outlet.summary() if self.outlet else {})
        time = self.averages.time(self.time)
        own |= {f"mean_{name}": value for name, value in self._at_boundaries(self.averages, time).items()}
        own |= forces.summary(self.methods) | history.in_the_end(self.case, out.first, out.last)
        return own | self.beside.named(lambda method: method.summary() | method.ledger.summary())

    def warnings(self) -> list[str]:
        """Notes for the user on how the run went."""
        of_gas = vapour.refusals(self.ledger) + fast_gas.warnings(self.case, self.limiters.largest)
        return self.grains.warnings() + of_gas + haze.warnings(self) + self.beside.warnings()

    def cell_fields(self) -> dict[str, np.ndarray]:
        """Fields of the gas, and alpha_p by cell."""
        return self.gas_state.fields | {"alpha_p": 1.0 - self._alpha_g()}

    def hand(self, dt: float):
        """The exchange of a window of `dt`, from where the particles are in its middle (second order in their motion);
        the gas is told where they will be at its end."""
        if self.grains.moves:
            middle, ahead = (self.transfer.weights(self.grains.places(after)) for after in (0.5 * dt, dt))
        else:
            middle = ahead = self.weights
        return self.exchange.hand(self.state, middle, (ahead, self.grains.share_inside(dt)), self.gas_state, dt)

    def _body(self, handed) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Gravity (3,), the gas's pressure gradient and the electric field (N, 3), held over the window [m/s2]."""
        pressed = arrays.zeros((len(self.state.x), 3), self.state.x)
        if self.parameters["gas_pressure"]:
            own = particles.by_material(self.state.grain_density[:, None], self.case.grains.density)
            pressed -= gather(handed.weights, self.gas_state.fields["pressure_gradient"]) / own
        return self.stepper.gravity, pressed, electric_field.acceleration(self.parameters["electric_field"], self.state)

    def timed(self, part: str, function, *arguments):
        """Result of a function; its wall time [s] counts for a part of `wall`."""
        return compiling.timed(self.wall, part, function, *arguments)
