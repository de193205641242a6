"""Means over time, from `run.average_from` on: what the gas did at boundaries until then, and profiles."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.sparse import csr_array

from sdph.case import probed, slices
from sdph.engine import state as particles
from sdph.engine.walls.parts import counts
from sdph.engine.world import here
from sdph.methods.grains.history import carried
from sdph.running import output
from sdph.schema import CaseError

OF_GRAINS = ("temperature", "theta")  # beside their velocity, each by mass


class Averages:
    """Beginning of the means of a run, and its profiles; `patches` and `crossed` as of `coupling.gas.Budget`."""

    KEPT = ("since", "patches", "crossed", "profiles")  # see sdph.engine.kept

    def __init__(self, case, mesh):
        self.start, self.since = case.run.average_from, 0.0
        self.patches = {name: np.zeros((3, 3)) for name in case.boundaries}
        self.crossed = {name: np.zeros(4) for name in case.boundaries}
        self.profiles = {name: Sliced(case, mesh, name) for name in case.profiles}

    def add(self, run, begun: float, end: float) -> None:
        """Take the window of a run from `begun` to `end` [s]."""
        if not counts(begun, end, self.start):
            self.since, budget = end, run.gas_state.budget
            self.patches = {name: np.array(budget.patches[name]) for name in self.patches}
            self.crossed = {name: np.array(budget.crossed[name]) for name in self.crossed}
        elif self.profiles:
            cells = in_cells(run)
            for own in self.profiles.values():
                own.add(cells, end - begun)

    def time(self, now: float) -> float:
        """Time [s] that means are of; 0 where none is taken yet."""
        return now - self.since


def write(folder: Path, run) -> None:
    """A table profile_NAME.csv of each profile of a run, as it is now."""
    for name in run.case.profiles if run.case.grains and here().chief else ():
        output.write_rows(folder / f"profile_{name}.csv", run.averages.profiles[name].rows())


def summed(case) -> tuple[list[str], list[str]]:
    """Names of what is summed of grains and of gas: volume, mass, pressure, and what goes with mass times it."""
    velocity = [f"velocity_{a}" for a in "xyz"[: case.dimensions]]
    materials = [f"{name}_volume" for name in case.materials] if case.mixed else []
    grains = [name for name in OF_GRAINS if name in carried(case)]
    vapour = ["vapour_mass_fraction"] if case.vapour else []
    return (
        ["volume", "mass", *materials, *velocity, *grains],
        ["mass", "pressure", *velocity, "temperature", *vapour],
    )


def in_cells(run) -> np.ndarray:
    """(k, C) of all that is `summed`, by volume of the cells, and the pressure."""
    with run.grains.ashore():
        weights = run.transfer.weights(run.grains.places())
        grains = run.exchange.cells.density(weights, np.stack([*_of_grains(run).values()], axis=1)).T
    fields = run.gas_state.fields
    room = 1.0 - grains[0] if run.case.coupling.voidage else np.ones(len(grains[0]))
    mass = room * fields["density"]
    own = {f"velocity_{a}": values for a, values in zip("xyz", fields["velocity"].T)} | fields
    gas = [mass * own[name] for name in summed(run.case)[1][2:]]
    return np.array([*grains, mass, fields["pressure"], *gas])


def _of_grains(run) -> dict[str, np.ndarray]:
    """Amounts (N,) of what is `summed` of grains."""
    case, state = run.case, run.state
    mass = state.mass * run.grains.share_inside()
    volume = mass / particles.by_material(state.grain_density, case.grains.density)
    own = {f"velocity_{a}": mass * getattr(state, u) for a, u in zip("xyz"[: case.dimensions], "uvw")}
    own |= {f"{name}_volume": volume * (state.material == n) for n, name in enumerate(case.materials) if case.mixed}
    own |= {name: mass * getattr(state, name) for name in OF_GRAINS if name in carried(case)}
    own |= {"volume": volume, "mass": mass}
    return {name: own[name] for name in summed(case)[0]}


class Sliced:
    """Sums over the cells of each slice of a profile, and over time, of what there is in them."""

    KEPT = ("sums", "time")  # see sdph.engine.kept

    def __init__(self, case, mesh, name: str):
        self.case, self.own, self.time = case, case.profiles[name], 0.0
        edges = slices.edges(case, self.own)
        self.middles = (0.5 * (edges[1:] + edges[:-1])).round(slices.DIGITS)
        number = np.searchsorted(edges, slices.places(self.own, mesh.centres), side="right") - 1
        number[~slices.within(case, self.own, mesh.centres)] = -1
        there = (number >= 0) & (number < len(self.middles))
        if not there.any():
            raise CaseError(f"profiles.{name}: no cell of the gas has its middle in its box; move or widen it")
        places, volumes = (number[there], np.flatnonzero(there)), (mesh.volumes / mesh.depth)[there]
        self.matrix = csr_array((volumes, places), shape=(len(self.middles), len(number)))
        self.volumes = self.matrix.sum(axis=1)
        self.sums = np.zeros((sum(map(len, summed(case))), len(self.middles)))

    def add(self, cells: np.ndarray, dt: float) -> None:
        """Take what is `in_cells` (k, C) for a time `dt` [s]."""
        self.sums += dt * (self.matrix @ cells.T).T
        self.time += dt

    def rows(self) -> list[dict[str, float]]:
        """The table: a row a slice that has cells; nan of what there is none of."""
        there = self.volumes > 0.0
        of_grains, of_gas = summed(self.case)
        room, sums = self.volumes[there] * self.time, self.sums[:, there]
        with np.errstate(invalid="ignore", divide="ignore"):
            found = {f"{self.own.along}_m": self.middles[there]}
            found |= _told("", dict(zip(of_grains, sums)), room)
            found |= _told("gas_", dict(zip(of_gas, sums[len(of_grains) :])), room)
        return [dict(zip(found, map(float, row))) for row in zip(*found.values())]


def _told(prefix: str, sums: dict[str, np.ndarray], room: np.ndarray) -> dict[str, np.ndarray]:
    """Columns of one side, from sums by name over a `room` [m3 s]: velocities, temperatures and theta are by mass."""
    mass, found = sums["mass"], {}
    for name, own in sums.items():
        if name.startswith("velocity_"):
            found[f"{prefix}{name}_m_s"] = own / mass
            found[f"{prefix}mass_flux_{name[-1]}_kg_m2_s"] = own / room
        elif name.endswith("volume"):
            found[name.replace("volume", "alpha_p")] = own / room
        elif name != "mass":
            found[prefix + probed.column("", name)] = own / (room if name == "pressure" else mass)
    return found
