"""`sdph explain` of a case with solids: its numbers, what limits its step and what it will cost."""

from __future__ import annotations

import math

from sdph.effects.solids import inflation
from sdph.laws import solids as laws
from sdph.methods.solids import method, start
from sdph.study.compare import scene_module
from sdph.study.explain import edges, estimate, prices

LAYERS = 4.0  # particles across a body: a ring of four gives Lame's stress within 3 % (gel-droplet.md, section 5)
# a body H thick bends SOFT (h/H)^2 too far: beams of 4 to 20 layers, h/spacing of 1 to 2, plane and square ones, within
# 0.03 of that (validation/oscillating_plate)
SOFT = 6.0
TOO_FAR = 0.1  # share that is taken as safe; our choice


def explain(s, shared=None) -> dict[str, list]:
    """Numbers that decide, ratios, limits of the step, and what to expect: rows of a table each. `shared` are the steps
    that it has with another matter (`lockstep.Shared`), if any."""
    steps = limits(s)
    return {"numbers": numbers(s), "ratios": ratios(s), "limits": steps, "expected": expected(s, steps, shared)}


def numbers(s) -> list[tuple]:
    """(name, value, threshold, what lies above it, source)."""
    own, stress = s.solid, s.solid.density * s.sound * s.thrown
    weight = own.density * s.gravity * s.width
    rows = [
        ("Mach, v/c", s.thrown / s.sound, 0.1, "shocks: the viscosity here has no quadratic part", "Monaghan 1992"),
        ("rho c v/E", stress / own.youngs_modulus, 0.01, "impact strains the body by a hundredth", "Johnson 1972"),
        ("rho g L/E", weight / own.youngs_modulus, 1e-3, "the body sags under its weight", "by its definition"),
        ("crossings of sound, c t/L", s.sound * s.end / s.width, 1.0, "stress has time to spread", "by its definition"),
    ]
    if own.yield_stress is not None:
        rows += [
            ("rho c v/Y", stress / own.yield_stress, 1.0, "impact makes the body flow", "Johnson 1972"),
            ("Y/E", own.yield_stress / own.youngs_modulus, 0.01, "elastic strain is large", "by its definition"),
        ]
    if (rise := _rise(s)) is not None:
        rows.append(("rise of the load / ring's period", rise, 1.0, "the ring follows the load at rest", "Love 1927"))
    return rows


def _rise(s) -> float | None:
    """Time in which the pressure in a ring rises over the period with which the ring breathes; None without one."""
    body, solid = inflation.pressed(s.case), s.solid
    if body is None:
        return None
    thick = body.radius - body.inner_radius
    middle, rise = body.radius - 0.5 * thick, s.case.parameters["inflation"].rise_time
    return rise / laws.ring_period(middle, thick, solid.youngs_modulus, solid.poisson_ratio, solid.density)


def _swings(s) -> list[str]:
    """A line where a load rises too quickly for what the scene's checks take: a ring at rest."""
    rise = _rise(s)
    if rise is None or not hasattr(scene_module(s.case.scene), "exact"):
        return []
    if (swing := min(1.0, laws.ring_swing(rise, 1.0))) <= s.case.run.accuracy:
        return []
    given = s.case.parameters["inflation"].rise_time
    return [
        f"inflation.rise_time_s = {given:g} is {rise:.3g} periods of the ring's breathing: it goes on to swing by up "
        f"to {100.0 * swing:.3g} % of the load, and --against exact takes it to be at rest; let the load rise more "
        "slowly"
    ]


def ratios(s) -> list[dict]:
    """Kernel and spacing against the bodies, with the range that is safe and why."""
    h, spacing = s.case.smoothing_length, s.case.resolution.spacing
    rows = [
        ("h / spacing", h / spacing, 1.2, 2.0, "fewer neighbours make noise, more blur"),
        ("narrowest body / spacing", s.width / spacing, LAYERS, math.inf, "too few layers tell no stress across it"),
    ]
    if s.slender < math.inf:
        far, safe = SOFT * (h / s.slender) ** 2, math.sqrt(SOFT / TOO_FAR) * h / spacing
        why = f"too few layers bend too easily: about {100.0 * far:.0f} % too far, where the body bends"
        rows.append(("slender body / spacing", s.slender / spacing, safe, math.inf, why))
    return [
        {"ratio": n, "value": v, "least": low, "most": high, "safe": "yes" if low <= v <= high else "NO", "why": w}
        for n, v, low, high, w in rows
    ]


def warnings(s) -> list[str]:
    """Bodies that the guard or their weight will soon end, and ratios that are not safe."""
    told, own = [], s.solid
    if s.thrown >= s.sound:
        told.append(
            f"bodies fly at {s.thrown:.3g} m/s, and sound in them at {s.sound:.3g} m/s: a run is stopped where a "
            "particle outruns it; lower their velocity_m_s, or raise solid.youngs_modulus_Pa"
        )
    if (sag := own.density * s.gravity * s.width / own.youngs_modulus) > 1.0:
        told.append(
            f"a body's own weight is {sag:.3g} times what squeezes it to nothing (rho g L/E): it collapses; raise "
            f"solid.youngs_modulus_Pa (now {own.youngs_modulus:g})"
        )
    return told + edges.unsafe(ratios(s)) + _swings(s)


def limits(s) -> list[dict]:
    """Largest step [s] by cause at the start, before run.step_factor."""
    found = method.limits(method.SolidStepper(s.case))
    least = min(found.values())
    return [{"cause": k, "largest [s]": v, "rules": "<-" if v == least else ""} for k, v in found.items()]


def expected(s, steps: list[dict], shared=None) -> list[dict]:
    """Particles, steps, memory, wall time, as long as nothing is squeezed: a stretch below 1 shortens the step."""
    count = len(s.state.x)
    end, longest = shared[:2] if shared else (s.end, min(row["largest [s]"] for row in steps))
    number = estimate.steps(s.case, end, longest)
    wall = 1e-6 * prices.speed().solid * count * number
    return [
        {"what": "solid particles", "value": count, "unit": ""},
        {"what": "held", "value": int(s.made.held.sum()), "unit": ""},
        {"what": "steps", "value": number, "unit": ""},
        {"what": "speed of sound", "value": start.sound(s.case), "unit": "m/s"},
        {"what": "memory", "value": estimate.memory(s.case, count, 0) / 1e6, "unit": "MB"},
        {"what": "wall time", "value": wall, "unit": f"s (measured on {prices.speed().measured})"},
    ]
