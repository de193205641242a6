"""The place that a picture in space is looked at from, and the numbers along the edges of its box."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from sdph.show import style
from sdph.show.canvas import TICKS, Sheet
from sdph.show.shot import Shot

FROM = (0.5, 0.8, 0.42)  # along the longer level axis, the shorter one, and up: where the eye is; our choice


class Eye(NamedTuple):
    """Unit vectors (3,) to the right, up and towards the eye; extents [m] of the box seen from there."""

    right: np.ndarray
    up: np.ndarray
    towards: np.ndarray
    low: np.ndarray
    high: np.ndarray

    def seen(self, places) -> np.ndarray:
        """(N, 2) [m] of places (N, 3) on the picture."""
        return np.asarray(places) @ np.stack((self.right, self.up), axis=1)


def on(shot: Shot) -> Eye:
    """The eye of a shot, so that the broad side is seen and up is up."""
    low, high = shot.box[::2], shot.box[1::2]
    vertical = int(np.argmax(shot.up))
    level = sorted((a for a in range(3) if a != vertical), key=lambda a: -(high - low)[a])
    long, short, up = (np.eye(3)[a] for a in (*level, vertical))
    sign = 1.0 if np.cross(up, short) @ long > 0.0 else -1.0
    towards = -FROM[0] * long + FROM[1] * sign * short + FROM[2] * up
    towards /= np.linalg.norm(towards)
    right = np.cross(up, towards)
    right /= np.linalg.norm(right)
    above = np.cross(towards, right)
    seen = corners(shot.box) @ np.stack((right, above), axis=1)
    return Eye(right, above, towards, seen.min(axis=0), seen.max(axis=0))


def corners(box: np.ndarray) -> np.ndarray:
    """(8, 3) corners of a box (6,) [m]."""
    return np.array([[box[i], box[2 + j], box[4 + k]] for i in (0, 1) for j in (0, 1) for k in (0, 1)])


def rule(sheet: Sheet, box: np.ndarray, view: Eye) -> None:
    """Numbers along the three edges of the box that lie lowest and leftmost on the picture."""
    factor, unit = style.prefixed("m", float(np.abs(box).max()))
    for axis in range(3):
        low, high = box[2 * axis : 2 * axis + 2]
        if high > low:
            edge = _edge(box, axis, view)
            middle = view.seen(box.reshape(3, 2).mean(axis=1))
            _number(sheet, edge, middle, (low / factor, high / factor), f"{'xyz'[axis]} [{unit}]")


def _edge(box: np.ndarray, axis: int, view: Eye) -> np.ndarray:
    """(2, 2) ends on the picture of the box's edge along an axis that is the lowest there; of upright ones the one to
    the left."""
    starts, along = corners(box), np.eye(3)[axis] * (box[2 * axis + 1] - box[2 * axis])
    starts = starts[starts[:, axis] == box[2 * axis]]
    middles = view.seen(starts + 0.5 * along)
    upright = abs(view.seen(along)[0]) < 1e-9 * np.abs(along).max()
    own = starts[np.argmin(middles[:, 0 if upright else 1])]
    return view.seen(np.stack((own, own + along)))


def _number(sheet: Sheet, edge: np.ndarray, middle: np.ndarray, ends: tuple, name: str) -> None:
    """Ticks and numbers from ends[0] to ends[1] along an edge (2, 2) of the picture, on the side away from `middle`."""
    from matplotlib import ticker

    inch = np.ptp(sheet.axes.get_xlim()) / sheet.own[0]
    step, length = edge[1] - edge[0], float(np.linalg.norm(edge[1] - edge[0]))
    away = np.array([-step[1], step[0]]) / length
    away *= np.sign(away @ (edge.mean(axis=0) - middle)) or 1.0
    ticks = ticker.MaxNLocator(max(1, round(length / inch / 0.8)), steps=TICKS).tick_values(*ends)
    slack = 1e-9 * (ends[1] - ends[0])
    letters = {"ha": "center", "va": "center", "color": sheet.theme.ink}
    for tick in ticks[(ticks >= ends[0] - slack) & (ticks <= ends[1] + slack)]:
        place = edge[0] + step * (tick - ends[0]) / (ends[1] - ends[0])
        sheet.axes.plot(*np.stack((place, place + 0.06 * inch * away)).T, color=sheet.theme.faint, linewidth=0.8)
        sheet.axes.text(*(place + 0.22 * inch * away), style.digits(tick), fontsize=8, **letters)
    far = 0.45 + 0.2 * abs(away[0])  # numbers are wider than high
    sheet.axes.text(*(edge.mean(axis=0) + far * inch * away), name, fontsize=9, **letters)
