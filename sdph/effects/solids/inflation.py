"""Inflation of a ring: a pressure inside that rises to a value and stays, or a liquid that fills the cavity so that the
ring grows steadily.

The liquid has a bulk modulus: p = K (A_wanted/A - 1), A_wanted = A_0 + pi/4 (D^2 - D_0^2), as if the ring kept its
volume; dD/dt rises to g D_0. Beyond its largest pressure a ring can be driven so, and not by a pressure that is given;
the run ends where such a ring tears (sdph.methods.solids.bounds).
"""

from __future__ import annotations

import math
from typing import NamedTuple

from sdph.effects.effect import NO_LIMIT, Effect
from sdph.schema import CaseError, choice, quantity, record, words


@record
class Inflation:
    """Inflation by a pressure, or by growth of the outer diameter; either rises smoothly, as 3 s^2 - 2 s^3 of
    s = t/rise_time."""

    body: str = words("")
    by: str = choice("pressure", "growth")
    pressure: float = quantity("Pa", 0.0)
    growth: float = quantity("1_s", 0.0, least=0.0)
    bulk_modulus: float = quantity("Pa", 0.0, least=0.0)  # of the liquid that makes it grow
    rise_time: float = quantity("s", 0.0, least=0.0)


class InflationP(NamedTuple):
    """Pressure [Pa], time in which it rises [s], growth [1/s], bulk modulus [Pa], outer diameter at the start [m]."""

    pressure: float
    rise_time: float
    growth: float
    bulk_modulus: float
    diameter: float


def kernel(case) -> InflationP:
    own = case.parameters["inflation"]
    body = case.bodies.get(own.body)
    if body is None or body.shape != "ring":
        rings = [name for name, other in case.bodies.items() if other.shape == "ring"]
        raise CaseError(f"inflation.body = {own.body!r}; it must be a ring: {', '.join(rings) or 'there is none'}")
    if case.solid.failure and own.by == "pressure":
        raise CaseError(
            "inflation by a pressure goes on pressing on what is left of a ring that has torn: leave solid.failure "
            'out, drive the ring (inflation.by = "growth"), or fill it with a liquid that has a bubble of vapour '
            "(effects bubble and time_scaling)"
        )
    if own.by == "pressure":
        if own.growth or own.bulk_modulus:
            raise CaseError('inflation.growth_1_s and bulk_modulus_Pa are of inflation.by = "growth"; give that, too')
        if not own.pressure:
            raise CaseError('inflation.pressure_Pa = 0 loads nothing; give one, or by = "growth"')
        return InflationP(own.pressure, own.rise_time, 0.0, 0.0, 2.0 * body.radius)
    if not own.growth * own.bulk_modulus:
        raise CaseError('inflation.by = "growth" needs growth_1_s and bulk_modulus_Pa above 0')
    return InflationP(0.0, own.rise_time, own.growth, own.bulk_modulus, 2.0 * body.radius)


def pressed(case):
    """The ring that a pressure that is given loads; None without any, and where `kernel` refuses the body."""
    own = case.parameters.get("inflation")
    if "inflation" not in case.effects or own.by != "pressure":
        return None
    body = case.bodies.get(own.body)
    return body if body is not None and body.shape == "ring" else None


def pressure(p: InflationP, time: float, area: float, first: float) -> float:
    """Pressure [Pa] inside at `time` [s], with a cavity of `area` [m2], at the start `first` [m2]."""
    share = time / p.rise_time if time < p.rise_time else 1.0
    if p.growth:
        lasting = time - 0.5 * p.rise_time if share == 1.0 else p.rise_time * share**3 * (1.0 - 0.5 * share)
        grown = (1.0 + p.growth * lasting) ** 2 - 1.0
        return p.bulk_modulus * ((first + 0.25 * math.pi * p.diameter**2 * grown) / area - 1.0)
    return p.pressure * share * share * (3.0 - 2.0 * share)


def steady(p: InflationP, case, state) -> float:
    """Longest step [s]: a tenth of the period with which liquid and ring swing, w^2 = 2 K/(rho R t)."""
    body = case.bodies[case.parameters["inflation"].body]
    if not p.growth:
        return NO_LIMIT
    heavy = case.solid.density * body.radius * (body.radius - body.inner_radius)
    return 0.2 * math.pi * math.sqrt(heavy / (2.0 * p.bulk_modulus))


EFFECT = Effect(
    name="inflation",
    summary="pressure or liquid inside a ring",
    parameters=Inflation,
    kernel=kernel,
    matter=("solid",),
    dt_limit=steady,
)
