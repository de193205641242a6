"""Pictures of two dimensions, or of a slab looked at across: colours pixel by pixel, all else as lines and letters."""

from __future__ import annotations

import numpy as np

from sdph.running.metrics import bubble
from sdph.show import raster, sampled
from sdph.show.canvas import DPI, Sheet
from sdph.show.look import Look, coloured, rgb
from sdph.show.raster import Pixels
from sdph.show.shot import Shot
from sdph.show.style import Scale, digits

ARROWS = 24  # along the longer side; our choice
LONG = 1.15  # of their distance: arrows as long as that stand for the fastest
EDGE = "#a0a0a0c0"  # colour of the line around particles in a gas
PALE = 0.3  # share of the paper in the colour of a gas around grains that lie together; our choice
WIDE = 3.0  # spacings: lone particles and gaps that are smaller have no line around them; our choice
PALER = " (gas phase: paler than the bar)"
FASTEST = 0.98  # quantile of the speeds that is drawn so long: a few fast ones would shrink all others; our choice


def draw(shot: Shot, look: Look, scales: dict[str, Scale], last: float, fine: int = 2) -> Sheet:
    """The sheet of a shot, one scale by its field, or a second one of particles that have that; `last` [s] is the time
    of the run's end, `fine` the pixels drawn along one that is shown."""
    right, up = shot.axes
    low, high = shot.box[::2][[right, up]], shot.box[1::2][[right, up]]
    sheet = Sheet(*np.maximum(high - low, 1e-30), look.colours, bars=len(scales))
    grid = raster.pixels(shot, int(fine * max(sheet.own) * DPI))
    (field, scale), *over = scales.items()
    colours, bulk, light = painted(shot, grid, field, scale, look)
    for name, own in over:
        values = raster.particles(shot, grid, name, smooth=False)[0]
        colours = np.where(np.isfinite(values)[..., None], coloured(values, own, look.colours), colours)
    sheet.axes.imshow(colours, extent=grid.edges, origin="lower", interpolation="antialiased", aspect="auto")
    if bulk.any():
        sheet.axes.contour(*_ticks(grid), bulk.astype(float), [0.5], colors=[EDGE], linewidths=0.8)
    if light.any():
        _line(sheet, grid, raster.surface(shot, grid), sampled.INSIDE)
    if shot.walls is not None:
        _walls(sheet, shot)
    if look.outline:
        _outline(sheet, shot, grid)
    if look.vectors:
        _arrows(sheet, shot)
    sheet.head(shot.title + PALER * bool(light.any()), shot.time, last)
    sheet.rule(low, high, ("xyz"[right], "xyz"[up]))
    for place, (name, own) in enumerate(scales.items()):
        sheet.bar(own, shot.words(name), place)
    return sheet


def painted(shot: Shot, grid: Pixels, field: str, scale: Scale, look: Look) -> tuple[np.ndarray, ...]:
    """(rows, columns, 3) colours; where particles lie together in a gas of cells; and where a gas of particles is.

    The gas of cells is paler than grains that lie in it, or of one colour both could not be told apart; a volume
    fraction tells by itself."""
    theme, under = look.colours, raster.gas(shot, grid, field, look.smooth)
    paper = rgb(theme.paper)
    values, covered, light = raster.particles(shot, grid, field, look.smooth)
    bulk = raster.bulk(covered, (WIDE * shot.spacing) ** 2 / np.prod(grid.step))
    bulk &= shot.gas is not None and not bulk.all()
    found = np.where(np.isfinite(under)[..., None], coloured(under, scale, theme), paper)
    found = found + PALE * (paper - found) if bulk.any() and field != "alpha_p" else found
    over = coloured(values, scale, theme)
    over = np.where(light[..., None], over + raster.BLEND * (paper - over), over)
    return np.where(covered[..., None], over, found), bulk, light


def _line(sheet: Sheet, grid: Pixels, values, level: float) -> None:
    """A contour, drawn so that it shows on every colour."""
    known = values[np.isfinite(values)]
    if not known.size or not known.min() < level < known.max():
        return
    for colour, width in (("black", 2.4), ("white", 1.1)):
        sheet.axes.contour(*_ticks(grid), values, [level], colors=[colour], linewidths=width)


def _ticks(grid: Pixels) -> tuple[np.ndarray, np.ndarray]:
    """Places [m] of the columns and of the rows."""
    x0, _, y0, _ = grid.edges
    dy, dx = grid.step
    return x0 + (np.arange(grid.shape[1]) + 0.5) * dx, y0 + (np.arange(grid.shape[0]) + 0.5) * dy


def _outline(sheet: Sheet, shot: Shot, grid: Pixels) -> None:
    """Outline of bubbles, alpha_p = VOID between centres of cells; without a gas, the surface of the particles."""
    if shot.gas is None or "alpha_p" not in shot.gas.cell_data:
        _line(sheet, grid, raster.surface(shot, grid), sampled.INSIDE)
        return
    _line(sheet, grid, raster.gas(shot, grid, "alpha_p", smooth=True), bubble.VOID)


def _walls(sheet: Sheet, shot: Shot) -> None:
    """Lines of walls; of a surface in space its cut by the picture's plane."""
    from matplotlib.collections import LineCollection

    walls = shot.walls
    if walls.n_lines == 0 and walls.n_faces:
        walls = walls.slice("xyz"[shot.across], origin=[shot.level] * 3)
    points, lines, at = np.asarray(walls.points)[:, shot.axes], np.asarray(walls.lines), 0
    paths = []
    while at < len(lines):
        paths.append(points[lines[at + 1 : at + 1 + lines[at]]])
        at += 1 + lines[at]
    drawn = LineCollection(paths, colors=sheet.theme.wall, linewidths=2.2, capstyle="projecting", clip_on=False)
    sheet.axes.add_collection(drawn, autolim=False)


def _arrows(sheet: Sheet, shot: Shot) -> None:
    """Velocity on a coarse grid, of particles where there are any, else of gas; the arrow beside tells how long."""
    grid = raster.pixels(shot, ARROWS)
    velocity = _velocity(shot, grid)
    speed = np.linalg.norm(velocity, axis=1)
    moving = np.isfinite(speed) & (speed > 0.0)
    if not moving.any():
        return
    fastest = float(np.quantile(speed[moving], FASTEST))
    x0, x1, _, _ = grid.edges
    step = (x1 - x0) / grid.shape[1]
    places = grid.flat[moving][:, shot.axes]
    drawn = sheet.axes.quiver(
        *places.T, *velocity[moving].T, angles="xy", scale_units="xy", scale=fastest / (LONG * step), pivot="mid",
        color="white", edgecolor="black", linewidth=0.4, units="inches", width=0.028, headwidth=3.2, headlength=3.8,
    )  # fmt: skip
    told = float(f"{fastest:.1g}")
    place = (sheet.size[0] - 0.62, 0.3) if not sheet.flat else (sheet.size[0] - 0.75, 0.5)
    sheet.axes.quiverkey(
        drawn, place[0] / sheet.size[0], place[1] / sheet.size[1], told, f"{digits(told)} m/s", coordinates="figure",
        labelpos="S", labelcolor=sheet.theme.ink, fontproperties={"size": 9}, labelsep=0.05,
    )  # fmt: skip


def _velocity(shot: Shot, grid: Pixels) -> np.ndarray:
    """(P, 2) [m/s] at the pixels; nan where nothing is."""
    found = np.full((len(grid.flat), 3), np.nan)
    if shot.gas is not None:
        found = sampled.of_cells(shot.gas, grid.flat, "velocity")
    if shot.particles.n_points:
        import pyvista

        places, volumes = np.asarray(shot.particles.points), shot.sizes() ** shot.dimensions
        own, share = sampled.of_particles(
            pyvista.PolyData(grid.flat), places, volumes, {"velocity": shot.particles["velocity"]},
            sampled.REACH * shot.spacing, shot.dimensions,
        )  # fmt: skip
        found = np.where((share > 0.5 * sampled.INSIDE)[:, None], own["velocity"], found)
    return found[:, shot.axes]
