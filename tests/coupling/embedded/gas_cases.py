"""Cases and shorthands for the tests of the embedded gas solver."""

import dataclasses
import itertools

import numpy as np

from coupling.embedded import EmbeddedGas
from sdph.case.read import from_table

AIR = {
    "density_kg_m3": 1.2, "viscosity_Pa_s": 1.8e-5, "conductivity_W_m_K": 0.025, "heat_capacity_J_kg_K": 1000.0,
    "temperature_K": 300.0,
}  # fmt: skip
OIL = {
    "molar_mass_kg_kmol": 142.0, "diffusivity_m2_s": 1e-5, "heat_capacity_J_kg_K": 1700.0, "conductivity_W_m_K": 0.02,
    "viscosity_Pa_s": 1e-5,
}  # fmt: skip
SIDES = ("left", "right", "bottom", "top", "back", "front")


def gas_case(size, cells, *, gravity=None, boundaries=None, vapour=None, stretch=None, **gas):
    """A case of gas alone: `size` [m] with `cells` along x, `gas` overriding AIR."""
    d = len(size)
    table = {
        "title": "gas alone", "dimensions": d, "effects": [],
        "run": {"end_time_s": 1.0, "output_interval_s": 1.0},
        "domain": {"size_m": [float(s) for s in size], "gravity_m_s2": [float(g) for g in gravity or [0.0] * d]},
        "resolution": {"spacing_mm": size[0] / cells * 1e3, "cell_mm": size[0] / cells * 1e3,
        "stretch": list(stretch or [1.0] * d)},
        "gas": AIR | gas,
        "grains": {"density_kg_m3": 2500.0, "diameter_mm": 0.5, "heat_capacity_J_kg_K": 800.0,
        "conductivity_W_m_K": 1.0},
        "boundaries": boundaries or {"walls": {"kind": "wall"}},
    }  # fmt: skip
    return from_table(table | ({"vapour": vapour} if vapour else {}))


def gas_of(*args, limited=True, **kwargs):
    return EmbeddedGas(gas_case(*args, **kwargs), limited=limited)


def set_flow(gas, velocity=None, temperature=None, pressure=None):
    """Overwrite the fields of a started gas with functions of the coordinates (each (C,)); velocity takes the axis
    too."""
    grid, flow = gas.box.grid, gas.flow
    new = {}
    if velocity is not None:
        new["velocity"], new["flux"] = flow.velocity.copy(), flow.flux.copy()
        density = grid.per_volume(flow.mass)
        for a in range(grid.dimensions):
            face = np.flatnonzero(gas.momentum.active[a])
            place = padded_places(grid, a)[:, face]
            new["velocity"][a, face] = velocity(a, *place)
            here = 0.5 * (density[face] + density[face - grid.strides[a]])
            new["flux"][a, face] = here * grid.geometry.area[a, face] * new["velocity"][a, face]
    for name, function in (("temperature", temperature), ("pressure", pressure)):
        if function is not None:
            new[name] = getattr(flow, name).copy()
            new[name][grid.cells] = function(*grid.centres.T)
    gas.flow = dataclasses.replace(flow, **new)


def padded_places(grid, axis):
    """(d, S) coordinates of the faces of `axis`."""
    places = np.zeros((grid.dimensions, grid.size))
    places[:, grid.cells] = grid.centres.T
    places[axis] -= 0.5 * grid.geometry.width[axis]
    return places


def norms(error, volumes):
    """Mean and largest of |error|, volumes weighting."""
    return float((np.abs(error) * volumes).sum() / volumes.sum()), float(np.abs(error).max())


def orders(errors):
    """Observed orders between grids refined by two."""
    return [float(np.log2(a / b)) for a, b in itertools.pairwise(errors)]
