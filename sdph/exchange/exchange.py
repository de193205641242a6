"""Exchange between particles and gas over one window: unconditionally stable, and equal on both sides.

For particle k with heat capacity C_k = m_k c, the share f_k = 1 - exp(-dt K_k/C_k) of it meets the gas, cell by
cell with the transfer weights w_kc (sdph-notes, section 3). The gas is handed, as implicit coefficient and source,

    eps_c V_c = sum_k w_kc C_k f_k/dt,      eps T_p V_c = sum_k w_kc C_k f_k/dt T_k

and from the temperature T'_c that it answers with, particle k takes exactly what the cells gave:

    Q_k = C_k f_k sum_c w_kc (T'_c - T_k)   [J].

Momentum goes the same way with m_k for C_k and the drag coefficient for K_k; other forces of the gas are held over the
window, and the gas gets their opposite. The heat of all of them, force times slip with the new gas velocity, is the
kinetic energy that both sides lose. It is known when the window is done: the gas gets it in the next one.

The gas is told by quantity (`coupling.gas.SOURCES`): conductance, drag and force are sums over effects; what else an
effect gives stands in its own file (`to_gas`).
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from coupling.transfer import gather
from sdph import effects
from sdph.effects import OFF
from sdph.effects.around import by_nozzle
from sdph.effects.gas import break_up, film, radiation, sizes, turbulent_dispersion
from sdph.engine import arrays
from sdph.engine.state import GRAIN, by_material, lengths
from sdph.exchange import bursts, equations, pulls
from sdph.exchange.amounts import Handed, Taken, outside
from sdph.exchange.burning import Burning
from sdph.exchange.cells import Cells, capacity_of
from sdph.exchange.equations import Seen, temperature_span
from sdph.exchange.vapour import Vapour
from sdph.exchange.window import held, settling

LOSING = Vapour, Burning  # what takes mass from particles: one of them at most


class Exchange:
    """The effects of a case that reach across to the gas."""

    KEPT = ("pending",)

    def __init__(self, case, mesh, parameters):
        self.case = case
        self.parameters = parameters
        self.sizes_p, self.film_p = sizes.kernel(case), film.kernel(case)
        self.cells = Cells(mesh, case.grains.density, case.coupling.voidage)
        self.volumes, self.world = self.cells.volumes, self.cells.world
        made = (kind(case, parameters[kind.name], self.sizes_p, self.cells) for kind in LOSING if parameters[kind.name])
        self.losing = next(made, None)
        self.bursting = parameters["micro_explosion"]
        rows = [effects.REGISTRY[name] for name in case.effects]
        names = dict.fromkeys(name for row in rows for name in row.sources)
        self.sources = tuple(name for name in names if name != "alpha_g" or case.coupling.voidage)
        self.fields = tuple(dict.fromkeys(name for row in rows for name in row.fields))
        self.holds = any(row.holds_force for row in rows)
        self.to_gas = {row.name: row.to_gas for row in rows if row.to_gas}
        self.origin = case.gas.temperature  # [K], of the heat that is exchanged
        self.pending = np.zeros(len(self.volumes))  # heat [J/m3] that the gas gets in the next window

    def alpha_g(self, state, weights, inside=1.0) -> np.ndarray:
        """Gas volume fraction of the cells; `inside` (N,) is the share of each particle that is in the gas."""
        return self.cells.room(weights, state.mass * inside, state.grain_density)

    def hand(self, state, weights, ahead, gas_state, dt) -> Handed:
        """Coefficients from the old gas state, and the sources for the gas.

        `ahead` are the weights of where the particles will be at the end of the window, and the share of each (N,) that
        will be in the gas: the volume fraction then is told to the gas.
        """
        thrown = bursts.throw(self.bursting.own, state, dt) if self.bursting else None
        state = state._replace(**thrown.after) if thrown else state
        seen, stirring = Seen(weights, gas_state, state, self.fields), self.parameters["turbulent_dispersion"]
        against, eddies = seen.own, None
        if stirring:
            inside = state.mass * (state.kind == GRAIN)
            drift = lengths(seen.apart + seen.own - self.cells.around(weights, inside, seen.own))
            pushed, eddies = turbulent_dispersion.stir(stirring, state, seen, drift, gas_state.time, dt)
            seen, against = seen.stirred(pushed), seen.own - pushed
        convection, conductance, damping, force = self._rates(state, seen)
        against = pulls.ahead(self.case, self.parameters, state, (damping, force), dt, against)
        loss = None
        if self.losing:
            rise = self._radiated(state, state.temperature, dt) - state.temperature
            beside = rise * state.mass * capacity_of(self.case, state) / dt  # W
            loss = self.losing.lose(state, weights, gas_state, seen, beside, convection, conductance, dt, thrown)
        kept = state.mass - loss.mass if loss else state.mass
        power = self.losing.power(loss, dt) if loss else OFF
        gone = kept == 0.0 if loss and len(force) else np.zeros(len(force), bool)
        missed = dt * float(lengths(force[gone]).sum())
        force[gone] = 0.0  # those that are gone at the window's end feel nothing in it
        heat_share, pull, shared_mass = (arrays.empty(len(state.x), state.x) for _ in range(3))
        equations.shares(
            state, self._radiated(state, state.temperature, 0.5 * dt), self.case.grains.heat_capacity, self.origin, dt,
            conductance, damping, kept, power, heat_share, pull, shared_mass,
        )  # fmt: skip
        there, inside = ahead
        handed = Handed(
            dt, weights, heat_share, pull, shared_mass, force, damping, arrays.copy(state.temperature), seen.own,
            kept * (state.kind == GRAIN), loss, self.origin,
        )  # fmt: skip
        alpha_g = self.cells.room(there, kept * inside, state.grain_density) if "alpha_g" in self.sources else None
        around = (seen.slip, seen.density)
        handed = replace(handed, alpha_g=alpha_g, gone=missed, around=around, against=against, eddies=eddies)
        return replace(handed, terms=self._terms(handed))

    def _rates(self, state, seen) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Rates of every particle now: heat conductance to the gas [W/K] by convection and in all, beta/(alpha_p rho_p)
        [1/s], and the force that is held [N]."""
        p, count = self.parameters, len(state.x)
        found = *(arrays.empty(count, state.x) for _ in range(3)), np.zeros((count if self.holds else 0, 3))
        equations.rates(
            p["drag"], p["heat"], p["radiation"], p["lift"], self.film_p, self.sizes_p, state, self.case.grains.density,
            seen.around, *found,
        )  # fmt: skip
        return found

    def _sums(self, handed: Handed) -> dict[tuple[str, str], np.ndarray]:
        """Amounts that each particle gives of what effects add up to; the keys as of `_terms`."""
        given = {}
        if "heat_coefficient" in self.sources:
            given |= {("heat_coefficient", "conductance"): handed.heat, ("heat", "conductance"): handed.pull}
        if "momentum_coefficient" in self.sources:
            given |= {
                ("momentum_coefficient", "drag"): handed.drag,
                ("momentum", "drag"): handed.drag[:, None] * handed.against,
            }
        return given | ({("momentum", "force"): -handed.force} if len(handed.force) else {})

    def _terms(self, handed: Handed) -> dict[tuple[str, str], np.ndarray]:
        """(quantity, sum or effect that it comes from) -> what it gives to the gas, per volume of the cells."""
        given = self._sums(handed)
        given |= {
            (quantity, name): own
            for name, to_gas in self.to_gas.items()
            for quantity, own in to_gas(handed, self.case).items()
        }
        own_terms = handed.loss.terms if handed.loss else {}
        if not given:
            return own_terms
        columns = [own[:, None] if own.ndim == 1 else own for own in given.values()]
        ends = np.cumsum([column.shape[1] for column in columns])
        cells = np.split(self.cells.density(handed.weights, np.concatenate(columns, axis=1)), ends[:-1], axis=1)
        terms = {key: cell[:, 0] if own.ndim == 1 else cell for (key, own), cell in zip(given.items(), cells)}
        return (
            terms | own_terms | ({("heat", "friction"): self.pending / handed.dt} if "momentum" in self.sources else {})
        )

    def pace(self, state, weights, gas_state) -> tuple:
        """Pace at the start: rate [1/s] at which the fastest cell takes the grains' temperature, `stake` [J], what
        `Window.thicken` is told of a second, `grip` [1/s] and `settling` [s]."""
        seen = Seen(weights, gas_state, state, self.fields)
        _, conductance, damping, force = self._rates(state, seen)
        full, resistance = self._resistance(state, weights, gas_state)
        rate = (
            float((self.cells.density(weights, conductance)[full] * resistance).max(initial=0.0))
            if "heat_coefficient" in self.sources
            else 0.0
        )
        losing = (self.losing.pace(state, weights, gas_state, seen), self.losing.name) if self.losing else (0.0,)
        held = self.grip(state, damping), self.settling(state, damping, force, seen.own, seen.slip)
        return rate, self.stake(state, weights, gas_state), losing, *held

    def lost(self, handed: Handed, gas_state) -> tuple:
        """Share and cause that `Window.thicken` is told of a window."""
        return (self.losing.share(handed, gas_state), self.losing.name) if self.losing else (0.0,)

    def stake(self, state, weights, gas_state) -> float:
        """A scale of heat [J]: the gas among the grains, and they, brought to equilibrium through all of the
        temperatures that the case has."""
        if "heat_coefficient" not in self.sources:
            return 0.0
        full, resistance = self._resistance(state, weights, gas_state)
        return float(temperature_span(self.case) * (self.volumes[full] / resistance).sum())

    def begin(self, state, weights, gas_state) -> dict[str, float]:
        """Columns of `Handed.held` at the start."""
        return outside(weights) | (self.losing.begin(state, weights, gas_state) if self.losing else {})

    def _resistance(self, state, weights, gas_state) -> tuple[np.ndarray, np.ndarray]:
        """Mask of the cells with grains, and 1/C_p + 1/C_g of these [m3 K/J]."""
        content = self.cells.density(weights, state.mass * (state.kind == GRAIN) * capacity_of(self.case, state))
        gas = (
            self.cells.gas(weights, state.mass * (state.kind == GRAIN), state.grain_density)
            * gas_state.fields["density"]
            * self.case.gas.heat_capacity
        )
        full = content > 0.0
        return full, 1.0 / content[full] + 1.0 / gas[full]

    def take(self, state, handed: Handed, gas_state) -> Taken:
        """The reaction on the particles, still as they were handed, from the new gas state with the old weights."""
        taken_heat, from_gas = np.zeros_like(handed.heat), 0.0
        impulse, force = np.zeros_like(handed.velocity), np.zeros((len(self.volumes), 3))
        if ("heat", "conductance") in handed.terms:
            temperature = gas_state.fields["temperature"] - self.origin
            taken_heat = handed.dt * (handed.heat * gather(handed.weights, temperature) - handed.pull)
            given = handed.terms["heat_coefficient", "conductance"] * temperature - handed.terms["heat", "conductance"]
            from_gas = float((given * self.volumes).sum() * handed.dt)
        if ("heat", "friction") in handed.terms:
            impulse, force = self._push(handed, gas_state.fields["velocity"])
        if self.case.coupling.one_way:  # the gas feels nothing
            from_gas, force = 0.0, np.zeros_like(force)
        given = np.einsum("ij,i->j", force, self.volumes) * handed.dt
        taken = Taken(taken_heat, taken_heat, impulse, from_gas, given, force)
        if handed.loss:
            taken = self.losing.taken(taken, handed)
        return self._with_radiation(taken, state, handed) if self.parameters["radiation"] else taken

    def settle(self, state, handed: Handed) -> dict[str, float]:
        """Take from the particles what they lose, keep their eddies, and let drops break; columns of the ledger."""
        if self.losing:
            self.losing.settle(state, handed)
        if handed.eddies is not None:
            turbulent_dispersion.apply(state, handed.eddies)
        own, lost = self.parameters["break_up"], by_nozzle.lost(self.case, state, handed.loss)
        return lost | (break_up.apply(own, state, *handed.around, handed.dt) if own else break_up.NOTHING_BROKEN)

    def _push(self, handed: Handed, velocity) -> tuple[np.ndarray, np.ndarray]:
        """Impulse (N, 3) [kg m/s] of drag and held force, and the force (C, 3) [N/m3] by which the gas gave it."""
        given, impulse = np.zeros_like(velocity), np.zeros_like(handed.velocity)
        if ("momentum", "drag") in handed.terms:
            apart = gather(handed.weights, velocity) - handed.against
            impulse += handed.dt * handed.drag[:, None] * apart
            given += handed.terms["momentum_coefficient", "drag"][:, None] * velocity - handed.terms["momentum", "drag"]
        if ("momentum", "force") in handed.terms:
            impulse += handed.dt * handed.force
            given -= handed.terms["momentum", "force"]
        return impulse, given

    def rub(self, handed: Handed, taken: Taken, gas_state, way, damped) -> float:
        """Keep for the next window the heat that motion becomes in this one, and return it [J].

        The gas tells the power that it lost; the particles get impulse.way/dt of it, `way` (N, 3) [m] being their mean
        velocity times dt; damped (N,) [J] is what theta loses to the gas. Vapour has no part in it: what its motion
        loses in that of the gas is of the order of u^2/c_p, and stays in `gas_dissipation_J` of the ledger.
        """
        if self.case.coupling.one_way or "momentum" not in self.sources:
            return 0.0
        made, lost = damped - np.einsum("ij,ij->i", taken.impulse, way) / handed.dt, -gas_state.fields["power"]
        if handed.loss:
            brought = handed.terms["momentum", self.losing.name]
            lost = lost + np.einsum("ij,ij->i", brought, gas_state.fields["velocity"])
        self.pending = lost * handed.dt + self.cells.density(handed.weights, made)
        return float(self.pending @ self.volumes)

    def _with_radiation(self, taken: Taken, state, handed: Handed) -> Taken:
        """The same with what leaves to the surroundings, half of it before and half of it after the exchange with the
        gas."""
        capacity, half = handed.mass * capacity_of(self.case, state), 0.5 * handed.dt
        before = self._radiated(state, handed.temperature, half)
        between = before + np.divide(taken.warming, capacity, out=np.zeros_like(capacity), where=capacity > 0.0)
        lost = capacity * (handed.temperature - before + between - self._radiated(state, between, half))
        return replace(taken, warming=taken.warming - lost, lost=lost)

    def _radiated(self, state, temperature, dt):
        """Temperatures (N,) [K] after dt [s] of radiation to the surroundings."""
        if not self.parameters["radiation"]:
            return temperature
        cooled = np.empty_like(temperature)
        radiation.cool(self.parameters["radiation"], self.sizes_p, state, temperature, dt, cooled)
        return cooled

    def grip(self, state, damping) -> float:
        """Rate [1/s], mean by mass, at which gas that a window holds stops grains (`sdph.exchange.window.held`);
        damping (N,) [1/s]. 0 where the gas does not feel the volume of the grains."""
        mass = state.mass * (state.kind == GRAIN)
        if not self.parameters["gas_pressure"] or self.case.coupling.one_way or not self.world.any(bool(mass.any())):
            return 0.0
        own = by_material(state.grain_density, self.case.grains.density)
        alpha_p = np.minimum(state.density / own, self.case.grains.packing_limit)
        return self.world.average(damping * held(alpha_p, self.case.gas.density / own), mass)

    def settling(self, state, damping, force, own, slip) -> float:
        """Longest window [s] in which grains drift right, by means of theirs by mass (`sdph.exchange.window.settling`):
        weight, field and what else of the gas a window holds, `force` (N, 3) [N] where there is any, damping (N,)
        [1/s], their velocity (N, 3) and slip (N,) [m/s]."""
        felt = (state.kind == GRAIN) & (damping > 0.0)
        if not self.world.any(bool(felt.any())):
            return math.inf
        pulled = pulls.steady(self.parameters, state)
        if len(force):
            pulled = pulled + force / state.mass[:, None]
        with np.errstate(divide="ignore"):  # of those that are not felt
            means = lengths(pulled), 1.0 / damping, np.maximum(lengths(own), slip), state.mass
        *means, mass = means if felt.all() else (each[felt] for each in means)
        return settling(self.case, *(self.world.average(each, mass) for each in means))

    def handed_heat(self, handed: Handed) -> float:
        """Heat of motion [J] that the gas was handed."""
        if ("heat", "friction") not in handed.terms or self.case.coupling.one_way:
            return 0.0
        return float((handed.terms["heat", "friction"] @ self.volumes) * handed.dt)
