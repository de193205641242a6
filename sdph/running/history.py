"""Rows of history.csv: probes fixed in space or in a body, and what the grains tell of themselves."""

from __future__ import annotations

import numpy as np

from coupling.transfer import gather
from sdph.case import probed
from sdph.case.bodies import around, nearest
from sdph.case.sections import Probe
from sdph.engine import state as particles
from sdph.engine.geometry import OPEN, box_of, nearest_image
from sdph.engine.world import ALONE
from sdph.laws.kernels import SUPPORT
from sdph.methods.solids import history as solids
from sdph.running import level


def row(simulation) -> dict[str, float]:
    """All columns of one instant."""
    columns = {"time_s": simulation.time}
    for name, own in simulation.case.probes.items():
        with simulation.grains.ashore():
            found = probe(simulation, own.at, own.fields)
        columns |= {f"{name}_{key}": value for key, value in found.items()}
    return columns | simulation.grains.row()


def in_the_end(case, first: dict[str, float], last: dict[str, float]) -> dict[str, float]:
    """Values of probes in the last row, and by how much their temperature rose since the first."""
    found = {}
    for name, probe in case.probes.items():
        keys = (f"{name}_{column}" for column in probed.columns(case, probe))
        found |= {key: last[key] for key in keys if key in last}
        if (key := f"{name}_temperature_K") in last:
            found[f"{name}_rise_K"] = last[key] - first[key]
    return found


def probe(simulation, point, fields: tuple[str, ...] = ()) -> dict[str, float]:
    """Values at a point of `fields`, without any the temperatures, by kernel interpolation: of particles where they
    have it, nan if none are near."""
    case = simulation.case
    chosen, here = probed.fields(case, Probe(at=point, fields=fields)), _place(point)
    state = simulation.grains.inside
    arrays = {name: _of_grains(case, state, name) for name in chosen["particles"]}
    found = near(case, particles.positions(state), state.mass, arrays, here, simulation.world)
    weights = simulation.transfer.weights(here)
    cells = simulation.cell_fields() if "alpha_p" in chosen["gas"] else simulation.gas_state.fields
    return found | _named(case, "gas", {name: gather(weights, cells[name])[0] for name in chosen["gas"]})


def of_liquid(case, cloud, world=ALONE) -> dict[str, float]:
    """Columns of all probes in a liquid that go along with no body; each process of a world has of its particles a
    cloud of pyvista."""
    columns = {}
    for name, own in case.probes.items():
        if probed.of_body(case, own):
            continue
        there = cloud.n_points > 0  # pyvista knows no empty arrays
        chosen = probed.fields(case, own)["particles"]
        arrays = {
            field: np.asarray(cloud[field]) if there else np.zeros((0, 3) if field == "velocity" else 0)
            for field in chosen
            if field != level.FIELD
        }
        places, mass = (
            (np.asarray(cloud.points), np.asarray(cloud["mass"])) if there else (np.zeros((0, 3)), np.zeros(0))
        )
        found = near(case, places, mass, arrays, _place(own.at), world)
        if level.FIELD in chosen:
            found[probed.column("", level.FIELD)] = level.of(case, cloud, own.at, world)
        columns |= {f"{name}_{key}": value for key, value in found.items()}
    return columns


def of_solid(case, stepper) -> dict[str, float]:
    """Columns of all probes in bodies: of the particle that was nearest at the start, of the body that each lies in or,
    of bodies alone, beside."""
    columns, here = {}, particles.positions(stepper.state)
    told = solids.fields(stepper) | {"velocity": particles.velocities(stepper.state)}
    told["displacement"] = here - stepper.reference
    for name, own in case.probes.items():
        if not probed.of_body(case, own):
            continue
        body = around(case, own.at)
        rows = np.flatnonzero((stepper.body == body) | (body is None))
        i = rows[nearest(stepper.reference[rows, : case.dimensions], own.at)[0]]
        found = _named(case, "particles", {field: told[field][i] for field in probed.fields(case, own)["particles"]})
        columns |= {f"{name}_{key}": value for key, value in found.items()}
    return columns


def near(case, places, mass, arrays: dict, here, world=ALONE) -> dict[str, float]:
    """Columns of arrays (N,) or (N, 3) of particles at `places` (N, 3) [m], by their mass [kg] and distance to `here`
    (1, 3): sum m (1 - r/R)^2 f over sum m (1 - r/R)^2 within R, the reach of the kernel, those of all processes of a
    world; nan if none are near."""
    reach = SUPPORT * case.smoothing_length
    box = box_of((*(case.liquid_period if case.liquid else case.domain.period), OPEN)[:3], 3)
    r = particles.lengths(np.stack(nearest_image.py_func(box, *(places - here).T), axis=1))
    close = np.flatnonzero(r < reach)
    weight = mass[close] * (1.0 - r[close] / reach) ** 2
    total = world.sum(float(weight.sum())) or np.nan
    means = {name: world.sum((weight * values[close].T).sum(axis=-1)) / total for name, values in arrays.items()}
    return _named(case, "particles", means)


def _named(case, whose: str, values: dict) -> dict[str, float]:
    """Numbers by column, a vector by its axes."""
    found = {}
    for field, value in values.items():
        name = probed.column(whose, field)
        parts = probed.by_axis(name, case.dimensions) if np.ndim(value) else [name]
        found |= {part: float(one) for part, one in zip(parts, np.atleast_1d(value))}
    return found


def _of_grains(case, state, field: str) -> np.ndarray:
    """A field (N,) or (N, 3) of the grains."""
    if field == "velocity":
        return particles.velocities(state)
    if field != "alpha_p":
        return getattr(state, field)
    return state.density / particles.by_material(state.grain_density, case.grains.density)


def _place(point) -> np.ndarray:
    """(1, 3) of a point (d,) [m]."""
    return np.array([[*point, 0.0][:3]])
