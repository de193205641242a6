"""A spray of gel droplets that burst, against the reduced model of one droplet (`sdph droplet`).

When the shell of the tracked particle tears, what it throws, how its sizes change. The model has rings of gel and four
layers of shell, starts as cold, and gets the heat that the particle got from the gas.
"""

from __future__ import annotations

import dataclasses
import math
from typing import NamedTuple

import numpy as np

from sdph.effects.gas import gel, micro_explosion
from sdph.laws import bursting, cavities, swelling
from sdph.study.compare import check
from sdph.study.gel_droplet import course, sections
from sdph.study.gel_droplet.model import Model

TIME = 0.03  # of the time to the tear, from coming in
SHARE, SIZE = 0.03, 0.05  # of the vapour thrown, of the mean diameter after the tear
NUMERICS = sections.Numerics(rings=30, growth_step=2e-3, longest_step=1e-4)  # half as fine as the model's own


class Tracked(NamedTuple):
    """Rows of the history of one particle, from when it came in: time [s], heat from the gas [W], temperature [K], mean
    diameter [m], mass [kg], and sealed."""

    time: np.ndarray
    heat: np.ndarray
    temperature: np.ndarray
    diameter: np.ndarray
    mass: np.ndarray
    sealed: np.ndarray


class Tear(NamedTuple):
    """Tear by the model: time [s], superheat with what the bubble holds [K], wall [m]."""

    time: float
    superheat: float
    wall: float


def exact(run) -> list[dict]:
    """Tear, vapour and sizes of the tracked particle; what the whole spray did, without a bar."""
    own = tracked(run)
    at, done = (_first(rows) for rows in (own.diameter < 0.9 * own.diameter[:1], own.sealed == 0.0))
    if not 0 < at < done:
        return [check("the tracked droplet tears, and throws until nothing is left to throw", 0, 1, 0)]
    particle = micro_explosion.kernel(run.case)
    tear = torn(run.case, particle, own)
    first = own.time[0]
    share = 1.0 - own.mass[done] / own.mass[0]
    expected = 1.0 - math.exp(
        -(particle.own.heat_capacity * tear.superheat + heated(own, at, done)) / particle.own.latent_heat
    )
    sizes = run.case.grains.diameter, run.case.grains.diameter_std**2
    sauter = bursting.sauter(*sizes)
    _, mean, variance = bursting.torn_sizes(*sizes, particle.own.thrown, bursting.film_droplet(tear.wall) / sauter)
    metrics = run.metrics
    return [
        check("time from coming in to the tear [s]", own.time[at] - first, tear.time - first, TIME, True),
        check("share thrown as vapour", share, expected, SHARE, True),
        check("mean diameter after the tear [m]", own.diameter[at], mean, SIZE, True),
        check("Sauter diameter over that before, reported beside the tear's", metrics["sauter_diameter_m"][-1] / sauter,
              bursting.sauter(mean, variance) / sauter, math.inf),
        check("evaporated and thrown share, reported beside what was thrown",
              run.summary["evaporated_kg"] / run.summary["injected_kg"],
              run.summary["thrown_kg"] / run.summary["injected_kg"], math.inf),
    ]  # fmt: skip


def _first(rows) -> int:
    """The first of the rows that holds; 0 where none does."""
    return int(np.argmax(np.append(rows, False)))


def tracked(run) -> Tracked:
    """The first particle of [track]."""
    head = f"particle_{run.case.track[0]}_"
    names = ("convective_heat_W", "temperature_K", "diameter_m", "mass_kg", "sealed")
    columns = [run.history["time_s"], *(run.history[head + name] for name in names)]
    there = np.isfinite(columns[1]) & np.isfinite(columns[3])
    return Tracked(*(column[there] for column in columns))


def heated(own: Tracked, at: int, done: int) -> float:
    """Heat per mass [J/kg] from the gas while vapour is thrown, less that of the last window, which stays."""
    rows = slice(at + 1, done)
    return float((own.heat[rows] * np.diff(own.time)[at : done - 1] / own.mass[rows]).sum())


def torn(case, particle, own: Tracked) -> Tear:
    """The model of one Sauter droplet through the heat of the tracked particle, until it tears."""
    diameter = bursting.sauter(case.grains.diameter, case.grains.diameter_std**2)
    number = own.mass[0] / (case.grains.density * math.pi / 6.0 * diameter**3)
    model = Model(droplet_of(case, particle, diameter))
    cold, boiling = own.temperature[0], model.bubble.temperature
    model.temperature[:], model.origin, model.time = cold, cold, own.time[0]

    def power() -> float:
        """Heat [W] into one droplet now."""
        return float(own.heat[min(np.searchsorted(own.time, model.time, side="right"), len(own.time) - 1)] / number)

    middle = cold
    while middle < boiling:  # no bubble yet: no heat goes to the middle
        model.powers[:] = 0.0
        model.powers[-1] = power()
        free, unit, _ = model.conducted(NUMERICS.longest_step)
        middle = free[0] / (1.0 - unit[0])
        model.temperature, model.time = free + unit * middle, model.time + NUMERICS.longest_step
    grow(model, power)
    mean = float(model.capacities @ model.temperature / model.capacities.sum())
    held = (model.taken) / (particle.own.heat_capacity * particle.own.density * math.pi / 6.0 * diameter**3)
    wall = model.faces()[1] - cavities.radius(model.bubble.void, model.dims)
    return Tear(model.time, mean + held - particle.own.boiling, wall)


def grow(model, power) -> None:
    """Step the model to its tear, as `sdph.study.gel_droplet.course.grow` does."""
    dt = course.FIRST_STEP * NUMERICS.longest_step
    while not model.torn:
        model.powers[-1], before = power(), model.ratio()
        if not model.step(dt):
            dt *= 0.5
            if dt < course.SHORTEST * NUMERICS.longest_step:
                model.torn = "the spot ran away"
            continue
        share = abs(model.ratio() - before) / NUMERICS.growth_step
        dt = min(NUMERICS.longest_step, dt * min(course.EAGER, 1.0 / share if share else course.EAGER))


def droplet_of(case, particle, diameter: float) -> sections.Droplet:
    """Keys of the model for a droplet whose gel and shell fill `diameter` [m]."""
    own, grains = case.parameters["micro_explosion"], case.grains
    first, inner, outer = swelling.radii(own.bubble_ratio, own.shell_ratio, diameter)
    shell = gel.Shell(**{field.name: getattr(own, field.name) for field in dataclasses.fields(gel.Shell)})
    drop = sections.Drop(
        dimensions=3, diameter=2.0 * outer, shell_thickness=outer - inner, bubble_diameter=2.0 * first,
        ambient_pressure=case.gas.operating_pressure, surface_tension=grains.surface_tension,
    )  # fmt: skip
    material = sections.Gel(
        density=grains.density, heat_capacity=grains.heat_capacity, conductivity=grains.conductivity
    )
    return sections.Droplet(
        drop, shell, material, micro_explosion.fuel_of(case), sections.Heating(), sections.Vent(), NUMERICS
    )
