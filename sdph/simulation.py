"""One run: particles, gas, exchange, ledger. `Simulation.window` reads as the algorithm of the paper's figure 1."""

from __future__ import annotations

import math
import time as clock

import numpy as np

from coupling.transfer import Transfer, gather
from sdph import effects, particles, rates
from sdph.exchange import Exchange, Taken
from sdph.neighbours import Neighbours
from sdph.window import Window

REACH = 2.0  # support of the cubic spline in smoothing lengths


class Simulation:
    """Particles of a case coupled to a gas; call `window` until `time` is the end."""

    def __init__(self, case, gas, ledger):
        self.case, self.gas, self.ledger = case, gas, ledger
        self.kernel = rates.kernel_of(case)
        rows = [effects.REGISTRY[name] for name in case.effects]
        self.parameters = {row.name: effects.kernel_of(row, case) for row in effects.REGISTRY.values()}
        self.state = particles.fill(case, {name for row in rows for name in row.arrays})
        self.neighbours = Neighbours(REACH * case.smoothing_length)
        self.transfer = Transfer(gas.mesh, case.smoothing_length)
        self.exchange = Exchange(case, gas.mesh)
        self.clock = Window(case)
        self.moves = any(row.moves for row in rows)
        self.time, self.windows, self.sub_steps = 0.0, 0, 0
        self.wall = {"particles": 0.0, "exchange": 0.0, "gas": 0.0}

    def start(self) -> None:
        """Initial fields of both sides, and the first window."""
        self._prepare()
        one_way = self.case.coupling.one_way
        alpha_g = None if one_way else self.exchange.alpha_g(self.state, self.weights)
        self.gas_state = self.gas.start(alpha_g, () if one_way else self.exchange.sources)
        if not one_way:
            self.clock.begin(*self.exchange.pace(self.state, self.weights, self.gas_state))
        self.ledger.open(self.state, self.gas_state.budget)
        self.initial = {name: self.probe(probe.at)["temperature_K"] for name, probe in self.case.probes.items()}

    def window(self) -> None:
        """One window: exchange prepared, gas advanced, reaction taken, particles advanced."""
        end = self.clock.choose(self.time)
        dt = end - self.time
        handed = self._timed("exchange", self.exchange.hand, self.state, self.weights, self.gas_state, dt)
        sources = {} if self.case.coupling.one_way else handed.sources
        self.gas_state = self._timed("gas", self.gas.advance, dt, sources)
        taken = self._timed("exchange", self.exchange.take, handed, self.gas_state)
        self._timed("particles", self._advance, dt, taken)
        if self.moves:
            self._timed("particles", self._prepare)
        self.time, self.windows = end, self.windows + 1
        self.clock.learn(dt, taken.heat, self.gas_state.budget.courant)
        self.ledger.close_window(end, dt, self.clock.limit, self.state, self.gas_state, taken if sources else None)

    def probe(self, point) -> dict[str, float]:
        """Temperatures [K] of particles and gas at a point, by kernel interpolation; no particles near: nan."""
        here = np.zeros((1, 3))
        here[0, : len(point)] = point
        gas = gather(self.transfer.weights(here), self.gas_state.fields["temperature"])[0]
        r = np.sqrt(((particles.positions(self.state) - here) ** 2).sum(axis=1))
        near = np.flatnonzero(r < REACH * self.kernel.h)
        weight = self.state.mass[near] * (1.0 - r[near] / (REACH * self.kernel.h)) ** 2
        own = (weight * self.state.temperature[near]).sum() / weight.sum() if len(near) else math.nan
        return {"temperature_K": float(own), "gas_temperature_K": float(gas)}

    def _prepare(self) -> None:
        """Neighbours, density and transfer weights of where the particles are now."""
        self.state, self.rows = self.neighbours.update(self.state)
        rates.sum_density(self.kernel, self.state, self.rows, self.neighbours.box, self.state.density)
        self.weights = self.transfer.weights(particles.positions(self.state))

    def _advance(self, dt: float, taken: Taken) -> None:
        """Particles through the window in sub-steps, each no longer than the effects allow."""
        limits = {row.name: row.dt_limit(self.parameters[row.name], self.case, self.state) for row in self._on()}
        steps = max(1, math.ceil(dt / min(limits.values(), default=math.inf)))
        heating = np.zeros(len(self.state.x))
        for _ in range(steps):
            rates.rates(self.kernel, self.state, self.rows, self.neighbours.box, self.parameters["conduction"], heating)
            heat = heating * self.state.mass * (dt / steps) + taken.heat / steps
            self.state.temperature[:] += heat / (self.state.mass * self.case.grains.heat_capacity)
        self.sub_steps += steps

    def _on(self):
        return [effects.REGISTRY[name] for name in self.case.effects]

    def _timed(self, part: str, function, *arguments):
        start = clock.perf_counter()
        result = function(*arguments)
        self.wall[part] += clock.perf_counter() - start
        return result
