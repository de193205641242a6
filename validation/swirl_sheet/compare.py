"""A swirling sheet: its angle against straight flight and the sheet's equation, its mass, and what is only reported."""

from __future__ import annotations

import dataclasses
import math
import tempfile
from pathlib import Path

import numpy as np

from sdph.engine import state as particles
from sdph.engine import table
from sdph.engine.state import LIQUID
from sdph.laws import sheets
from sdph.methods.mps import sheet
from sdph.methods.mps.mps import RESOLVED
from sdph.running.alone import Alone
from sdph.running.inputs import DROPS
from sdph.show import shot, surfaces
from sdph.study.compare import check

WAY = 0.012  # m along the axis, when the run without tension is looked at: the sheet has not torn
ANGLE, SPEED = 0.3, 1e-3  # deg, of the speed: issue 21, without tension
BENT = 0.03  # deg, of the difference by tension: issue 21
LABELS = (f"fewer than {RESOLVED} particles", f"{RESOLVED} particles or more")
HAN_GAS, HAN_ANGLE = 1.2, 43.0  # kg/m3, deg: swirl-sheet.md, section 3


# the other speeds of the paper, up to WAY
SLOWER = ("nozzles.mouth.speed_m_s=15.0", "run.end_time_s=8e-4")
FASTER = ("nozzles.mouth.speed_m_s=25.0", "run.end_time_s=4.8e-4", "run.output_interval_s=4.8e-5")
OTHER = ("method.pressure=weakly_compressible",)  # the same without an equation to solve for the pressure
# waves that gas makes grow, up to 14 mm, coarse: particles tell thickness and speed alone
ON = 'effects=["laminar_viscosity","free_energy_tension","inflow","outflow",%s]'
COARSE = ("resolution.spacing_mm=0.1", "run.output_interval_s=1e-4")
TORN = (*COARSE, ON % '"suction"', "suction.gas_density_kg_m3=1.2")
AT = {u: (*TORN, f"nozzles.mouth.speed_m_s={u}.0", f"run.end_time_s={0.014 / u:.3g}") for u in (15, 20, 25)}
# holes where the sheet is two spacings thick, 1.05 mm from the mouth
PIERCED = (
    ON % '"perforation"', "perforation.thickness_um=133.2", "perforation.spacing_mm=0.5", "run.end_time_s=1.5e-4",
    "run.output_interval_s=5e-5",
)  # fmt: skip
VARIANTS = {
    "swirl_sheet": ((), ["exact"]), "weakly_compressible": (OTHER, ["exact"]),
    "at_15": (SLOWER, ["angles"]), "at_25": (FASTER, ["angles"]),
    **{f"suction_{u}": (own, ["suction"]) for u, own in AT.items()}, "perforation": (PIERCED, ["perforation"]),
}  # fmt: skip
PLACE = 0.1  # of the way to where the law has holes; our choice, as thickness is told by 6 to 60 neighbours


def exact(run) -> list[dict]:
    """Angles, mass, and what is only reported."""
    case, nozzle = run.case, sheet.nozzle_of(run.case)
    rate = case.liquid.density * math.pi * (nozzle.radius**2 - nozzle.inner_radius**2) * nozzle.speed
    layer = rate / nozzle.speed * case.resolution.spacing
    came = check(
        "mass through the nozzle [kg]", run.summary["injected_kg"], rate * run.summary["time_s"], 0.5001 * layer
    )
    _figure(run)
    _views(run)
    return [*angles(run), came, *_reported(run)]


def angles(run) -> list[dict]:
    """Half angle and speed without tension, and what tension changes, over the same range."""
    case, nozzle = run.case, sheet.nozzle_of(run.case)
    early = min(WAY / nozzle.speed, run.summary["time_s"])
    straight = _straight(case, early)
    bent = _places(run, early)
    length = min(sheet.reach(straight), sheet.reach(bent))
    middle = 0.5 * (nozzle.inner_radius + nozzle.radius)
    z = np.linspace(0.0, length, 400)
    radius = sheets.ballistic_radius(z, middle, nozzle.swirl)
    exact_angle, found = (math.degrees(sheet.half_angle_of_meridian(z, radius, length)), _angle(straight, length))
    return [
        check("without tension: half angle [deg]", found, exact_angle, ANGLE),
        check("without tension: mean speed [m/s]", straight.speed, nozzle.speed * sheet.slant(nozzle), SPEED, True),
        check(
            "by tension: half angle more [deg]", _angle(bent, length) - found, _bent(case, length) - exact_angle, BENT
        ),
    ]


def _figure(run) -> None:
    """Sizes of the drops that left, by volume: histogram and what is below, resolved and not."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    try:
        _, found = table.numbers(run.folder / DROPS, ("diameter_m", "particles"))
    except ValueError:  # nothing has left yet
        return
    d, whole = found["diameter_m"], found["particles"] >= RESOLVED
    volume = d**3 / (d**3).sum()
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(11, 4), constrained_layout=True)
    edges = np.linspace(0.0, 1e6 * d.max() * 1.01, 40)
    parts = [1e6 * d[~whole], 1e6 * d[whole]]
    left.hist(parts, edges, weights=[volume[~whole], volume[whole]], stacked=True, label=LABELS)
    left.set(xlabel="diameter [um]", ylabel="share of the volume")
    order = np.argsort(d)
    right.plot(1e6 * d[order], np.cumsum(volume[order]), "k-", label="all")
    resolved = order[whole[order]]
    if len(resolved):
        right.plot(1e6 * d[resolved], np.cumsum(volume[resolved]) / volume[resolved].sum(), "C1-", label=LABELS[1])
    right.set(xlabel="diameter [um]", ylabel="share of the volume below")
    for axes in (left, right):
        axes.legend()
    figure.savefig(run.folder / "sizes.png", dpi=110)
    pyplot.close(figure)


def _views(run) -> None:
    """The sheet in the end as a surface, from aside and from the front, and in a section through its axis one spacing
    to each side; what belongs to no surface as points."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    shown, nozzle = shot.of_folder(run.folder), sheet.nozzle_of(run.case)
    film, covered = surfaces.of_film(shown, np.ones(shown.particles.n_points, bool), "")
    places = 1e3 * sheet.about_axis(nozzle, np.asarray(shown.particles.points, float))
    film.points = 1e3 * sheet.about_axis(nozzle, np.asarray(film.points, float))
    cut = np.abs(places[:, 1]) < 1e3 * run.case.resolution.spacing
    figure, axes = pyplot.subplots(1, 3, figsize=(15, 5.4), constrained_layout=True)
    views = (
        ("from aside", 2, 0, ~covered),
        ("section through the axis", 2, 0, cut),
        ("from the front", 1, 0, ~covered),
    )
    for own, (title, right, up, points) in zip(axes, views):
        own.plot(places[points, right], places[points, up], ".", color="0.4", markersize=0.8)
        own.set(aspect="equal", title=title, xlabel=f"{'xyz'[right]} [mm]", ylabel=f"{'xyz'[up]} [mm]")
        if points is not cut and film.n_cells:
            _drawn(own, film, right, up)
    figure.savefig(run.folder / "views.png", dpi=110)
    pyplot.close(figure)


def _drawn(axes, film, right: int, up: int) -> None:
    """Triangles seen along the third axis, the nearest last, darker where they stand across it."""
    from matplotlib import colormaps
    from matplotlib.collections import PolyCollection

    across, corners = 3 - right - up, film.points[film.regular_faces]
    order = np.argsort(corners[:, :, across].mean(axis=1))
    colours = colormaps["Blues"](0.95 - 0.5 * np.abs(film.face_normals[order, across]))
    axes.add_collection(PolyCollection(corners[order][:, :, [right, up]], facecolors=colours, zorder=3))


def _reported(run) -> list[dict]:
    """Numbers without a bar: what the method gives, beside particles that fly straight and beside Han's law."""
    case, nozzle, own = run.case, sheet.nozzle_of(run.case), run.summary
    width, sigma = nozzle.radius - nozzle.inner_radius, case.parameters["free_energy_tension"].coefficient
    han = sheets.han_length(case.liquid.density, sigma, width, math.radians(HAN_ANGLE), HAN_GAS, nozzle.speed)
    rows = [("break-up length, reported beside straight flight's [m]", own["break_up_length_ballistic_m"])]
    rows.append(("break-up length, reported beside Han's [m]", han))
    lengths = [check(name, own["break_up_length_m"], reference, math.inf) for name, reference in rows]
    return [*lengths, *_of_nozzles(nozzle, own["half_angle_deg"])]


def _of_nozzles(nozzle, angle: float) -> list[dict]:
    """Mouth and half angle [deg] beside those of an inviscid nozzle, which is not computed: no bar."""
    core, along = (nozzle.inner_radius / nozzle.radius) ** 2, math.cos(math.radians(angle)) ** 2
    as_wide = (1.0 - along) / (1.0 + along)  # air core of the nozzle whose cone is as wide
    told = [
        ("half angle, inviscid nozzle of this air core [deg]", angle, math.degrees(sheets.inviscid_half_angle(core))),
        ("flow over the mouth's at the whole speed", (1.0 - core) / sheet.slant(nozzle),
         float(sheets.discharge_coefficient(core))),
        ("geometric characteristic of a cone as wide", sheets.geometric_characteristic(as_wide),
         sheets.geometric_characteristic(core)),
    ]  # fmt: skip
    return [check(f"reported beside an inviscid nozzle: {name}", *values, math.inf) for name, *values in told]


def suction(run) -> list[dict]:
    """Way to where waves tear the sheet, as its particles add it up, against the law; what light then tells."""
    case, own = run.case, run.summary
    nozzle, sigma = sheet.nozzle_of(case), case.parameters["free_energy_tension"].coefficient
    middle, width = 0.5 * (nozzle.inner_radius + nozzle.radius), nozzle.radius - nozzle.inner_radius
    gas, slant = case.parameters["suction"].gas_density, sheet.slant(nozzle)
    law = sheets.suction_length(middle, width, nozzle.speed, nozzle.swirl, case.liquid.density, gas, sigma)
    given = case.liquid.density, sigma, width, math.radians(HAN_ANGLE), gas
    return [
        check("way to the holes [m]", own["holes_way_m"], slant * law, PLACE, True),
        check("the same, reported beside Han's of the whole speed [m]", own["holes_way_m"],
              sheets.han_length(*given, slant * nozzle.speed), math.inf),
        check("the same, reported beside Han's of the speed along the axis [m]", own["holes_way_m"],
              sheets.han_length(*given, nozzle.speed), math.inf),
        check("break-up length by light, reported beside straight flight's [m]", own["break_up_length_m"],
              own["break_up_length_ballistic_m"], math.inf),
    ]  # fmt: skip


def perforation(run) -> list[dict]:
    """Way to the holes against where the sheet has thinned so far, by straight flight."""
    case, nozzle = run.case, sheet.nozzle_of(run.case)
    middle, width = 0.5 * (nozzle.inner_radius + nozzle.radius), nozzle.radius - nozzle.inner_radius
    law = sheets.distance_of_thickness(case.parameters["perforation"].thickness, middle, width, nozzle.swirl)
    return [check("way to the holes [m]", run.summary["holes_way_m"], sheet.slant(nozzle) * law, PLACE, True)]


class _Sheet(np.ndarray):
    """Places (N, 3) [m] about the axis, and the mean speed [m/s]."""

    speed = math.nan


def _straight(case, end: float) -> _Sheet:
    """The same sheet at `end` [s] without tension and viscosity: exact is that its particles fly straight."""
    own = dataclasses.replace(case.parameters["free_energy_tension"], coefficient=0.0)
    case = dataclasses.replace(
        case, parameters=case.parameters | {"free_energy_tension": own},
        liquid=dataclasses.replace(case.liquid, viscosity=0.0),
        method=dataclasses.replace(case.method, pressure="poisson"), run=dataclasses.replace(case.run, end_time=end),
    )  # fmt: skip
    with tempfile.TemporaryDirectory(prefix="sdph-sheet-") as folder:
        alone = Alone(case, Path(folder) / "ledger.csv")
        alone.start()
        while not alone.clock.over(alone.time):
            alone.window()
        for table in alone.tables():
            table.close()
    inside = alone.state.kind == LIQUID
    found = sheet.about_axis(sheet.nozzle_of(case), particles.positions(alone.state)[inside]).view(_Sheet)
    found.speed = float(particles.lengths(particles.velocities(alone.state)[inside]).mean())
    return found


def _places(run, time: float) -> np.ndarray:
    _, cloud, _ = run.fields(time)
    return sheet.about_axis(sheet.nozzle_of(run.case), np.asarray(cloud.points, float))


def _angle(places, length: float) -> float:
    return math.degrees(sheet.half_angle(np.asarray(places), length))


def _bent(case, length: float) -> float:
    """Half angle [deg] of the sheet's equation with tension, by the same slope."""
    nozzle, sigma = sheet.nozzle_of(case), case.parameters["free_energy_tension"].coefficient
    z = np.linspace(0.0, length, 400)
    middle, width = 0.5 * (nozzle.inner_radius + nozzle.radius), nozzle.radius - nozzle.inner_radius
    r, _ = sheets.meridian(z, middle, width, nozzle.speed, nozzle.swirl, case.liquid.density, sigma)
    return math.degrees(sheet.half_angle_of_meridian(z, r, length))


def metrics(run) -> dict:
    """Values for `sdph cost`: (value, reference, scale)."""
    own = run.summary
    return {"half angle [deg]": (own["half_angle_deg"], own["half_angle_ballistic_deg"], 45.0)}
