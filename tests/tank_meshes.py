"""Surface meshes of tanks that tests make."""

import meshio
import numpy as np

from sdph.engine.walls import facets

SIDES = 48


def turned_mesh(path, profile):
    """A file of a profile (P, 2) of radii and heights [m], from axis to axis upwards, turned round the upright axis."""
    profile, turn = np.asarray(profile), 2.0 * np.pi * np.arange(SIDES) / SIDES
    rings = profile[:, :1, None] * np.stack((np.cos(turn), np.sin(turn)))[None]  # (P, 2, S)
    corners = np.concatenate((rings, np.broadcast_to(profile[:, 1:, None], (len(profile), 1, SIDES))), axis=1)
    corners = corners.transpose(0, 2, 1)  # (P, S, 3)
    after = np.roll(corners, -1, axis=1)
    a, b, c, d = corners[:-1], after[:-1], after[1:], corners[1:]
    triangles = np.concatenate([np.stack(three, axis=2).reshape(-1, 3, 3) for three in ((a, b, c), (a, c, d))])
    triangles = triangles[facets.sizes(triangles) > 1e-12]  # on the axis some have none
    meshio.write_points_cells(
        path, triangles.reshape(-1, 3), [("triangle", np.arange(3 * len(triangles)).reshape(-1, 3))]
    )
    return path
