"""`sdph explain` of a case with a liquid: its numbers, its effects, what limits its step and what it will cost."""

from __future__ import annotations

import math

import numpy as np

from sdph import effects
from sdph.explain import estimate
from sdph.effects import kernel_of
from sdph.liquid import LIQUID, start
from sdph.liquid.step import FORCE


def explain(case) -> dict[str, list[dict]]:
    """All parts, each a list of rows of one table."""
    state = start.fill(case)
    wet = state.kind >= LIQUID
    length = min(float(np.ptp(axis[wet])) for axis in (state.x, state.y))
    speed, gravity = case.liquid.fastest, math.hypot(*case.domain.gravity)
    rows = [dict(zip(("number", "value", "threshold", "meaning", "source"), row)) for row in numbers(case, length, speed, gravity)]
    steps = limits(case, speed, gravity)
    return {"numbers": rows, "effects": effect_rows(case), "limits": steps, "expected": expected(case, len(state.x), int(wet.sum()), steps)}


def numbers(case, length: float, speed: float, gravity: float) -> list[tuple]:
    """(name, value, threshold, what lies above it, source); the speed is a tenth of the sound speed of the case."""
    own = case.liquid
    reynolds = own.density * speed * length / own.viscosity if own.viscosity else math.inf
    froude = speed / math.sqrt(gravity * length) if gravity else math.inf
    settles = length**2 * own.density / own.viscosity if own.viscosity else math.inf
    return [
        ("Reynolds", reynolds, 1.0, "inertia matters; below about 2000 the flow is laminar", "by its definition"),
        ("Froude", froude, 1.0, "inertia beats gravity", "by its definition"),
        ("run / (L/U)", case.run.end_time * speed / length, 1.0, "the flow has time to turn over", "by its definition"),
        ("run / viscous time", case.run.end_time / settles, 0.01, "viscosity matters", "L2/nu"),
        ("L / h", length / case.smoothing_length, 6.0, "narrower liquid is all rim", "Violeau & Rogers 2016"),
        ("density change, (U/c)2", (speed / own.sound_speed) ** 2, 0.01, "the liquid is compressed too much", "Monaghan 1994"),
    ]


def effect_rows(case) -> list[dict]:
    """Every effect that acts on liquids."""
    rows = [row for row in effects.REGISTRY.values() if "liquid" in row.matter]
    return [{"effect": row.name, "in the case": "on" if row.name in case.effects else "off", "what": row.summary} for row in rows]


def limits(case, speed: float, gravity: float) -> list[dict]:
    """Largest step [s] by cause."""
    h = case.smoothing_length
    found = {"sound": case.liquid.courant * h / (case.liquid.sound_speed + speed)}
    if gravity:
        found["force"] = FORCE * math.sqrt(h / gravity)
    for name in case.effects:
        row = effects.REGISTRY[name]
        found[name] = row.dt_limit(kernel_of(row, case), case, None)
    least = min(found.values())
    return [{"cause": k, "largest [s]": v, "rules": "<-" if v == least else ""} for k, v in found.items() if v < math.inf]


def expected(case, count: int, wet: int, steps: list[dict]) -> list[dict]:
    """Particles, steps, memory, wall time."""
    number = math.ceil(case.run.end_time / min(row["largest [s]"] for row in steps))
    wall = 1e-6 * estimate.speed().liquid * count * number
    return [
        {"what": "liquid particles", "value": wet, "unit": ""},
        {"what": "particles, walls included", "value": count, "unit": ""},
        {"what": "steps", "value": number, "unit": ""},
        {"what": "memory", "value": estimate.memory(case, count, 0) / 1e6, "unit": "MB"},
        {"what": "wall time", "value": wall, "unit": f"s (measured on {estimate.speed().measured})"},
    ]
