"""`sdph explain` of a case of moving particles: its numbers, what limits its step and what it will cost."""

from __future__ import annotations

import math

from sdph import effects
from sdph.methods.mps.method import COURANT
from sdph.methods.mps.method import limits as limits_of_step
from sdph.study.explain import edges, estimate, feed, prices, ruling
from sdph.study.explain.liquids import WATER

ACROSS = 3.0  # across a film: with two every particle is at a surface; swirl-sheet.md, section 2, 5
# of the tension of drops that is not there: their pressure in 1/R has 0.42 of it (validation/moving_particles)
TENSION_OFF = 0.58
TENSION_WHY = (
    "Weber = {weber:.3g}: tension moves this liquid, and moving particles have {off:.0%} too little of it in drops, "
    "which ring and rest wrongly; leave out [method] and take surface_tension, or expect that"
)
# Of a particle and step over that of a liquid in prices.SHIPPED, 1 us: 2.52 us of a sheet that has filled its domain
# (benchmarks/README.md, "Moving particles"). The 1.3 there is over a particle of liquid in three dimensions, 1.94 us.
ROWS = 2.5


def explain(s) -> dict[str, list]:
    """Numbers that decide, ratios, limits of the step, and what to expect: rows of a table each."""
    steps = limits(s)
    return {"numbers": numbers(s), "ratios": ratios(s), "limits": steps, "expected": expected(s, steps)}


def numbers(s) -> list[tuple]:
    """(name, value, threshold, what lies above it, source)."""
    weber, bond = s.capillary(_tension(s))
    reynolds = s.speed * s.length / s.viscosity if s.viscosity else math.inf
    return [
        ("Reynolds, U L/nu", reynolds, 2000.0, "the flow may become turbulent", "Reynolds 1883"),
        ("Weber, rho U2 L/sigma", weber, 1.0, "inertia beats surface tension", "by its definition"),
        ("Bond, rho g L2/sigma", bond, 1.0, "gravity beats surface tension", "by its definition"),
        ("Weber of a particle", weber / s.layers, 1.0, "tension does not stop a single one", "by its definition"),
        ("run / (L/U)", s.speed * s.end / s.length, 1.0, "the flow has time to turn over", "by its definition"),
    ]


def _tension(s) -> float:
    """Surface tension [N/m] of the case, or that of water."""
    own = s.case.parameters.get("free_energy_tension")
    return own.coefficient if own and own.coefficient else WATER


def ratios(s) -> list[dict]:
    """The narrowest extent against the spacing, with the range that is safe and why."""
    value = s.layers
    why = (
        "one layer or two are all surface, and where a film is one spacing thick it tears by the method, not by nature"
    )
    safe = "yes" if value >= ACROSS else "NO"
    return [{"ratio": "width / spacing", "value": value, "least": ACROSS, "most": math.inf, "safe": safe, "why": why}]


def warnings(s) -> list[str]:
    """Ratios that are not safe, and tension that moves more than the method gets right."""
    weber, tense = s.capillary(_tension(s))[0], []
    if "free_energy_tension" in s.case.effects and weber * s.case.run.accuracy < TENSION_OFF:
        tense = [TENSION_WHY.format(weber=weber, off=TENSION_OFF)]
    tense += ruling.warnings(s.case, s.end, limits(s))
    return tense + edges.unsafe(ratios(s))


def limits(s) -> list[dict]:
    """Largest step [s] by cause, before run.step_factor; neighbours in a turning sheet part by U l0/r, and liquid of a
    pool moves as fast as it comes to fall."""
    parameters = {name: effects.kernel_of(effects.REGISTRY[name], s.case) for name in s.case.effects}
    found = limits_of_step(s.case, parameters, s.state, relative_motion(s))
    if s.case.method.of_pools(s.case) and s.reached:
        found["motion"] = COURANT * s.case.resolution.spacing / s.reached
    least = min(found.values(), default=math.inf)
    return [{"cause": k, "largest [s]": v, "rules": "<-" if v == least else ""} for k, v in found.items()]


def relative_motion(s) -> float:
    """Speed [m/s] by which neighbours in reach part: u_t r_e/r in a turning ring, else U l0/L."""
    reach = s.case.method.reach * s.case.resolution.spacing
    found = [n.speed * abs(n.swirl) * reach / n.inner_radius for n in s.case.nozzles.values() if n.swirl]
    return max([*found, s.thrown * s.case.resolution.spacing / s.length if not found else 0.0])


def expected(s, steps: list[dict]) -> list[dict]:
    """Particles, steps, memory, wall time."""
    waiting = sum(feed.mouth(s.case, n) for n in s.case.nozzles.values())
    fed = sum(feed.mouth(s.case, n) * _way(s.case, n) for n in s.case.nozzles.values()) / s.case.resolution.spacing
    fed /= s.case.resolution.spacing ** (s.case.dimensions - 1)
    count = len(s.state.x) + fed + 4.0 * waiting / s.case.resolution.spacing ** (s.case.dimensions - 1)
    longest = min((row["largest [s]"] for row in steps), default=s.end)
    number = estimate.steps(s.case, s.end, longest)
    wall = 1e-6 * ROWS * prices.speed().liquid * count * number
    return [
        {"what": "particles at the end", "value": int(count), "unit": ""},
        {"what": "steps", "value": number, "unit": ""},
        {"what": "memory", "value": estimate.memory(s.case, count, 0) / 1e6, "unit": "MB"},
        {"what": "wall time", "value": wall, "unit": f"s (measured on {prices.speed().measured})"},
    ]


def _way(case, nozzle) -> float:
    """Way [m] along the axis of a nozzle of what it feeds: to the side of the domain that it meets, where there is
    outflow, or as far as it goes in the run."""
    ends = [
        ((high if along > 0.0 else low) - at) / along
        for at, along, low, high in zip(nozzle.centre, nozzle.direction, case.domain.corner, case.domain.upper)
        if along
    ]
    through = min(ends) * math.hypot(*nozzle.direction) if "outflow" in case.effects else math.inf
    return min(feed.way(case, nozzle), through)
