"""A gas without flow: one uniform box of square cells that exchanges heat implicitly, each cell by itself."""

import numpy as np

from coupling.gas import Budget, GasState, Mesh


def budget(case, mass, energy, momentum=(0.0, 0.0, 0.0), **told):
    """Totals of a gas of a mass [kg] and an energy [J] that nothing has crossed the boundaries of."""
    crossed = {name: [0.0] * 4 for name in case.boundaries}
    return Budget(mass, energy, 0.0, momentum, 0.0, 0.0, 0.0, 0.0, crossed=crossed, **told)


class StillGas:
    """Stands in for a gas solver where only the particle side is under test. Constant density, no conduction."""

    def __init__(self, case, cells):
        ticks = [(np.arange(n) + 0.5) * length / n for n, length in zip(cells, case.domain.size)]
        grid = np.meshgrid(*ticks, indexing="ij")
        centres = np.zeros((grid[0].size, 3))
        for a, g in enumerate(grid):
            centres[:, a] = g.ravel()
        volume = np.prod([length / n for n, length in zip(cells, case.domain.size)])
        self.case = case
        self.mesh = Mesh(centres, np.full(len(centres), volume), case.dimensions)
        self.time = 0.0
        self.temperature = np.full(len(centres), case.gas.temperature)

    def start(self, alpha_g, sources, fields=()):
        self.alpha = np.ones(len(self.temperature)) if alpha_g is None else alpha_g
        return self._state()

    def advance(self, dt, sources):
        self.before = self.time, self.temperature
        self.time += dt
        content = self.alpha * self.case.gas.density * self.case.gas.heat_capacity / dt
        if sources:
            gained = content * self.temperature + sources["heat"]
            self.temperature = gained / (content + sources["heat_coefficient"])
        return self._state()

    def retreat(self):
        self.time, self.temperature = self.before
        return self._state()

    def close(self):
        pass

    def _state(self):
        zeros = np.zeros((len(self.temperature), 3))
        gas = self.case.gas
        mass = float((self.alpha * self.mesh.volumes).sum() * gas.density)
        energy = float((self.alpha * self.temperature * self.mesh.volumes).sum() * gas.density * gas.heat_capacity)
        fields = {
            "velocity": zeros,
            "pressure": zeros[:, 0],
            "pressure_gradient": zeros,
            "temperature": self.temperature.copy(),
        }
        rest = {"density": np.full(len(zeros), gas.density), "power": zeros[:, 0]}
        return GasState(self.time, fields | rest, budget(self.case, mass, energy))
