"""Pictures of a run: particles over gas cells, with scale bars and units."""

from __future__ import annotations

import math
import os
import sys
from pathlib import Path

import numpy as np

from sdph import schema
from sdph.case import read as cases
from sdph.case.sections import Domain
from sdph.engine.state import FIELDS, GAS, SOLID
from sdph.running import fields, output
from sdph.schema import CaseError
from sdph.show.timeline import read, state_at

WINDOW = (1200, 900)  # pixels
SHOWN = 0.75  # share of the window that the domain fills
ASLANT = 0.6  # of that size where a box is seen aslant and neighbours stand closer; our choice, by eye
LIGHT = 0.4  # of the point size of a liquid: that of gas beside it, so that the interface shows; our choice
BESIDE_BARS = 0.85  # of the window that a wide domain fills, or one seen aslant: colour bars and axes need the rest
WALL, CLEAR = "grey", 0.2  # colour and opacity of walls; our choice
LABELS = 6  # along the longest axis
SLAB = 0.25  # of the next longer side: a box so thin is looked at across
OFF_FACES = 1e-6  # of its lengths: a cut through the middle of a box is no face of its cells
MOVIES = {".gif": {"duration": 100, "loop": 0}, ".mp4": {"fps": 10, "macro_block_size": 2}}  # ten pictures a second
BAR = {
    "vertical": True,
    "position_y": 0.2,
    "height": 0.6,
    "width": 0.06,
    "fmt": "%.6g",
    "n_labels": 5,
    "title_font_size": 16,
    "label_font_size": 14,
}
GAS_UNITS = {
    "velocity": "m/s", "alpha_p": "1", "temperature": "K", "pressure": "Pa", "density": "kg/m3",
    "vapour_mass_fraction": "1", "vorticity": "1/s",
}  # fmt: skip
PARTICLE_UNITS = (
    {name: unit for name, (unit, _) in FIELDS.items()}
    | {
        "alpha_p": "1",
        "pressure": "Pa",
        "velocity": "m/s",
        "equivalent_stress": "Pa",
        "plastic_strain": "1",
        "damage": "1",
    }
    | {f"stress_{ab}": "Pa" for ab in ("xx", "yy", "zz", "xy", "yz", "zx")}
)


def show(folder: Path, png: Path | None = None, time: float | None = None, field: str | None = None) -> None:
    """A window on the last state of a run, or the same as a picture."""
    chosen, particles, gas = state_at(read(folder), time)
    if png is None and sys.platform == "linux" and not {"DISPLAY", "WAYLAND_DISPLAY"} & os.environ.keys():
        raise CaseError(
            "there is no display to open a window on; write a picture with --png FILE, or a movie with --movie FILE"
        )
    plotter = scene(particles, gas, field, f"t = {chosen:g} s", png is not None, walls=_walls(folder), up=_up(folder))
    if png is None:
        plotter.show()
    else:
        try:
            plotter.screenshot(str(png))
        except (OSError, ValueError) as error:
            raise CaseError(f"--png {png} cannot be written: {error}") from None
        finally:
            plotter.close()


def movie(folder: Path, target: Path, field: str | None = None) -> None:
    """All times of a run as a .gif or .mp4."""
    import imageio.v3 as imageio

    if target.suffix not in MOVIES:
        raise CaseError(f"--movie {target}: its name must end with {' or '.join(MOVIES)}")
    reader = read(folder)
    states, pictures = [state_at(reader, time) for time in reader.time_values], []
    ranges = [_range([state[part] for state in states], field or _usual(*states[0][1:])) for part in (1, 2)]
    walls = _walls(folder)
    box = _around([*(particles if gas is None else gas for _, particles, gas in states), *([walls] if walls else [])])
    for time, particles, gas in states:
        plotter = scene(
            particles,
            gas,
            field,
            f"t = {time:g} s",
            off_screen=True,
            ranges=ranges,
            box=box,
            walls=walls,
            up=_up(folder),
        )
        pictures.append(plotter.screenshot(return_img=True))
        plotter.close()
    try:
        imageio.imwrite(target, pictures, **MOVIES[target.suffix])
    except OSError as error:
        raise CaseError(f"{target} cannot be written: {error}") from None


def _walls(folder: Path):
    """Walls of a tank or of a surface mesh; None where a run has none."""
    file = folder / output.WALLS
    return fields.load(file) if file.exists() else None


def _up(folder: Path) -> tuple:
    """The axis, as a vector, that points up most; z where nothing falls."""
    case = folder / output.MARK
    return upwards(schema.read(Domain, cases.parsed(case).get("domain", {}), "domain").gravity if case.exists() else ())


def upwards(gravity) -> tuple:
    """The axis, as a vector (3,), against which gravity (d,) [m/s2] pulls most; z in two dimensions and where nothing
    falls."""
    falls = len(gravity) == 3 and min(gravity) < 0.0
    return tuple(float(a == (np.argmin(gravity) if falls else 2)) for a in range(3))


def _usual(particles, gas) -> str:
    """The field that is shown unasked: temperature where particles and gas have one, else velocity."""
    warm = gas is not None and (not particles.n_points or "temperature" in particles.array_names)
    return "temperature" if warm else "velocity"


def _range(meshes, field: str):
    """Least and largest of a field over all of the meshes, of a vector its length; None where none has it."""
    arrays = [np.asarray(mesh[field]) for mesh in meshes if mesh is not None and field in mesh.array_names]
    values = [array if array.ndim == 1 else np.linalg.norm(array, axis=1) for array in arrays if len(array)]
    finite = [own for own in (array[np.isfinite(array)] for array in values) if len(own)]
    return (min(v.min() for v in finite), max(v.max() for v in finite)) if finite else None


def _around(meshes) -> np.ndarray:
    """(6,) bounds [m] of all of them, x0, x1, y0, y1, z0, z1, as pyvista has them."""
    bounds = np.array([mesh.bounds for mesh in meshes if mesh.n_points] or [np.zeros(6)]).reshape(-1, 3, 2)
    return np.stack((bounds[:, :, 0].min(axis=0), bounds[:, :, 1].max(axis=0)), axis=1).ravel()


def scene(
    particles,
    gas,
    field: str | None,
    title: str,
    off_screen: bool,
    ranges=(None, None),
    box=None,
    walls=None,
    up=(0.0, 0.0, 1.0),
):
    """A plotter with the particles coloured by `field` (None: as `_usual` says) over the cells of
    the gas, in `walls`, `up` (3,) being upwards in space; `ranges` of the colours of both, and `box` that is shown (6,)
    [m] (None: those of the picture). Of two phases of particles the gas is drawn small."""
    import pyvista
    from vtkmodules.vtkCommonCore import vtkLogger

    if off_screen:  # VTK first tries an X server, complains, and then renders in software
        vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)

    given, field = field, field or _usual(particles, gas)
    _check_field(given, particles, gas)
    plotter = pyvista.Plotter(off_screen=off_screen, window_size=WINDOW)
    box = _around([gas if gas is not None else particles, *([walls] if walls else [])]) if box is None else box
    gas, across = _cut(gas) if gas is not None else (None, None)
    _draw(plotter, particles, gas, field, ranges, box, across is None)
    if walls:
        plotter.add_mesh(walls, color=WALL, opacity=CLEAR, lighting=False, line_width=2)
    plotter.add_text(title, font_size=12, position="upper_edge")
    if box[4] == box[5]:
        across = 2
    if across is not None:
        plotter.view_vector([float(a == across) for a in range(3)], viewup=(0.0, 1.0, 0.0) if up[across] else up)
        plotter.enable_parallel_projection()
    else:
        plotter.view_vector((1.0, 1.0, 1.0), viewup=up)
    _rule(plotter, box)
    plotter.reset_camera(bounds=_rounded(box))
    wide = box[1] - box[0] > box[3] - box[2]
    plotter.camera.zoom(BESIDE_BARS if wide or across is None else 0.95)
    return plotter


def _check_field(name: str | None, particles, gas) -> None:
    """`CaseError` where neither particles nor gas have a field of that name."""
    has = {*particles.point_data, *(gas.cell_data if gas is not None else ())}
    known = sorted(has & {*GAS_UNITS, *PARTICLE_UNITS, "velocity"})
    if name and name not in known:
        raise CaseError(f"--field {name}: this run has {', '.join(known)}")


def _draw(plotter, particles, gas, field: str, ranges, box, aslant: bool) -> None:
    """Gas and particles coloured by `field`; where a box is seen aslant particles are balls."""
    if gas is not None and field in gas.cell_data:
        bar = BAR | {"title": f"gas {field}\n[{GAS_UNITS.get(field, '1')}]", "position_x": 0.86}
        plotter.add_mesh(gas, scalars=field, cmap="YlOrRd", clim=ranges[1], scalar_bar_args=bar, lighting=False)
    if particles.n_points and field in particles.point_data:
        bar = BAR | {"title": f"particle {field}\n[{PARTICLE_UNITS[field]}]", "position_x": 0.07}
        size, look = _size(particles, box), {"lighting": False}
        if _lengths(box)[2] and aslant:  # seen aslant they are balls, which show depth by their shading
            size, look = ASLANT * size, {"render_points_as_spheres": True}
        for part, share in _phases(particles):
            colours = ranges[0] or _range([particles], field)
            plotter.add_mesh(
                part, scalars=field, cmap="inferno", clim=colours, scalar_bar_args=bar, point_size=share * size, **look
            )


def _rule(plotter, box) -> None:
    """Axes with round numbers around a box."""
    axes = {"xtitle": "x [m]", "ytitle": "y [m]", "ztitle": "z [m]", "font_size": 10, "fmt": "%.3g"}
    axes |= {
        f"n_{a}labels": max(2, round(LABELS * length / _lengths(box).max())) for a, length in zip("xyz", _lengths(box))
    }
    plotter.show_bounds(bounds=_rounded(box), location="outer", **axes)


def _cut(gas):
    """The gas, in space by the plane through the middle of its thinnest side; and that axis where it is a slab, else
    None."""
    lengths = _lengths(gas.bounds)
    if not lengths[2]:
        return gas, None
    across = int(np.argmin(lengths))
    beside = np.array(gas.center) + OFF_FACES * lengths
    return gas.slice("xyz"[across], origin=beside), across if lengths[across] < SLAB * np.median(lengths) else None


def _rounded(bounds) -> np.ndarray:
    """(6,) bounds [m] moved outwards to two digits of the longest side, for the numbers along the axes."""
    low, high = np.reshape(bounds, (3, 2)).T
    unit = 10.0 ** (math.floor(math.log10(max(high - low) or 1.0)) - 1.0)
    flat, slack = low == high, 1e-6  # of a unit: what is round already stays
    outer = np.floor(low / unit + slack) * unit, np.ceil(high / unit - slack) * unit
    return np.where(flat, (low, high), outer).T.ravel()


def _lengths(bounds) -> np.ndarray:
    """Lengths of a box along each axis."""
    return np.diff(np.reshape(bounds, (3, 2)))[:, 0]


def _phases(particles) -> list[tuple]:
    """(particles, share of the point size) of each phase."""
    light = particles["kind"] == GAS if "kind" in particles.point_data else np.zeros(particles.n_points, bool)
    if light.all() or not light.any():
        return [(particles, 1.0)]
    return [
        (particles.extract_points(own, include_cells=False), share) for own, share in ((~light, 1.0), (light, LIGHT))
    ]


def _size(particles, bounds) -> float:
    """Point size [pixels] at which neighbouring particles just touch."""
    box, lengths = _lengths(bounds), _lengths(particles.bounds)
    if "kind" in particles.point_data and (particles["kind"] == SOLID).all():  # bodies may have holes
        filled = (particles["mass"] / particles["density"]).sum()
    else:
        filled = lengths[lengths > 0.0].prod()
    spacing = (filled / particles.n_points) ** (1.0 / max(1, (lengths > 0.0).sum()))
    return max(2.0, SHOWN * min(WINDOW[0] / box[0], WINDOW[1] / box[1]) * spacing)
