"""Order of the gas equations on meshes that are no boxes, by a manufactured solution.

Roache 2002, J. Fluids Eng. 124, 4. The velocity is the flow of Arnold, Beltrami and Childress: curl U = K U, so that
div U = 0, (U.grad) U = grad(U^2/2), and the flux through any face is the integral of U/K along its edges, which closes
over a cell to round-off.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from sdph.study.compare import check

from . import gases, meshes

K = 0.5 * math.pi  # 1/m
SPEEDS = (0.5, 0.4, 0.3)  # m/s, A, B, C of the flow
HEIGHT, WARMTH = 1.0, 10.0  # Pa and K, of pressure and temperature
ROOM = 0.7  # alpha_g [-]
VISCOSITY, CONDUCTIVITY = 0.1, 100.0  # Pa s, W/(m K): Reynolds and Peclet numbers of the order of 10
DRAG, HEAT = 10.0, 1e4  # kg/(m3 s), W/(m3 K): what is not steady dies out in a tenth of a second
TIME, COURANT = 1.5, 0.4  # s, -
CELLS = (6, 12)  # across
ORDER = 1.5  # nearer to second order than to first; our choice
PLACE = (0.13, 0.29, 0.41)  # m, of the origin: no side of a vessel is a plane of symmetry


def velocity(x: np.ndarray) -> np.ndarray:
    """(N, 3) [m/s] at places (N, 3) [m]."""
    a, b, c = SPEEDS
    x, y, z = (K * (x + PLACE)).T
    return np.stack([
        a * np.sin(z) + c * np.cos(y), b * np.sin(x) + a * np.cos(z), c * np.sin(y) + b * np.cos(x)
    ], axis=1)  # fmt: skip


def jacobian(x: np.ndarray) -> np.ndarray:
    """dU_i/dx_j (N, 3, 3) [1/s]."""
    a, b, c = SPEEDS
    x, y, z = (K * (x + PLACE)).T
    zero = np.zeros_like(x)
    return K * np.stack([
        np.stack([zero, -c * np.sin(y), a * np.cos(z)], axis=1),
        np.stack([b * np.cos(x), zero, -a * np.sin(z)], axis=1),
        np.stack([-b * np.sin(x), c * np.cos(y), zero], axis=1),
    ], axis=1)  # fmt: skip


def wave(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """cos x cos y cos z of K x, and its gradient: the shape of pressure and temperature; its Laplacian is -3 K^2 of
    it."""
    c, s = np.cos(K * (x + PLACE)), np.sin(K * (x + PLACE))
    slope = -K * np.stack([s[:, a] * c[:, a - 1] * c[:, a - 2] for a in range(3)], axis=1)
    return c.prod(axis=1), slope


def sources(x: np.ndarray) -> dict[str, np.ndarray]:
    """What keeps the flow as it is, at cells."""
    u, (shape, slope) = velocity(x), wave(x)
    convection = np.einsum("nij,nj->ni", jacobian(x), u)
    force = ROOM * (gases.DENSITY * convection + HEIGHT * slope + VISCOSITY * K**2 * u) + DRAG * u
    carried = gases.DENSITY * gases.HEAT_CAPACITY * WARMTH * np.einsum("ni,ni->n", u, slope)
    led = 3.0 * K**2 * CONDUCTIVITY * WARMTH * shape
    worked = HEIGHT * np.einsum("ni,ni->n", u, slope)
    warm = ROOM * (carried + led - worked) + HEAT * (gases.TEMPERATURE + WARMTH * shape)
    n = len(x)
    return {
        "momentum": force, "momentum_coefficient": np.full(n, DRAG), "heat": warm, "heat_coefficient": np.full(n, HEAT),
    }  # fmt: skip


def _on_faces(mesh, patch: str) -> np.ndarray:
    """Velocity (F, 3) of faces: that of their centres, and along the normal the flux that closes over the vessel."""
    area, u = mesh.areas(patch), velocity(mesh.centres(patch))
    flux = np.array([_flux(corners) for corners in mesh.corners(patch)])
    size = np.linalg.norm(area, axis=1)
    return u + ((flux - np.einsum("ni,ni->n", u, area)) / size**2)[:, None] * area


def _flux(corners: np.ndarray) -> float:
    """Flux [m3/s] through a face, of U/K along its edges by Simpson's rule."""
    after = np.roll(corners, -1, axis=0)
    mean = (velocity(corners) + 4.0 * velocity(0.5 * (corners + after)) + velocity(after)) / 6.0
    return float(np.einsum("ni,ni->", mean, after - corners)) / K


def errors(name: str, cells: int, folder: Path) -> np.ndarray:
    """Root mean squares over the volume of the errors of velocity, pressure (less its mean), its gradient and
    temperature, over the size of each."""
    mesh = meshes.MESHES[name](cells)
    walls = {patch: {"kind": "wall"} for patch in meshes.PATCHES}
    warm = {
        patch: gases.fixed(gases.TEMPERATURE + WARMTH * wave(mesh.centres(patch))[0]) for patch in walls
    }  # fmt: skip
    fields = [
        gases.start_field("U", {patch: gases.fixed(_on_faces(mesh, patch)) for patch in walls}),
        gases.start_field("T", warm),
    ]
    air = {"viscosity_Pa_s": VISCOSITY, "conductivity_W_m_K": CONDUCTIVITY}
    with gases.started(mesh, folder, walls, fields, **air) as gas:
        x, share = gas.mesh.centres, gas.mesh.volumes / gas.mesh.volumes.sum()
        given, step = sources(x), COURANT * gas.mesh.volumes.min() ** (1.0 / 3.0) / sum(SPEEDS)
        state = gas.start(np.full(len(x), ROOM), tuple(given))
        for _ in range(math.ceil(TIME / step)):
            state = gas.advance(step, given)
    shape, slope = wave(x)
    found = state.fields
    level = found["pressure"] - share @ found["pressure"] - HEIGHT * (shape - share @ shape)
    off = {
        "velocity": (found["velocity"] - velocity(x), velocity(x)),
        "pressure": (level, HEIGHT * (shape - share @ shape)),
        "gradient of the pressure": (found["pressure_gradient"] - HEIGHT * slope, HEIGHT * slope),
        "temperature": (found["temperature"] - gases.TEMPERATURE - WARMTH * shape, WARMTH * shape),
    }
    return {what: _size(share, a) / _size(share, b) for what, (a, b) in off.items()}


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
            told = f"{name}: order of the {what} (errors {coarse:.2g}, {fine:.2g}) [-]"
            rows.append(check(told, min(order, 2.0), 2.0, 2.0 - ORDER))
    return rows
