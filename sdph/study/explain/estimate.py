"""Estimates of resolution, limits of steps and cost: from the case alone, good to about a factor of
two."""

from __future__ import annotations

import math

import numpy as np

from sdph import effects
from sdph.case import gas_cells
from sdph.case.judge import scales_of
from sdph.effects.around import sizes
from sdph.effects.gas import sizes as of_gas
from sdph.effects.gas.drag import filter_width
from sdph.engine import state as particles
from sdph.engine.clock import alone
from sdph.exchange.window import ANSWER, opening
from sdph.laws import kernels
from sdph.methods.grains import start, ways
from sdph.methods.grains.sound import SWING
from sdph.study.explain import edges as of_edges
from sdph.study.explain import feed, pace, prices

ROW = 8  # bytes of a number and of an entry of a neighbour row
SCRATCH = 30  # arrays of the length of the particles that a step makes
OF_LIQUIDS = ("enclosure", "pressure")  # arrays of the state that are among those
GAS_ARRAYS = 120  # arrays of the length of the cells that the gas solver and the exchange hold
OF_BURSTS = set(effects.REGISTRY["micro_explosion"].arrays).difference(  # arrays that no other effect has
    *(row.arrays for name, row in effects.REGISTRY.items() if name != "micro_explosion")
)
BASE = 180e6  # bytes of the program itself, kernels included
# of a bed's height over a cell: below it more than a tenth of its drag is missing, by the one cell at its surface that
# validation/fluidised_column measures
SHALLOW = 10.0
SHALLOW_WHY = (
    "where a bed ends the gas sees its grains thinned out: drag of about one cell of its height is missing, "
    "and a bed of few cells sinks through gas that should carry it"
)
# of an outlet that grains pour through over a spacing, from which on its rate is within 10 % of that of fine particles:
# slots of 8, 12, 16, 24 let out 0.59, 0.76, 0.80, 0.85 of Beverloo's, in the limit 0.86 (validation/granular_piles)
WIDE = 16.0
WIDE_WHY = "to particles an outlet is narrower by a spacing: one of 8 lets out two thirds of what a resolved one does"
CELLS_WHY = (
    "what grains do to the gas is spread over 2 h, so that smaller cells do not sharpen the answer, but shrink the "
    "windows and cost "
    "(h/cell)^(dimensions + 1); in larger ones a particle that crosses a face makes alpha_p jump"
)
FILTER_WHY = "the drag of clusters was fitted to filters of these widths (drag.filter)"
NO_GRAINS = (
    "the case has no grains, neither at the start nor later: gas flows alone; give [particles.NAME] or [nozzles.NAME], "
    "unless that is meant"
)
LOOSE = "coupling.window_tolerance = {given:g}: all heat that there is to exchange may be wrong; give a small share"
GRAINS = 3.0  # diameters of a grain that a cell is wide, at least
GRAINS_WHY = (
    "drag and heat laws are means over many grains; in smaller cells a grain meets gas that it has slowed or "
    "cooled itself, and both come out too small"
)
# of pushed_aside, r. What a window hands to the grains is the pressure gradient of gas that made way, in the window
# before, to where they would be without it: a_next = -r (2 a - a_before), bounded up to this r.
ADDED_MASS = 1.0 / ANSWER
ADDED_MASS_WHY = (
    "the gas that light grains push aside swings them by its pressure gradient, each window further than the one "
    "before, however short; make the grains heavier, or leave out gas_pressure"
)
OTHER = 1.5  # times the cells of a mesh, or one over them, that cell_mm may be; our choice
OWN_FIELD = 0.1  # our choice: of a force that is left out
OWN_FIELD_WHY = "charged grains drive each other apart, which is left out; charge or number of them must be less"
THICKENING = "the share of a cell's gas that comes as vapour, or of its oxidant that burns: an estimate"


def ratios(case, edges=None) -> list[dict]:
    """Cells, kernels, spacings and grains against each other, with the range that is safe and why; none for a
    liquid. `edges` as of `prices.Priced`: what is wrong where cells are too large is so in the largest of them."""
    if case.grains is None:
        return []
    h, spacing, cell = case.smoothing_length, case.resolution.spacing, case.resolution.cell
    narrow, wide, *each = edges or (cell, cell)
    own = (sizes.own_diameter(case, nozzle) for nozzle in case.nozzles.values())
    d = max([grains.sauter_diameter for grains in case.kinds] + [diameter for diameter in own if diameter])
    extent = scales_of(case).length
    rows = [
        ("cell / h", wide / h, 0.25, 4.0, CELLS_WHY),
        ("cell / grain", narrow / d, GRAINS, math.inf, _share_below(GRAINS * d, *each) + GRAINS_WHY),
        ("h / spacing", h / spacing, 1.2, 2.0, "fewer neighbours make noise, more blur"),
        ("spacing / grain", spacing / d, 1.0, math.inf, "an SPH particle stands for one grain or more"),
        ("grains' width / h", extent / h, pace.ACROSS, math.inf, "less than three kernels across is all rim"),
        ("domain / cell", min(case.domain.size) / cell, 10.0, math.inf, "coarser gas shows no flow"),
    ]
    if "electric_field" in case.effects:
        own = case.parameters["electric_field"].own_field(case.grains, scales_of(case).alpha_p, extent)
        rows.append(("own field / given field", own, 0.0, OWN_FIELD, OWN_FIELD_WHY))
    if "drag" in case.effects and case.parameters["drag"].filter != "none":
        rows.append(("filter g / v_t^2", filter_width(case), 2.0, 16.0, FILTER_WHY))
    if "gas_pressure" in case.effects and not case.coupling.one_way:
        rows.append(("gas pushed aside / packed grains", pushed_aside(case), 0.0, ADDED_MASS, ADDED_MASS_WHY))
        if height := blown_height(case):
            rows.append(("bed's height / cell", height / cell, SHALLOW, math.inf, SHALLOW_WHY))
    if mouth := ways.poured_through(case, scales_of(case).patches):
        rows.append(("outlet / spacing", mouth / spacing, WIDE, math.inf, WIDE_WHY))
    return [
        {"ratio": n, "value": v, "least": low, "most": high, "safe": "yes" if low <= v <= high else "NO", "why": w}
        for n, v, low, high, w in rows
    ]


def _share_below(width: float, shortest=()) -> str:
    """Words on the share of cells whose shortest edge [m] is below a width [m]; empty where none is known to be."""
    share = np.mean(np.less(shortest, width)) if len(shortest) else 0.0
    return f"that is the smallest cell, {100.0 * share:.2g} % of cells are below; " if share else ""


def pushed_aside(case) -> float:
    """r = alpha_p rho_g / (alpha_g rho_p) at the packing limit: inertia of the gas that moves the other way, over that
    of the grains."""
    alpha_p = case.grains.packing_limit
    return alpha_p * case.gas.density / ((1.0 - alpha_p) * min(grains.density for grains in case.kinds))


def blown_height(case) -> float:
    """Height [m] along gravity of the tallest region of grains that gas is blown into from below; 0 without any.

    Of grains given by mass it is that of as much in a box around their region.
    """
    g = np.array(case.domain.gravity)
    if "drag" not in case.effects or not any(b.lets_in and g @ b.strongest < 0.0 for b in case.boundaries.values()):
        return 0.0
    tallest = 0.0
    for region in case.particles.values():
        low, high = start.extents(case, region)
        height = float(abs(g @ (np.array(high) - low)) / np.linalg.norm(g))
        if region.mass is not None:
            density = region.volume_fraction * case.of(region.material).density
            height *= region.mass / (density * float(np.prod(high - low)))
        tallest = max(tallest, height)
    return tallest


def warnings(case, edges=None) -> list[str]:
    """No grains at all; cells far smaller than the particles, and the other ratios that are not safe; what it does to
    the answer."""
    given, warm = case.coupling.window_tolerance, "heat" in case.effects
    told = [NO_GRAINS] * (not (case.particles or case.nozzles)) + [LOOSE.format(given=given)] * (warm and given >= 1.0)
    told += _other_cells(case, edges)
    return told + of_edges.unsafe(ratios(case, edges))


def _other_cells(case, edges) -> list[str]:
    """A line where the cells of the mesh of the gas are not as large as the case says."""
    cell = case.resolution.cell
    if not edges or edges[0] / OTHER <= cell <= edges[1] * OTHER:
        return []
    narrow, wide = (f"{1e3 * edge:.3g}" for edge in edges[:2])
    sizes = narrow if narrow == wide else f"{narrow} to {wide}"
    return [
        f"resolution.cell_mm = {1e3 * cell:g}, and the cells of the mesh of the gas are {sizes} mm: windows are "
        "chosen by cell_mm; give it as the mesh is"
    ]


def limits(case, scales, crossed: float = 0.0) -> list[dict]:
    """Largest window and sub-step by cause [s]; the least of each kind rules. `crossed` as of `prices.Priced`."""
    rows = [*_windows(case, scales, crossed), *_sub_steps(case, scales)]
    least = {kind: min(value for k, _, value, _ in rows if k == kind) for kind in ("window", "sub-step")}
    return [
        {"of": kind, "cause": cause, "largest [s]": value, "rules": "<-" if value == least[kind] else "", "how": how}
        for kind, cause, value, how in rows
    ]


def _windows(case, s, crossed: float) -> list[tuple]:
    own = case.coupling
    rows = [
        ("window", "largest", own.window_largest, "coupling.window_largest_s"),
        ("window", "output", case.run.output_interval, "run.output_interval_s"),
    ]
    how = "coupling.courant cell/U of what enters or is thrown: the first window obeys it"
    rows += [("window", cause, value, how) for cause, value in opening(case).items()]
    how = "coupling.courant cell/U of what moves once the start is over: an estimate"
    rows += [("window", f"{cause}, later", value, how) for cause, value in pace.later(case, s, crossed).items()]
    how = {
        "grip": "of the time in which gas that has to flow past stops grains, beyond their own drag",
        "settling": "run.accuracy of what moves, over the error of a drift by weight or field",
    }
    asked = pace.asked(case, s, _state(case))
    rows += [
        ("window", name, limit, how.get(name, "the effect's own window_limit"))
        for name, limit in asked.items()
        if limit < math.inf
    ]
    if thick := pace.thickening(case):
        for cause, left in ((thick.cause, 1.0), (f"{thick.cause}, later", thick.steady)):
            rows.append(("window", cause, thick.limit(left), THICKENING))
    if fed := feed.of(case, s):
        how = "the change of the heat that droplets exchange while nozzles feed them, half-way: an estimate"
        rows.append(("window", "heat exchange", fed.longest(own.window_tolerance), how))
    elif "heat" in case.effects and s.span and not own.one_way:
        rate = 1.0 / s.heat_time + 1.0 / s.gas_heat_time
        first = math.sqrt(2.0 * own.window_tolerance) / rate
        rows.append(
            (
                "window",
                "heat exchange",
                first,
                "sqrt(2 tolerance)/rate: the first one, it grows with the rest to exchange",
            )
        )
    return rows


def _sub_steps(case, s) -> list[tuple]:
    c = f"c = {pace.sound(case, s):.3g} m/s where grains carry what they have to"
    how = {"sound": f"{SWING:g} over omega + 2 v/h of waves on a lattice, {c}"}
    found = pace.sub_steps(case, s, _state(case))
    rows = [("sub-step", name, limit, how.get(name, "the effect's own dt_limit")) for name, limit in found.items()]
    return rows or [("sub-step", "window", case.coupling.window_largest, "nothing else limits it")]


def _state(case):
    rows = [effects.REGISTRY[name] for name in case.effects]
    return start.fill(case, {name for row in rows for name in row.arrays})


def expected(case, s, priced: prices.Priced | None = None) -> list[dict]:
    """Particles, cells, windows, sub-steps, memory and wall time; `priced` is the gas, if it is not the embedded one's
    box."""
    own = prices.speed()
    in_space = prices.IN_SPACE if case.dimensions == 3 else 1.0
    priced = priced or prices.Priced("embedded gas", math.prod(gas_cells.cells(case)), own.window, own.cell * in_space)
    start, cells = len(_state(case).x), priced.cells
    most, mean = feed.incoming(case)
    end, count = start + most, start + mean
    windows, steps = pace.expected(case, s, _state(case), priced.crossed)
    moved = count * in_space * (own.moving if effects.moving(case) else own.resting)
    dries = (own.several if of_gas.kernel(case) else own.alike) if "evaporation" in case.effects else 0.0
    parts = {
        "particles": 1e-6 * steps * (moved + own.fed * bool(case.nozzles)),
        "exchange": 1e-6 * windows * count * dries,
        "gas": 1e-6 * windows * (priced.window + cells * priced.cell),
    }
    told = ", ".join(f"{name} {time:.2g} s" for name, time in parts.items() if time)
    there = f"{start} at the start" if end > start else "all the time"
    if (every := start + feed.brought_in(case)) > end:
        there += f"; {every} at the end if none has left, counted are those that go straight through the domain"
    how = f"one core, {priced.name}, warm; {told}; measured on {own.measured}"
    return [
        {"what": "particles", "value": end, "unit": "", "how": there},
        {"what": "gas cells", "value": cells, "unit": "", "how": ""},
        {"what": "windows", "value": windows, "unit": "", "how": "the run's clock, driven by the scales above"},
        {"what": "sub-steps", "value": steps, "unit": "", "how": "the same"},
        {"what": "memory", "value": memory(case, end, cells) / 1e6, "unit": "MB",
        "how": "state, neighbours, gas fields, program"},
        {"what": "wall time", "value": sum(parts.values()), "unit": "s", "how": how},
    ]  # fmt: skip


def steps(case, end: float, longest: float) -> int:
    """Steps to an `end` [s] of liquids or solids that bear `longest` [s], before run.step_factor."""
    return alone(case).parts(case.run.step_factor * longest, end)


def memory(case, count: int, cells: int) -> float:
    """Bytes."""
    near = kernels.SUPPORT * case.resolution.smoothing_ratio
    neighbours = math.pi * near**2 if case.dimensions == 2 else 4.0 / 3.0 * math.pi * near**3
    fields = len(particles.FIELDS) - len(OF_LIQUIDS) - (0 if "micro_explosion" in case.effects else len(OF_BURSTS))
    return BASE + ROW * (count * (fields + SCRATCH + 1.5 * neighbours) + cells * GAS_ARRAYS)
