"""The box of the domain: its sides, and how far particles in it are apart."""

from typing import NamedTuple

import numpy as np

from sdph.laws.compiled import inlined

SIDES = {"left": (0, 0), "right": (0, 1), "bottom": (1, 0), "top": (1, 1), "back": (2, 0), "front": (2, 1)}  # axis, end
PAIRS = tuple(zip(list(SIDES)[::2], list(SIDES)[1::2]))  # of opposite sides, by axis


@inlined
def apart(s, box, i, j):
    """r_i - r_j (3 components; the last 0 in two dimensions), through periodic boundaries."""
    dz = s.z[i] - s.z[j] if deep(box) else 0.0
    return nearest_image(box, s.x[i] - s.x[j], s.y[i] - s.y[j], dz)


@inlined
def faster(s, box, i, j):
    """v_i - v_j (3 components; the last 0 in two dimensions)."""
    return s.u[i] - s.u[j], s.v[i] - s.v[j], s.w[i] - s.w[j] if deep(box) else 0.0


@inlined
def squared(dx, dy, dz):
    """Square of a separation."""
    return dx * dx + dy * dy + dz * dz


OPEN = 0.0  # period of an axis that is not periodic


class Plane(NamedTuple):
    """Lengths of a periodic box in two dimensions and their inverses, both 0 along an open axis: an image costs no
    branch."""

    length_x: float
    length_y: float
    inverse_x: float
    inverse_y: float


class Space(NamedTuple):
    """The same in three dimensions."""

    length_x: float
    length_y: float
    length_z: float
    inverse_x: float
    inverse_y: float
    inverse_z: float


OPEN_PLANE, OPEN_SPACE = (), (0.0,)  # boxes in which nothing is periodic


def box_of(period, dimensions: int) -> tuple:
    """The box for kernels. They tell the four kinds apart by length when they are compiled, so that neither a third
    dimension that is not there costs anything nor images where nothing is periodic."""
    lengths = [float(length) for length in period][:dimensions]
    if not any(lengths):
        return OPEN_PLANE if dimensions == 2 else OPEN_SPACE
    return (Plane if dimensions == 2 else Space)(*lengths, *(1.0 / length if length else 0.0 for length in lengths))


@inlined
def deep(box):
    """True where a box has three dimensions."""
    return len(box) == 1 or len(box) == 6


@inlined
def nearest_image(box, dx, dy, dz):
    """A separation, through the periodic boundaries where that is shorter."""
    if len(box) < 2:
        return dx, dy, dz
    dx -= box.length_x * np.rint(dx * box.inverse_x)
    dy -= box.length_y * np.rint(dy * box.inverse_y)
    if len(box) == 4:
        return dx, dy, dz
    return dx, dy, dz - box.length_z * np.rint(dz * box.inverse_z)
