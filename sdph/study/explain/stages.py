"""Effects that act as a gel droplet grows, necks and has torn, and by which number: gel-droplet.md, section 2.

The numbers are those of the droplet without particles at the end of each stage. Growth is up to the largest pressure,
the most that the shell bears; necking from there to the tear. What a run does is said as it is, and where it is not
what the specification's table has, so.
"""

from __future__ import annotations

import math

import numpy as np

from sdph.effects.liquids import time_scaling
from sdph.study.gel_droplet import foretold

SOFTER, CAPILLARY = 0.03, 0.01  # T*^m, sigma/(R p) from which they matter: gel-droplet.md, section 2


def rows(case) -> list[dict]:
    """Rows of the table of a case with time scaling, its largest bubble alone; one row that says why where the reduced
    model has no such droplet."""
    course = foretold.of(case)
    if isinstance(course, str):
        return [{"effect": "none", "why": course}]
    if course.tear is None:
        return [{"effect": "none", "why": "the droplet without particles does not tear"}]
    top = int(np.argmax(course.history["pressure_Pa"][: course.tear + 1]))
    at = [{name: float(values[row]) for name, values in course.history.items()} for row in (top, course.tear)]
    return [_row(*parts) for parts in (*_of_growth(case, course, at), *_of_motion(case, course, at, top))]


def _row(name: str, acts: tuple, number: str, values, matters: float, why: str) -> dict:
    stages = dict(zip(("growth", "necking", "after the tear"), acts))
    ends = dict(zip(("at the largest pressure", "at the tear"), values))
    return {"effect": name} | stages | {"judged by": number} | ends | {"matters from": matters, "why": why}


def _of_growth(case, course, at: list[dict]) -> list[tuple]:
    """Heat and shell: name, what acts in each stage, number, its values, threshold, why."""
    heat, shell, own = case.parameters["liquid_heat"], case.bodies["shell"], case.solid
    diffusivity = heat.conductivity / (case.liquid.density * heat.heat_capacity)
    limit = 2.0 / math.sqrt(3.0) * own.yield_stress * math.log(shell.radius / shell.inner_radius)
    softer = own.temperature_share**own.softening_exponent if own.temperature_share else 0.0
    soft = "on" if softer else "off"
    begins = f"solid.damage_begins_at = {own.damage_begins_at:g}: damage and cuts act from there on"
    boils = "heat comes by conduction and boils; how much of it is the bubble's"
    return [
        ("conduction, evaporation", ("on",) * 3, "Fourier number, 4 k t/(rho cp D0^2)",
         [diffusivity * row["time_s"] / shell.radius**2 for row in at], math.nan, "the rim's heat gets inwards"),
        ("conduction, evaporation", ("on",) * 3, "heat to the bubble/heat in",
         [row["bubble_J"] / row["heat_in_J"] for row in at], math.nan, boils),
        ("plasticity, rate", ("on",) * 3, "p/((2/sqrt3) A ln(ro/ri))", [row["pressure_Pa"] / limit for row in at], 1.0,
         "beyond it the whole shell flows; hardening and rate bear the rest"),
        ("damage, cutting", ("on",) * 3, "plastic strain", [row["strain"] for row in at], own.damage_begins_at,
         f"{begins} (the specification: off in growth)" if not own.damage_begins_at else begins),
        ("thermal softening", (soft,) * 3, "T*^m", [softer] * 2, SOFTER, "held as solid.temperature_share has it"),
    ]  # fmt: skip


def _of_motion(case, course, at: list[dict], top: int) -> list[tuple]:
    """Surface, vapour and pace, as `_of_growth`."""
    sigma, p = case.parameters["bubble"].surface_tension, time_scaling.kernel(case)
    shares = [2.0 * sigma / (row["bubble_diameter_m"] * row["pressure_Pa"]) for row in at]
    h, radius = course.history, case.bodies["shell"].radius
    walls = [
        radius * (h["diameter_ratio"][row] - h["diameter_ratio"][row - 1]) / (h["time_s"][row] - h["time_s"][row - 1])
        for row in (max(top, 1), course.tear)
    ]
    tense = "on, in the bubble's pressure" if sigma else "off"
    return [
        ("surface tension", (tense, tense, "off"), "sigma/(R p)", shares, CAPILLARY,
         "after the tear none is built (the specification: on)"),
        ("vapour as particles", ("off",) * 3, "none", [math.nan] * 2, math.nan, "not built: a tear vents 0-D bubbles"),
        ("time scaling", ("on", "on, capped", "off"), "S = min(largest, v_cap/(wall's speed))",
         [min(p.largest, max(1.0, p.cap / abs(wall))) if wall else p.largest for wall in walls], 1.0,
         "1 from the first cut on; what inertia takes of the pressure the run tells: inertial_pressure_largest_rel"),
    ]  # fmt: skip
