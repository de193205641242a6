"""Boxes of grains for problems with exact solutions: periodic ones, and a gas without a mesh of its own to speak of."""

import math

import numpy as np
from fakes import budget

from coupling.gas import IMPULSES, GasState, Mesh
from sdph import effects
from sdph.case import read as cases
from sdph.engine.ledger import Ledger
from sdph.methods.grains import sub_step
from sdph.running.simulation import Simulation

DENSITY, DIAMETER, VISCOSITY = 3060.0, 285e-6, 1.7895e-5
SPACING = 5e-3


def table(effects, size=(0.06, 0.06), alpha_p=0.5, periodic=("x", "y"), gravity=(0.0, 0.0), fill=None, **sections):
    """The TOML table of a box of grains, filled up to `fill` [m]; `sections` replace or add."""
    base = {
        "title": "box of grains", "dimensions": len(size), "effects": list(effects),
        "run": {"end_time_s": 1.0, "output_interval_s": 1.0},
        "domain": {"size_m": list(size), "gravity_m_s2": list(gravity), "periodic": list(periodic)},
        "resolution": {"spacing_mm": SPACING * 1e3, "cell_mm": 10.0},
        "gas": {"density_kg_m3": 1.225, "viscosity_Pa_s": VISCOSITY, "conductivity_W_m_K": 0.0242,
                "heat_capacity_J_kg_K": 1006.43, "temperature_K": 300.0},
        "grains": {"density_kg_m3": DENSITY, "diameter_mm": DIAMETER * 1e3, "heat_capacity_J_kg_K": 1000.0,
                   "conductivity_W_m_K": 1.0, "granular_temperature_m2_s2": 1e-4},
        "particles": {"bed": {"shape": "box", "lower_m": [0.0] * len(size), "upper_m": list(fill or size),
                              "volume_fraction": alpha_p, "temperature_K": 300.0}},
        "coupling": {"window_tolerance": 1e30, "window_largest_s": 1e-2, "courant": 1e30},
    }  # fmt: skip
    for name, section in sections.items():
        base[name] = base.get(name, {}) | section
    return base


def box(*args, **kwargs):
    return cases.from_table(table(*args, **kwargs))


def bed_of_patches(path, size, names):
    """Grains in a vessel whose walls are the facets of a file: a wall, then outlets, by these names."""
    wall, *outlets = names.split()
    kinds = {name: {"kind": "pressure_outlet", "pressure_Pa": 0.0, "temperature_K": 300.0} for name in outlets}
    kinds |= {wall: {"kind": "wall"}}
    courant = {"courant": 0.2}
    walls = {"source": "gas", "mesh": path}
    return box(
        ["walls", "outflow"],
        size,
        0.3,
        (),
        boundaries={name: kinds[name] for name in names.split()},
        walls=walls,
        coupling=courant,
        fill=(0.02, 0.02),
    )


def several(effects, particles, grains, **more):
    """A box of grains of several materials: these regions, not the one that fills it."""
    given = table(list(effects), grains=grains, **more)
    return cases.from_table(given | {"particles": particles})


def windows(end, count):
    """Sections of a run to `end` [s] in `count` equal windows."""
    return {"run": {"end_time_s": end, "output_interval_s": end},
            "coupling": {"window_tolerance": 1e30, "window_largest_s": end / count, "courant": 1e30}}  # fmt: skip


class Row:
    """Isothermal gas in one periodic row of cells along x: linear sound of speed `c` [m/s], drag implicit in each cell,
    a gradient of pressure (3,) [Pa/m] imposed from outside. Derivatives are those of the Fourier series."""

    def __init__(self, case, cells=1, c=0.0, alpha_g=None, gradient=(0.0, 0.0, 0.0)):
        self.case, self.c, self.gradient = case, c, np.array(gradient)
        length, height, *_ = case.domain.size
        centres = np.zeros((cells, 3))
        centres[:, 0], centres[:, 1] = (np.arange(cells) + 0.5) * length / cells, 0.5 * height
        self.mesh = Mesh(centres, np.full(cells, np.prod(case.domain.size) / cells), case.dimensions)
        self.wave = 2j * math.pi * np.fft.rfftfreq(cells, length / cells)
        self.time, self.velocity, self.rise = 0.0, np.zeros((cells, 3)), np.zeros(cells)
        self.power, self.heat = np.zeros(cells), 0.0
        self.impulses = dict.fromkeys(IMPULSES, np.zeros(3))
        self.given = alpha_g

    def start(self, alpha_g, sources, fields=()):
        self.alpha = float(np.mean(alpha_g)) if self.given is None else self.given
        self.mass = self.alpha * self.case.gas.density  # per volume [kg/m3]
        return self._state()

    def advance(self, dt, sources):
        """Velocity first, then the density that it compresses: no damping but that of drag."""
        self.time += dt
        push = np.zeros_like(self.velocity)
        push[:, 0] = -(self.c**2) * self._slope(self.rise)
        weight = np.array((*self.case.domain.gravity, 0.0)[:3])
        push += weight - self.alpha * self.gradient / self.mass
        drag, pull = sources.get("momentum_coefficient", np.zeros(len(push)))[:, None], sources.get("momentum", 0.0)
        before = self.velocity
        self.velocity = (self.mass * (self.velocity + dt * push) + dt * pull) / (self.mass + dt * drag)
        self._count(dt, weight, pull - drag * self.velocity)
        self.power = ((pull - drag * self.velocity) * 0.5 * (before + self.velocity)).sum(axis=1)
        self.heat += float((sources.get("heat", np.zeros(1)) * self.mesh.volumes).sum() * dt)
        self.rise = self.rise - dt * self._slope(self.velocity[:, 0])
        return self._state()

    def _count(self, dt, weight, given):
        """Impulses of a window; given (C, 3) [N/m3] is from the particles."""
        whole, room = self.mesh.volumes.sum(), (1.0 - self.alpha) * self.mesh.volumes.sum()
        now = {
            "impulse_gravity": whole * self.mass * weight, "impulse_pressure": -whole * self.gradient,
            "impulse_room": room * self.gradient, "impulse_exchange": self.mesh.volumes @ given,
        }  # fmt: skip
        self.impulses = self.impulses | {name: self.impulses[name] + dt * force for name, force in now.items()}

    def close(self):
        pass

    def _slope(self, values):
        return np.fft.irfft(self.wave * np.fft.rfft(values), len(values))

    def _state(self):
        zeros, cells = np.zeros(len(self.velocity)), len(self.velocity)
        total = (self.mass * self.mesh.volumes[:, None] * self.velocity).sum(axis=0)
        kinetic = 0.5 * self.mass * float(self.mesh.volumes @ (self.velocity**2).sum(axis=1))
        own = self.mass * self.mesh.volumes.sum(), self.heat, tuple(total)
        told = {name: tuple(impulse.tolist()) for name, impulse in self.impulses.items()}
        still = {name: np.zeros((3, 3)).tolist() for name in self.case.boundaries}
        fields = {
            "velocity": self.velocity.copy(), "pressure": zeros,
            "pressure_gradient": np.tile(self.gradient, (cells, 1)), "temperature": zeros + 300.0,
            "density": zeros + self.case.gas.density, "power": self.power,
        }  # fmt: skip
        return GasState(self.time, fields, budget(self.case, *own, kinetic=kinetic, patches=still, **told))


def started(case, folder, gas=None):
    gas = gas or Row(case)
    simulation = Simulation(case, gas, Ledger(folder / "ledger.csv", case, gas.mesh.depth, *effects.in_ledger(case)))
    simulation.start()
    return simulation


def go(simulation):
    """To the end of the case."""
    while simulation.time < simulation.case.run.end_time:
        simulation.window()
    simulation.ledger.table.close()
    return simulation


def strain(stepper, dt):
    """Shear of the grains as they move, over `dt` [s], as a sub-step takes it."""
    own, terms = stepper, stepper.terms
    sub_step.strain_grains(
        own.kernel, own.state, own.rows, own.neighbours.box, own.scratch, terms.shears, terms.friction, terms.viscous,
        *own._walls(), own.work, dt,
    )  # fmt: skip
