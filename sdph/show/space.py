"""Pictures in space: liquids as smooth lit surfaces, grains and solids as balls, gas as a cut, vessels transparent."""

from __future__ import annotations

import numpy as np

from sdph.engine.state import LIQUID
from sdph.running.metrics import bubble
from sdph.show import eye, surfaces
from sdph.show.canvas import DPI, Sheet
from sdph.show.eye import Eye
from sdph.show.look import Look, coloured, rgb
from sdph.show.shot import Shot, numbers
from sdph.show.style import Scale

AROUND = 0.1  # of the box, for numbers along its edges
CLEAR = 0.18  # opacity of vessels; our choice
BALL = 0.62  # radius over edge: a ball of the volume of the cube, so that neighbours just overlap
DISC = 0.71  # the same of flat ones: half a diagonal, so that a lattice has no gaps
DENSE = 0.3  # volume fraction from which grains hide what is behind them: the front half is left out; our choice
LIT = {"ambient": 0.35, "diffuse": 0.7, "specular": 0.25, "specular_power": 20}


def draw(shot: Shot, look: Look, scales: dict[str, Scale], last: float, fine: int = 2) -> Sheet:
    """The sheet of a shot in space, of one field; `fine` as in sdph.show.flat."""
    ((field, scale),) = scales.items()
    view = eye.on(shot)
    room = AROUND * max(view.high - view.low)
    low, high = view.low - room, view.high + room
    sheet = Sheet(*(high - low), look.colours)
    window = np.round(fine * sheet.own * DPI).astype(int)
    picture = _rendered(shot, look, scale, field, view, window, 0.5 * (low + high), 0.5 * (high - low)[1])
    sheet.axes.imshow(picture, extent=(low[0], high[0], low[1], high[1]), aspect="auto", interpolation="antialiased")
    sheet.axes.set_axis_off()
    sheet.axes.set_xlim(low[0], high[0])
    sheet.axes.set_ylim(low[1], high[1])
    eye.rule(sheet, shot.box, view)
    sheet.head(shot.title, shot.time, last)
    sheet.bar(scale, shot.words(field))
    return sheet


def _rendered(shot, look, scale, field, view: Eye, window, centre, half: float) -> np.ndarray:
    """(rows, columns, 3) pixels; `centre` (2,) and `half` height [m] of what is seen."""
    drawn = plotter(window, look)
    fill(drawn, shot, look, scale, field, view)
    focus = (
        view.right * centre[0] + view.up * centre[1] + view.towards * (shot.box.reshape(3, 2).mean(1) @ view.towards)
    )
    far = 4.0 * np.linalg.norm(shot.box[1::2] - shot.box[::2]) + 1e-30
    drawn.camera_position = [focus + far * view.towards, focus, view.up]
    drawn.enable_parallel_projection()
    drawn.camera.parallel_scale = half
    drawn.camera.clipping_range = (0.1 * far, 2.0 * far)
    picture = drawn.screenshot(return_img=True)
    drawn.close()
    return picture[..., :3]


def plotter(size, look: Look, off_screen: bool = True):
    """A pyvista plotter of `size` (2,) pixels."""
    import pyvista
    from vtkmodules.vtkCommonCore import vtkLogger

    if off_screen:  # VTK first tries an X server, complains, and then renders in software
        vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    made = pyvista.Plotter(off_screen=off_screen, window_size=[int(n) for n in size], lighting="three lights")
    made.set_background(look.colours.paper)
    return made


def fill(plotter, shot: Shot, look: Look, scale: Scale, field: str, view: Eye | None) -> None:
    """Put all that a shot shows into a plotter; `view` (None: none is fixed) decides what would hide the rest."""
    import pyvista

    theme = look.colours
    plotter.add_mesh(pyvista.Box(shot.box).outline(), color=theme.faint, line_width=1, lighting=False)
    if shot.walls is not None:
        _vessel(plotter, shot.walls, theme)
    if shot.gas is not None:
        _gas(plotter, shot, look, scale, field, view)
    kinds = _kinds(shot)
    liquid = kinds == LIQUID
    balls = ~shot.light() & _in_sight(shot, view)
    if shot.dimensions == 3 and liquid.any():
        balls &= ~liquid
        balls |= _liquid(plotter, shot, liquid, scale, field, theme)
    _balls(plotter, shot, balls, scale, field, theme)
    if look.vectors:
        _arrows(plotter, shot, theme)


def _kinds(shot: Shot) -> np.ndarray:
    data = shot.particles.point_data
    return np.asarray(data["kind"]) if "kind" in data else np.zeros(shot.particles.n_points)


def _in_sight(shot: Shot, view: Eye | None) -> np.ndarray:
    """Mask (N,) of the grains to draw: in front of the cut of a dense bed they are left out."""
    data, count = shot.particles.point_data, shot.particles.n_points
    if view is None or shot.gas is None or "alpha_p" not in data or np.max(data["alpha_p"], initial=0.0) < DENSE:
        return np.ones(count, bool)
    axis, middle = _cut(shot, view)
    return (np.asarray(shot.particles.points)[:, axis] - middle) * np.sign(view.towards[axis]) <= 0.0


def _cut(shot: Shot, view: Eye | None) -> tuple[int, float]:
    """(axis, place [m]) of the level cut through the middle of the gas that the eye looks at most."""
    towards = np.array([0.0, 1.0, 0.0]) if view is None else view.towards
    axis = int(np.argmax(np.abs(towards) * (1.0 - np.asarray(shot.up))))
    return axis, float(shot.box[2 * axis : 2 * axis + 2].mean())


def _gas(plotter, shot: Shot, look: Look, scale: Scale, field: str, view: Eye | None) -> None:
    """The gas on its cut, and the outline of bubbles there."""
    axis, middle = _cut(shot, view)
    origin = np.array(shot.gas.center)
    origin[axis] = middle + 1e-6 * shot.gas.length  # a cut on a face of cells belongs to none of them
    cut = shot.gas.slice("xyz"[axis], origin=origin) if shot.dimensions == 3 else shot.gas
    if field in cut.cell_data:
        _add(plotter, cut, cut.cell_data, field, scale, look.colours, lighting=False)
    if look.outline and "alpha_p" in cut.cell_data:
        line = cut.cell_data_to_point_data().contour([bubble.VOID], scalars="alpha_p")
        if line.n_points:
            plotter.add_mesh(line, color=look.colours.ink, line_width=4, lighting=False)


def _add(plotter, mesh, data, field: str, scale, theme, **look) -> None:
    """A mesh in colours of the scale."""
    if not mesh.n_cells:
        return
    mesh = mesh.copy()
    values = (
        coloured(numbers(data[field]), scale, theme) if field in data else np.tile(rgb(theme.void), (mesh.n_points, 1))
    )
    target = mesh.cell_data if len(values) == mesh.n_cells and data is not mesh.point_data else mesh.point_data
    target["colour"] = np.round(255.0 * values).astype(np.uint8)
    plotter.add_mesh(mesh, scalars="colour", rgb=True, **look)


def _liquid(plotter, shot: Shot, liquid, scale, field: str, theme) -> np.ndarray:
    """The surface of the liquid (mask); mask (N,) of the particles that it does not stand for."""
    found, shown = surfaces.of_liquid(shot, liquid, field)
    _add(plotter, found, found.point_data, field, scale, theme, smooth_shading="Normals" in found.point_data, **LIT)
    return liquid & ~shown


def _balls(plotter, shot: Shot, drawn, scale, field: str, theme) -> None:
    """Particles as balls of their size, droplets of a thin spray smaller."""
    if not drawn.any():
        return
    import pyvista
    from vtkmodules.vtkRenderingCore import vtkActor
    from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLSphereMapper

    data = shot.particles.point_data
    cloud = pyvista.PolyData(np.asarray(shot.particles.points)[drawn])
    radii = (BALL if shot.dimensions == 3 else DISC) * shot.drawn()[drawn]
    cloud["radius"] = radii.astype(np.float32)  # VTK ends the process with doubles
    values = numbers(data[field])[drawn] if field in data else np.full(cloud.n_points, np.nan)
    cloud["colour"] = np.round(255.0 * coloured(values, scale, theme)).astype(np.uint8)
    mapper, actor = vtkOpenGLSphereMapper(), vtkActor()
    mapper.SetInputData(cloud)
    mapper.SetScaleArray("radius")
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("colour")
    mapper.SetColorModeToDirectScalars()
    actor.SetMapper(mapper)
    actor.property.ambient, actor.property.diffuse, actor.property.specular = 0.35, 0.7, 0.1
    plotter.add_actor(actor)


def _vessel(plotter, walls, theme) -> None:
    """A vessel: its far side as a pale surface, so that nothing in it is veiled, and its edges."""
    if walls.n_lines or not walls.n_faces:
        plotter.add_mesh(walls, color=theme.wall, line_width=3, lighting=False)
        return
    whole = walls.clean()  # facets of an STL share no corners: each edge would be one of the vessel
    plotter.add_mesh(whole, color=theme.wall, opacity=CLEAR, culling=_near_side(whole), smooth_shading=True)
    edges = whole.extract_feature_edges(40.0, non_manifold_edges=False)
    if edges.n_cells:
        plotter.add_mesh(edges, color=theme.wall, line_width=2, lighting=False)


def _near_side(walls) -> str:
    """The faces of a vessel that lie between its inside and the eye: "front" where normals point outwards, else
    "back"."""
    sized = walls.compute_cell_sizes(length=False, volume=False)
    along = ((sized.cell_centers().points - np.array(walls.center)) * walls.face_normals).sum(axis=1)
    return "front" if along @ sized["Area"] > 0.0 else "back"


def _arrows(plotter, shot: Shot, theme) -> None:
    """Velocity of some particles as arrows."""
    cloud = shot.particles
    if not cloud.n_points:
        return
    every = cloud.extract_points(np.arange(0, cloud.n_points, max(1, cloud.n_points // 400)), include_cells=False)
    fastest = float(np.linalg.norm(cloud["velocity"], axis=1).max()) or 1.0
    longest = 0.08 * float(np.max(shot.box[1::2] - shot.box[::2]))
    plotter.add_mesh(every.glyph(orient="velocity", scale="velocity", factor=longest / fastest), color=theme.ink)
