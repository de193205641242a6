"""One run: particles, gas, exchange, ledger. `Simulation.window` reads as the algorithm of the paper's figure 1."""

from __future__ import annotations

import time as clock

import numpy as np

from coupling.transfer import Transfer, gather
from sdph import effects, particles
from sdph.exchange import Exchange
from sdph.ledger import vector
from sdph.step import Held, Stepper
from sdph.window import Window


class Simulation:
    """Particles of a case coupled to a gas; call `window` until `time` is the end."""

    def __init__(self, case, gas, ledger):
        self.case, self.gas, self.ledger = case, gas, ledger
        rows = [effects.REGISTRY[name] for name in case.effects]
        self.parameters = {row.name: effects.kernel_of(row, case) for row in effects.REGISTRY.values()}
        self.moves = any(row.moves for row in rows)
        state = particles.fill(case, {name for row in rows for name in row.arrays})
        self.stepper = Stepper(case, self.parameters, state)
        self.transfer = Transfer(gas.mesh, case.smoothing_length)
        self.exchange = Exchange(case, gas.mesh, self.parameters)
        self.clock = Window(case)
        self.time, self.windows = 0.0, 0
        self.wall = {"particles": 0.0, "exchange": 0.0, "gas": 0.0}

    @property
    def state(self):
        return self.stepper.state

    def start(self) -> None:
        """Initial fields of both sides, and the first window."""
        self.stepper.prepare()
        self.weights = self.transfer.weights(particles.positions(self.state))
        one_way = self.case.coupling.one_way
        alpha_g = None if one_way else self.exchange.alpha_g(self.state, self.weights)
        self.gas_state = self.gas.start(alpha_g, () if one_way else self.exchange.sources)
        if not one_way:
            self.clock.begin(*self.exchange.pace(self.state, self.weights, self.gas_state))
        self.ledger.open(self.state, self.gas_state.budget)
        self.received = None  # heat rate [W] of each particle from the gas in the last window

    def window(self) -> None:
        """One window: exchange prepared, gas advanced, reaction taken, particles advanced."""
        end = self.clock.choose(self.time)
        dt = end - self.time
        handed = self._timed("exchange", self._hand, dt)
        sources = {} if self.case.coupling.one_way else handed.sources
        self.gas_state = self._timed("gas", self.gas.advance, dt, sources)
        taken = self._timed("exchange", self.exchange.take, handed, self.gas_state)
        body, before, made = self._body(handed), self._momentum(), self.stepper.mechanical_heat
        impulse = body * (self.state.mass[:, None] * dt)
        self.received = Held(self.state, taken.heat / dt)
        if self.moves:
            drag = taken.impulse / (self.state.mass[:, None] * dt)
            self._timed("particles", self.stepper.move, dt, taken.heat, body + drag, handed.damping)
            self.weights = self._timed("exchange", self.transfer.weights, particles.positions(self.state))
        else:
            self._timed("particles", self.stepper.conduct, dt, taken.heat)
        self.time, self.windows = end, self.windows + 1
        self.clock.learn(dt, taken.heat, self.gas_state.budget.courant)
        exchanged = taken.columns() | vector("impulse_of_body_forces", impulse.sum(axis=0))
        rest = self._momentum() - before - impulse.sum(axis=0) - taken.impulse.sum(axis=0)
        exchanged |= vector("impulse_of_walls", rest) | {
            "drag_heat_J": self.exchange.drag_heat_of(handed),
            "mechanical_heat_J": self.stepper.mechanical_heat - made,
        }
        self.ledger.close_window(end, dt, self.clock.limit, self.state, self.gas_state, exchanged)

    def cell_fields(self) -> dict[str, np.ndarray]:
        """Fields of the gas, and alpha_p by cell."""
        return self.gas_state.fields | {"alpha_p": 1.0 - self.exchange.alpha_g(self.state, self.weights)}

    def _hand(self, dt: float):
        """The exchange of a window of `dt`; the gas is told where the particles will be at its end."""
        ahead = self.weights
        if self.moves:
            ahead = self.transfer.weights(particles.positions(self.state) + particles.velocities(self.state) * dt)
        return self.exchange.hand(self.state, self.weights, self.gas_state, dt, self.exchange.alpha_g(self.state, ahead))

    def _momentum(self) -> np.ndarray:
        return (self.state.mass[:, None] * particles.velocities(self.state)).sum(axis=0)

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
