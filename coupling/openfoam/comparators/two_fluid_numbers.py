"""Numbers that twoPhaseEulerFoam wants in another form than a case has them, written as `constant/sdphTwoFluid`.

OpenFOAM's dictionaries could calculate them only by compiling code at run time.
"""

from __future__ import annotations

import math

import numpy as np

from coupling.openfoam.comparators import known
from coupling.openfoam.poly_mesh import PolyMesh
from sdph.case.sections import Case
from sdph.laws import constants, exact
from sdph.laws import heat as heat_law

OUTSIDE = 1.0  # m; how far selections reach past the domain, so that round-off at its faces decides nothing
COURANT = 0.75  # largest of inlets and of grains at the start in the two-fluid run; stable with 3 outer iterations
STEPS_PER_RELAXATION = 15  # second-order steps: 0.03 % of the rise at 1 ms (validation/disc_cluster)

# heat.law -> OpenFOAM's model, and the slip velocity in gunn's Reynolds number (RanzMarshall does not read it)
HEAT_MODELS = {
    "gunn": ("gunn", "superficial"),
    "gunn_interstitial": ("gunn", "interstitial"),
    "ranz_marshall": ("RanzMarshall", "interstitial"),
}


DRAG_MODELS = {  # drag.law -> OpenFOAM's model
    "gidaspow": "blendedGidaspow", "gidaspow_switch": "GidaspowErgunWenYu", "ergun": "Ergun", "wen_yu": "WenYu",
}  # fmt: skip
KNOWN = frozenset((  # effects that two fluids have too, or that are of particles as a method
    "drag", "gas_pressure", "gravity", "granular_pressure", "friction", "granular_viscosity", "granular_temperature",
    "walls", "heat", "conduction", "outflow", "artificial_viscosity", "grain_shifting",
))  # fmt: skip
NO_DRAG = "none"  # of a scene whose template has no drag


def macros(case: Case, courant: float = COURANT, mesh: PolyMesh | None = None) -> dict[str, str]:
    """Macros of the two-fluid templates: name -> text; `mesh` is one of the case's own."""
    gas, grains = case.gas, case.grains
    known.refuse(lacks(case))
    return {
        "gas_prandtl": repr(heat_law.prandtl_number(gas.viscosity, gas.heat_capacity, gas.conductivity)),
        "gas_enthalpy": repr(gas.heat_capacity * gas.temperature),
        "grains_kappa_by_cp": repr(grains.conductivity / grains.heat_capacity),
        "one_way": _switch(case.coupling.one_way),
        "drag_model": DRAG_MODELS[case.parameters["drag"].law] if "drag" in case.effects else NO_DRAG,
        **_heat_exchange(case),
        **_friction(case),
        **_regions(case),
        **_time_steps(case, courant, finest(case, mesh)),
        "non_orthogonal": "corrected" if mesh else "uncorrected",
    }


def _switch(on: bool) -> str:
    return "yes" if on else "no"


def lacks(case: Case) -> list[str]:
    """Lines on what the two fluids of OpenFOAM lack of a case."""
    found, gas = [], case.gas
    if gas.equation_of_state != "constant":
        found.append(f"gas.equation_of_state = {gas.equation_of_state!r}; the two-fluid reference has 'constant'")
    if "drag" in case.effects and (law := case.parameters["drag"].law) not in DRAG_MODELS:
        found.append(f"drag.law = {law!r}; the two-fluid reference has: {', '.join(DRAG_MODELS)}")
    if gas.turbulent:
        found.append(f"gas.turbulence.model = {gas.turbulence.model!r}; the two-fluid reference is laminar")
    if case.coupling.film:
        found.append("coupling.film = true; the two-fluid reference takes the gas as it is: leave it out to compare")
    heat = case.parameters["heat"] if "heat" in case.effects else None
    if heat and heat.law == "ranz_marshall" and heat.closure == "paper":
        found.append(
            "heat.law = 'ranz_marshall' with heat.closure = 'paper'; OpenFOAM's has no alpha_g: give 'geometric'"
        )
    return [*found, *known.lacks(case, KNOWN, "the two-fluid reference")]


def _heat_exchange(case: Case) -> dict[str, str]:
    if "heat" not in case.effects:
        return {"heat_transfer": "((particles in gas) { type RanzMarshall; })"}  # asked for; it moves no grains
    heat = case.parameters["heat"]
    model, reynolds = HEAT_MODELS[heat.law]
    own = {"heat_model": model, "heat_reynolds": reynolds, "heat_alpha_gas": _switch(heat.closure == "paper")}
    words = f"type {model}; reynolds {reynolds}; alphaGas {own['heat_alpha_gas']};"  # the last two of gunn alone
    return own | {"heat_transfer": f"((particles in gas) {{ {words} }})"}


def _friction(case: Case) -> dict[str, str]:
    margin = {"packing_margin": repr(constants.PACKING_MARGIN)}
    if "friction" not in case.effects:
        packed = repr(case.grains.packing_limit)
        return margin | {"friction_angle_degrees": "0", "friction_begins": packed, "friction_strength": "0"}
    own = case.parameters["friction"]
    begins = {"friction_begins": repr(own.onset), "friction_strength": repr(own.fr)}
    return margin | begins | {"friction_angle_degrees": repr(math.degrees(own.angle))}


def _regions(case: Case) -> dict[str, str]:
    """Two points for each region (and the middle) that reach past the two sides without cells of a 2-D mesh."""
    points = {}
    for name, region in case.particles.items():
        lower, upper = (region.lower, region.upper) if region.shape == "box" else (region.centre, region.centre)
        if lower is None:  # templates select boxes and round ones alone
            continue
        middle = [0.5 * (a + b) for a, b in zip(lower, upper)]
        points[f"particles_{name}_front"] = _point(lower, -OUTSIDE)
        points[f"particles_{name}_middle"] = _point(middle, 0.5)
        points[f"particles_{name}_back"] = _point(upper, 1.0 + OUTSIDE)
    return points


def _point(place, z: float) -> str:
    x = [*place, z][:3]
    return f"({x[0]!r} {x[1]!r} {x[2]!r})"


def _time_steps(case: Case, courant: float, cell: float) -> dict[str, str]:
    """`first_time_step` and `time_steps`, a table of steps against time, for a case that rests; else `time_step`: of
    the fastest that comes in or is there at the start, or of what falls through the domain."""
    given = [*(one.strongest for one in case.boundaries.values()), *(one.velocity for one in case.particles.values())]
    speeds = [speed for velocity in given if velocity and (speed := math.hypot(*velocity))]
    if fall := sum(abs(g) * size for g, size in zip(case.domain.gravity, case.domain.size)):
        speeds.append(math.sqrt(2.0 * fall))
    if speeds:
        return {"time_step": repr(divided(case.run.output_interval, courant * cell / max(speeds)))}
    table = resting_steps(case) if "heat" in case.effects else [(0.0, case.run.output_interval / 10.0)]
    return {
        "first_time_step": repr(table[0][1]),
        "time_steps": "(" + " ".join(f"({t!r} {dt!r})" for t, dt in table) + ")",
    }


def finest(case: Case, mesh: PolyMesh | None) -> float:
    """Width [m] of the smallest cell, or of all in a box."""
    if mesh is None:
        return case.resolution.cell
    depth = np.ptp(mesh.points[:, 2]) if case.dimensions == 2 else 1.0
    return float((mesh.volumes.min() / depth) ** (1.0 / case.dimensions))


def divided(interval: float, step: float) -> float:
    """The largest step of at most `step` that divides `interval`."""
    return interval / math.ceil(interval / step * (1.0 - 1e-9))


def resting_steps(case: Case) -> list[tuple[float, float]]:
    """(time, step) [s]: fine for ten relaxation times of the gas, five times that for ten more, then a tenth of the
    outputs."""
    last = case.run.output_interval / 10.0
    if case.coupling.one_way:
        return [(0.0, last), (case.run.end_time, last)]
    relaxation = gas_relaxation(case)
    fine = round_step(relaxation / STEPS_PER_RELAXATION)
    middle = 5.0 * fine
    first_end = middle * math.ceil(10.0 * relaxation / middle)
    second_end = last * math.ceil(20.0 * relaxation / last)
    half = 0.5 * fine  # a step is looked up at its start: change between two starts
    steps = [(0.0, fine), (first_end - half, fine), (first_end - 0.9 * half, middle)]
    return [
        *steps,
        (second_end - half, middle),
        (second_end - 0.9 * half, last),
        (case.run.end_time + second_end, last),
    ]


def gas_relaxation(case: Case) -> float:
    """Time [s] in which the gas at rest takes on the temperature of the grains, in the densest region."""
    gas, grains, heat = case.gas, case.grains, case.parameters["heat"]
    alpha_p = max(region.volume_fraction for region in case.particles.values())
    prandtl = heat_law.prandtl_number(gas.viscosity, gas.heat_capacity, gas.conductivity)
    nusselt = heat_law.LAWS[heat.law](1.0 - alpha_p, 0.0, prandtl)
    eps = alpha_p * heat_law.CLOSURES[heat.closure](1.0 - alpha_p, nusselt, gas.conductivity, grains.diameter)
    of_grains = alpha_p * grains.density * grains.heat_capacity
    of_gas = (1.0 - alpha_p) * gas.density * gas.heat_capacity
    return 1.0 / exact.exchange_rate(eps, of_grains, of_gas)


def round_step(step: float) -> float:
    """The largest of 1, 2, 5 times a power of ten that is at most `step`."""
    power = math.floor(math.log10(step))
    return float(f"{max(m for m in (1, 2, 5) if m * 10.0**power <= step * (1 + 1e-12))}e{power}")
