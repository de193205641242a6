"""Cases and states that tests start from."""

import numpy as np
from fakes import StillGas

from coupling.gas import Mesh
from sdph import effects, scenes
from sdph.case import gas_cells
from sdph.case import read as cases
from sdph.effects import OFF
from sdph.effects.grains import conduction
from sdph.engine import state as particles
from sdph.engine.geometry import box_of
from sdph.engine.ledger import Ledger
from sdph.engine.neighbours import Neighbours
from sdph.laws import kernels
from sdph.methods.grains import equations as rates
from sdph.running.simulation import Simulation

DISC = scenes.HERE / "disc_cluster" / "case.toml"
# A square full of grains: no rim, and with one cell of gas the two-temperature problem itself.
FULL_BOX = (
    "domain.size_m=[0.05,0.05]",
    "particles.disc.shape='box'",
    "particles.disc.lower_m=[0.0,0.0]",
    "particles.disc.upper_m=[0.05,0.05]",
    "probes.centre.at_m=[0.025,0.025]",
)
# Nu = 2 whatever alpha_g, and a = 6 alpha_p/d: eps is the same in every particle, at the walls too.
PLAIN_EXCHANGE = ("heat.law='ranz_marshall'", "heat.closure='geometric'")


def disc(*overrides):
    """The disc cluster with `key=value` overrides."""
    return cases.load(DISC, overrides)


def fixed_windows(dt: float) -> tuple[str, ...]:
    """Overrides with which every window is `dt` [s] long, up to the next output time."""
    return f"coupling.window_largest_s={dt!r}", "coupling.window_tolerance=1e30"


def simulation(case, folder, cells=None, gas=StillGas) -> Simulation:
    """A started simulation on a gas without flow; its ledger is in `folder`."""
    stand_in = gas(case, cells or gas_cells.cells(case))
    run = Simulation(case, stand_in, Ledger(folder / "ledger.csv", case, stand_in.mesh.depth, *effects.in_ledger(case)))
    run.start()
    return run


def run(case, folder, cells=None, gas=StillGas) -> Simulation:
    """The same, run to its end."""
    simulated = simulation(case, folder, cells, gas)
    while simulated.time < case.run.end_time:
        simulated.window()
    simulated.ledger.table.close()
    return simulated


def cloud(points: np.ndarray, mass=1.0, temperature=300.0, density=1000.0):
    """A state with particles at `points` (N, 2 or 3) [m]."""
    points = np.asarray(points, float)
    state = particles.empty(len(points), ("temperature",), points.shape[1], particles.Grains)
    for axis, column in zip(particles.axes(state), points.T):
        axis[:] = column
    for name, value in (("mass", mass), ("temperature", temperature), ("density", density)):
        getattr(state, name)[:] = value
    state.ident[:] = np.arange(len(points))
    return state


def tensor_mesh(*edges: np.ndarray) -> Mesh:
    """A mesh of the boxes between `edges` along each axis; 1 m deep in two dimensions."""
    middles = [0.5 * (e[1:] + e[:-1]) for e in edges]
    centres = np.zeros((int(np.prod([len(m) for m in middles])), 3))
    for a, grid in enumerate(np.meshgrid(*middles, indexing="ij")):
        centres[:, a] = grid.ravel()
    volumes = np.ones(1)
    for e in edges:
        volumes = np.multiply.outer(volumes, np.diff(e)).ravel()
    return Mesh(centres, volumes, len(edges))


def polar_mesh(rings: int, sectors: int, radius: float, angle: float) -> Mesh:
    """Cells of a wedge of a disc around the origin: triangles at its tip, long thin cells at its rim."""
    r, phi = np.linspace(0.0, radius, rings + 1), np.linspace(0.0, angle, sectors + 1)
    area = 0.5 * np.diff(r**2)[:, None] * np.diff(phi)[None, :]
    middle_r = (2.0 / 3.0) * np.diff(r**3) / np.diff(r**2)
    middle_phi = 0.5 * (phi[1:] + phi[:-1])
    x, y = np.outer(middle_r, np.cos(middle_phi)), np.outer(middle_r, np.sin(middle_phi))
    centres = np.stack((x.ravel(), y.ravel(), np.zeros(x.size)), axis=1)
    return Mesh(centres, area.ravel(), 2)


OPEN = (0.0, 0.0, 0.0)


def dimensions_of(state) -> int:
    return 3 if len(state.z) else 2


def summed_density(kernel, state, period=OPEN):
    """(state as sorted, density) by the code's own loop."""
    state, rows = Neighbours(kernels.SUPPORT * kernel.h, period).update(state)
    density = np.full(len(state.x), np.nan)
    rates.sum_density(
        kernel, state, rows, box_of(period, dimensions_of(state)), OFF, OFF, density, np.empty(len(rows.entries))
    )
    return state, density


def conduction_heating(kernel, state, conduction_p, period=OPEN):
    """(state as sorted, heating [W/kg]) by the code's own loop."""
    state, rows = Neighbours(kernels.SUPPORT * kernel.h, period).update(state)
    box, pull, heating = (
        box_of(period, dimensions_of(state)),
        np.empty(len(rows.entries)),
        np.full(len(state.x), np.nan),
    )
    rates.sum_density(kernel, state, rows, box, OFF, OFF, np.empty(len(state.x)), pull)
    own = np.empty(len(state.x) if isinstance(conduction_p, conduction.PackedP) else 0)
    rates.pack(conduction_p, state, own)
    rates.conduct(kernel, state, rows, box, pull, conduction_p, own, heating)
    return state, heating
