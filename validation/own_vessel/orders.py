"""Order of the gas equations on meshes that are no boxes, by a manufactured solution.

Roache 2002, J. Fluids Eng. 124, 4. Gas goes round in a closed vessel, U = curl(phi^2 a), where phi is 0 on the walls:
so is U, and the flux through any face is the integral of phi^2 a along its edges, which closes over a cell to
round-off. The temperature is even along the walls too; the pressure is a wave that knows nothing of them. Derivatives
are differences of fourth order, right to 1e-6.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from sdph.study.compare import check

from . import gases, meshes

K = 0.5 * math.pi  # 1/m, of the pressure
PLACE = np.array((0.13, 0.29, 0.41))  # m, of its crest: no side of a vessel is a plane of symmetry
SWIRL = np.array((0.1, 0.2, 0.15))  # m2/s, a: gas of 0.5 m/s or so
HEIGHT, WARMTH = 1.0, 10.0  # Pa and K, of pressure and temperature
ROOM = 0.7  # alpha_g [-]
VISCOSITY, CONDUCTIVITY = 0.1, 100.0  # Pa s, W/(m K): Reynolds and Peclet numbers of the order of 10
DRAG, HEAT = 10.0, 1e4  # kg/(m3 s), W/(m3 K): what is not steady dies out in a tenth of a second
TIME, SPEED, COURANT = 1.5, 0.5, 0.4  # s, m/s, -
CELLS = (6, 12)  # across
ORDER = 1.5  # nearer to second order than to first; our choice
APART = 1e-2  # m, of the differences


def phi(name: str, x: np.ndarray) -> np.ndarray:
    """0 on the walls of a vessel and 1 or so in its middle, at places (N, 3) [m]."""
    across = x[:, :2]
    if name == "cone":
        r = np.linalg.norm(x, axis=1)
        height, off = r - meshes.APEX, (np.arctan2(np.hypot(*across.T), x[:, 2]) / meshes.HALF) ** 2
    elif name == "cylinder":
        height, off = x[:, 2], 4.0 * (across**2).sum(axis=1)
    else:
        angle = float(name.split()[2]) if name.startswith("sheared") else 0.0
        height, across = x[:, 2], across - np.outer(x[:, 2], [math.tan(math.radians(angle)), 0.0])
        off = 1.0 - 16.0 * (across * (1.0 - across)).prod(axis=1)
    return (1.0 - off) * 4.0 * height * (1.0 - height)


def slopes(f, x: np.ndarray) -> np.ndarray:
    """df/dx_j (N, ..., 3) of f(places)."""
    steps = APART * np.eye(3)
    return np.stack(
        [(8.0 * (f(x + h) - f(x - h)) - (f(x + 2 * h) - f(x - 2 * h))) / (12.0 * APART) for h in steps], axis=-1
    )


def laplacian(f, x: np.ndarray) -> np.ndarray:
    """Sum of the second derivatives of f(places)."""
    steps = APART * np.eye(3)
    near = sum(16.0 * (f(x + h) + f(x - h)) - (f(x + 2 * h) + f(x - 2 * h)) for h in steps)
    return (near - 90.0 * f(x)) / (12.0 * APART**2)


def velocity(name: str, x: np.ndarray) -> np.ndarray:
    """(N, 3) [m/s] at places (N, 3) [m]."""
    return np.cross(slopes(lambda y: phi(name, y) ** 2, x), SWIRL)


def pressure(x: np.ndarray) -> np.ndarray:
    return HEIGHT * np.cos(K * (x - PLACE)).prod(axis=1)


def temperature(name: str, x: np.ndarray) -> np.ndarray:
    return gases.TEMPERATURE + WARMTH * phi(name, x)


def sources(name: str, x: np.ndarray) -> dict[str, np.ndarray]:
    """Sources that keep the flow as it is, at cells."""

    def moved(y):
        return velocity(name, y)

    def warm(y):
        return temperature(name, y)

    u, n, steep = moved(x), len(x), slopes(pressure, x)
    force = gases.DENSITY * np.einsum("nij,nj->ni", slopes(moved, x), u) + steep - VISCOSITY * laplacian(moved, x)
    carried = gases.DENSITY * gases.HEAT_CAPACITY * np.einsum("ni,ni->n", u, slopes(warm, x))
    heat = carried - CONDUCTIVITY * laplacian(warm, x) - np.einsum("ni,ni->n", u, steep)
    return {
        "momentum": ROOM * force + DRAG * u, "momentum_coefficient": np.full(n, DRAG),
        "heat": ROOM * heat + HEAT * warm(x), "heat_coefficient": np.full(n, HEAT),
    }  # fmt: skip


def _on_faces(name: str, mesh, patch: str) -> np.ndarray:
    """Velocity (F, 3) of faces: that of their centres, and along the normal the flux that closes over the vessel."""
    area, u = mesh.areas(patch), velocity(name, mesh.centres(patch))
    flux = np.array([_flux(name, corners) for corners in mesh.corners(patch)])
    size = np.linalg.norm(area, axis=1)
    return u + ((flux - np.einsum("ni,ni->n", u, area)) / size**2)[:, None] * area


def _flux(name: str, corners: np.ndarray) -> float:
    """Flux [m3/s] through a face, of phi^2 a along its edges by Simpson's rule."""
    after = np.roll(corners, -1, axis=0)
    ends, middle = phi(name, corners) ** 2, phi(name, 0.5 * (corners + after)) ** 2
    return float(((ends + 4.0 * middle + np.roll(ends, -1)) / 6.0) @ ((after - corners) @ SWIRL))


def errors(name: str, cells: int, folder: Path) -> np.ndarray:
    """Root mean squares over the volume of the errors of velocity, pressure (less its mean), its gradient and
    temperature, over the size of each."""
    mesh = meshes.MESHES[name](cells)
    walls = {patch: {"kind": "wall"} for patch in meshes.PATCHES}
    fields = [
        gases.start_field("U", {patch: gases.fixed(_on_faces(name, mesh, patch)) for patch in walls}),
        gases.start_field("T", {patch: gases.fixed(temperature(name, mesh.centres(patch))) for patch in walls}),
    ]
    air = {"viscosity_Pa_s": VISCOSITY, "conductivity_W_m_K": CONDUCTIVITY}
    with gases.started(mesh, folder, walls, fields, **air) as gas:
        x, share = gas.mesh.centres, gas.mesh.volumes / gas.mesh.volumes.sum()
        given, step = sources(name, x), COURANT * gas.mesh.volumes.min() ** (1.0 / 3.0) / SPEED
        state = gas.start(np.full(len(x), ROOM), tuple(given))
        for _ in range(math.ceil(TIME / step)):
            state = gas.advance(step, given)
    found, right = state.fields, {
        "velocity": velocity(name, x), "pressure": pressure(x) - share @ pressure(x),
        "pressure_gradient": slopes(pressure, x), "temperature": temperature(name, x) - gases.TEMPERATURE,
    }  # fmt: skip
    level = {"pressure": share @ found["pressure"], "temperature": gases.TEMPERATURE}
    return {
        what.replace("_", " "): _size(share, found[what] - level.get(what, 0.0) - own) / _size(share, own)
        for what, own in right.items()
    }


def _size(share, field) -> float:
    return math.sqrt(share @ (field.reshape(len(share), -1) ** 2).sum(axis=1))


def checks(folder: Path, _=(), reporter=None, chosen=tuple(meshes.MESHES), cells=CELLS) -> list[dict]:
    """Orders from the coarser mesh to the finer."""
    rows = []
    for name in chosen:
        found = [errors(name, n, folder / f"{name.replace(' ', '_')}-{n}") for n in cells]
        for what in found[0]:
            coarse, fine = (one[what] for one in found)
            order = math.log(coarse / fine) / math.log(cells[1] / cells[0])
            own = check(f"{name}: order of the {what} [-]", order, 2.0, 2.0 - ORDER) | {"ok": bool(order >= ORDER)}
            rows += [own, check(f"{name}: error of the {what} on the finer mesh, reported", fine, 0.0, math.inf)]
    return rows
