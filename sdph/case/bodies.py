"""Checks of the bodies of a case; each raises a CaseError: what was given, and what is allowed."""

from __future__ import annotations

import math

import numpy as np

from sdph.methods.solids import start
from sdph.schema import CaseError, defaults, fields

NEEDS = {
    "box": ("lower_m", "upper_m"), "disc": ("centre_m", "radius_m"),
    "ring": ("centre_m", "radius_m", "inner_radius_m"), "cylinder": ("centre_m", "radius_m", "length_m"),
}  # fmt: skip
DIMENSIONS = {"disc": 2, "ring": 2, "cylinder": 3}
# key of [solid] -> those that act on nothing without it
IDLE = {
    "yield_stress_Pa": (
        "hardening_Pa", "hardening_exponent", "rate_factor", "temperature_share", "softening_exponent",
    ),
    "failure": ("critical_damage", "damage_begins_at"),
}  # fmt: skip
PLACES = {key for needs in NEEDS.values() for key in needs}
CONSTANTS = 5  # of failure: D1 to D5


def given(own) -> list[str]:
    """TOML keys of a section that have another value than their default."""
    plain = defaults(type(own))
    return [key for key, (name, _) in fields(type(own)).items() if getattr(own, name) != plain[key]]


def check(case) -> None:
    """Bodies have what their shapes need, lie in the domain, and are wider than the spacing; failure has its
    constants."""
    own = case.solid
    if case.domain.periodic:
        raise CaseError("domain.periodic is given; bodies know no periodic axes: leave it out")
    if own.failure and (len(own.failure) != CONSTANTS or any(isinstance(d, tuple) for d in own.failure)):
        raise CaseError(f"solid.failure = {list(own.failure)}; it must be the five numbers D1 to D5")
    if own.failure and own.yield_stress is None:
        raise CaseError("solid.failure is of plastic strain; give solid.yield_stress_Pa, or leave it out")
    _refuse_idle(own)
    for name, body in case.bodies.items():
        _check_shape(case, f"bodies.{name}", body)
        _check_flaw(f"bodies.{name}", body)
        _check_motion(f"bodies.{name}", body)


def _refuse_idle(own) -> None:
    """CaseError of a key that nothing acts on without another one."""
    there = given(own)
    for need, keys in IDLE.items():
        idle = [key for key in keys if key in there]
        if idle and need not in there:
            raise CaseError(
                f"[solid] gives {idle[0]}, which acts on nothing without {need}; give that, or leave it out"
            )


def check_probe(case, where: str, probe) -> None:
    """A probe of bodies alone lies in one of them, no further than a spacing from a particle."""
    gap = min(nearest(points, probe.at)[1] for points, _ in (start.places(case, own) for own in case.bodies.values()))
    if gap > case.resolution.spacing:
        raise CaseError(
            f"{where}.at_m = {list(probe.at)}: the nearest particle of a body is {gap:.3g} m away; give a place within "
            "a body: a probe goes along with the particle that is nearest to it at the start"
        )


def around(case, at) -> int | None:
    """Number of the body, from 0, that a place (d,) [m] lies in at the start; None of a place in no body."""
    return next((number for number, body in enumerate(case.bodies.values()) if _holds(body, np.array(at))), None)


def _holds(body, at) -> bool:
    if body.shape == "box":
        return bool((at >= body.lower).all() and (at <= body.upper).all())
    away = at - np.array(body.centre)
    along = abs(away[2]) <= 0.5 * body.length if body.shape == "cylinder" else True
    return bool(along and (body.inner_radius or 0.0) <= np.hypot(*away[:2]) <= body.radius)


def nearest(points, at) -> tuple[int, float]:
    """Number of the point (N, d) [m] that is nearest to a place (d,) [m], and how far away it is [m]."""
    away = np.linalg.norm(points - np.array(at), axis=1)
    return int(away.argmin()), float(away.min())


def _check_shape(case, where: str, body) -> None:
    for key in NEEDS[body.shape]:
        if getattr(body, key.removesuffix("_m")) is None:
            raise CaseError(f"{where}.{key} is missing; a {body.shape} needs {', '.join(NEEDS[body.shape])}")
    if others := [key for key in given(body) if key in PLACES - {*NEEDS[body.shape]}]:
        raise CaseError(
            f"{where}.{others[0]} is of no {body.shape}, which has {', '.join(NEEDS[body.shape])}: leave it out"
        )
    wanted = DIMENSIONS.get(body.shape, case.dimensions)
    if case.dimensions != wanted:
        raise CaseError(f"{where}.shape = {body.shape!r} is of {wanted} dimensions; dimensions = {case.dimensions}")
    lower, upper = extents(body)
    if body.shape == "ring" and body.inner_radius >= body.radius:
        raise CaseError(f"{where}.inner_radius_m = {body.inner_radius:g} must be below radius_m = {body.radius:g}")
    if any(b <= a for a, b in zip(lower, upper)):  # of a box: others have lengths above 0
        raise CaseError(
            f"{where}: upper_m = {list(upper)} must lie above lower_m = {list(lower)} along every axis: swap what does "
            "not, or make it wider"
        )
    wide = body.radius - body.inner_radius if body.shape == "ring" else min(b - a for a, b in zip(lower, upper))
    if wide < case.resolution.spacing * (1.0 - 1e-9):
        spacing = f"resolution.spacing_mm = {case.resolution.spacing * 1e3:g}"
        raise CaseError(f"{spacing} is larger than {where} is wide ({wide * 1e3:g} mm); give a spacing well below that")
    slack = 1e-9 * max(case.domain.size)
    if any(a < -slack or b > size + slack for a, b, size in zip(lower, upper, case.domain.size)):
        raise CaseError(
            f"{where} reaches out of the domain, domain.size_m = {list(case.domain.size)}; move it or enlarge the "
            "domain"
        )


def _check_flaw(where: str, body) -> None:
    if body.flaw and body.shape != "ring":
        raise CaseError(f'{where}.flaw is that of a body of shape "ring"; shape = {body.shape!r}: leave it out')
    if body.flaw_at and not body.flaw:
        raise CaseError(
            f"{where}.flaw_at_deg = {math.degrees(body.flaw_at):g}, and there is no flaw; give it, or leave it out"
        )


def _check_motion(where: str, body) -> None:
    if (body.held_lower is None) != (body.held_upper is None):
        raise CaseError(f"{where}: give held_lower_m and held_upper_m, or neither")
    if body.speed and body.motion == "uniform":
        raise CaseError(f'{where}.speed_m_s = {body.speed:g} is of motion = "cantilever"; give velocity_m_s')
    held = body.shape == "box" and body.held_upper is not None and body.lower[0] <= body.held_upper[0] < body.upper[0]
    if body.motion == "cantilever" and not held:
        raise CaseError(f'{where}.motion = "cantilever" is of a box that is held on its left: give held_upper_m')


def extents(body) -> tuple[tuple, tuple]:
    """Lower and upper corner [m] of the box around a body."""
    if body.shape == "box":
        return body.lower, body.upper
    across = [body.radius] * 2 + [0.5 * (body.length or 0.0)] * (len(body.centre) - 2)
    return tuple(c - a for c, a in zip(body.centre, across)), tuple(c + a for c, a in zip(body.centre, across))
