"""Surfaces of liquids in space: on a grid, or, of a sheet in a room too wide for one, triangles between particles."""

from __future__ import annotations

import math

import numpy as np

from sdph.show import sampled
from sdph.show.shot import Shot, numbers

GRID = 0.5  # of the spacing: step of the grid on which a surface is found; our choice
MOST = 2e7  # points of that grid: half a minute and a GB; our choice
MANY = 300_000  # particles between which triangles are found (66 000 took 2 s on 28 November 2026); our choice
SMOOTHED = 60  # rounds of Taubin's smoothing of a surface, that takes the bumps of the particles; our choice
LONELY = 4  # particles with fewer neighbours within two spacings have no surface and are drawn as balls; our choice
REACH = 1.8  # spacings within which particles share a triangle: those of one piece by the default of `method.piece`
ALIKE = 1e-3  # of a spacing: particles nearer than that are one point of triangles; our choice


def of_liquid(shot: Shot, liquid: np.ndarray, field: str):
    """(mesh, mask (N,) of the particles that it stands for) of the liquid particles (mask), with the field's values."""
    return (of_bulk if affordable(shot, liquid) else of_film)(shot, liquid, field)


def affordable(shot: Shot, liquid: np.ndarray) -> bool:
    """True where the grid for the surface has no more than MOST points."""
    wide = np.ptp(np.asarray(shot.particles.points)[liquid], axis=0) + 4.0 * shot.spacing
    return float(np.prod(wide / (GRID * shot.spacing))) <= MOST


def of_bulk(shot: Shot, liquid: np.ndarray, field: str):
    """The same where the sum of volume and kernel is 1/2, smoothed."""
    shown = liquid & ~_lonely(shot, liquid)
    if not shown.any():
        return _nothing(liquid)
    places, volumes = np.asarray(shot.particles.points)[shown], shot.sizes()[shown] ** 3
    bounds = np.stack((places.min(axis=0), places.max(axis=0)), axis=1).ravel() + 2 * shot.spacing * np.tile([-1, 1], 3)
    grid, data = sampled.grid(bounds, GRID * shot.spacing), shot.particles.point_data
    arrays = {field: numbers(data[field])[shown]} if field in data else {}
    values, share = sampled.of_particles(grid, places, volumes, arrays, sampled.REACH * shot.spacing, 3)
    grid["share"] = share
    found = grid.contour([sampled.INSIDE], scalars="share", method="flying_edges")
    if not found.n_points:
        return _nothing(liquid)
    found = found.smooth_taubin(n_iter=SMOOTHED, pass_band=0.05).compute_normals()
    from scipy.ndimage import map_coordinates

    at = ((found.points - grid.origin) / grid.spacing).T
    for name, own in values.items():
        found[name] = map_coordinates(_spread(own, grid.dimensions), at, order=1, mode="nearest")
    return found, shown


def of_film(shot: Shot, liquid: np.ndarray, field: str):
    """The same of a liquid that may be one particle thick: triangles between particles whose circle around is no wider
    than that of three at REACH from each other (alpha shape, Edelsbrunner & Mucke 1994, ACM Trans. Graph. 13, 43)."""
    import pyvista

    own, data = np.flatnonzero(liquid), shot.particles.point_data
    cloud = pyvista.PolyData(np.asarray(shot.particles.points)[own])
    cloud["own"] = own
    if not 4 <= len(own) <= MANY:  # less is no tetrahedron
        return _nothing(liquid)
    shape = cloud.delaunay_3d(alpha=REACH * shot.spacing / math.sqrt(3.0), tol=ALIKE * shot.spacing / cloud.length)
    if not shape.n_cells:
        return _nothing(liquid)
    shown = np.zeros(len(liquid), bool)
    for kind, corners in shape.cells_dict.items():
        if kind in (pyvista.CellType.TRIANGLE, pyvista.CellType.TETRA):
            shown[own[corners]] = True
    outside = shape.extract_surface(algorithm="dataset_surface")
    found = pyvista.PolyData.from_regular_faces(outside.points, outside.faces.reshape(-1, 4)[:, 1:])
    if field in data:
        found[field] = numbers(data[field])[outside["own"]]
    return found, shown


def _nothing(liquid: np.ndarray):
    """No surface, which stands for no particle."""
    import pyvista

    return pyvista.PolyData(), np.zeros_like(liquid)


def _lonely(shot: Shot, liquid: np.ndarray) -> np.ndarray:
    """Mask (N,) of the liquid particles that make no surface."""
    from scipy.spatial import cKDTree

    places = np.asarray(shot.particles.points)[liquid]
    near = cKDTree(places).query_ball_point(places, 2.0 * shot.spacing, return_length=True, workers=-1) - 1
    found = np.zeros(len(liquid), bool)
    found[np.flatnonzero(liquid)[near < LONELY]] = True
    return found


def _spread(values, shape) -> np.ndarray:
    """Values on a grid as a cube, those that are none taken from the nearest that is."""
    from scipy.ndimage import distance_transform_edt

    cube = np.asarray(values).reshape(shape, order="F")
    if not np.isnan(cube).any() or np.isnan(cube).all():
        return cube
    nearest = distance_transform_edt(np.isnan(cube), return_distances=False, return_indices=True)
    return cube[tuple(nearest)]
