"""Time scaling of a slow growth: in each second of the motion S seconds pass for all that goes by time.

    tau = t/S: heat, rates of strain and boiling go S times as fast, stresses stay (gel-droplet.md, section 2)

S = min(S_max, v_cap S/|dr/dtau|): the wall of the shell moves no faster than v_cap in the motion's own time, so that
inertia and the viscosity of the gel, which are not scaled, stay small beside the pressure; 1 from the first cut on. Nor
does any gel pass a tenth of its speed of sound, within which a weakly compressible liquid is one (Monaghan 1994):
what a closing bubble throws moves fast though the wall does not.
When S changes velocities change with it, v S_new/S_old: the motion in real time goes on as it was.

The specification has mu/S: a gel of 0.1 Pa s is then one of 1e-4, and nothing holds the face of the bubble round while
noise in the pressure, which goes by the motion's time, moves it. Our choice: mu as it is. Its pressure is told.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from sdph.effects.effect import Effect, Judgement
from sdph.schema import CaseError, quantity, record

MACH = 0.1  # largest speed of a weakly compressible liquid over its sound's: 1 % of compression (Monaghan 1994)


@record
class TimeScaling:
    """Time scaling up to a wall speed, and how a run ends after a tear."""

    wall_speed_cap: float = quantity("m_s", 0.2, above=0.0)
    largest: float = quantity("", 1000.0, least=1.0)
    averaging: float = quantity("us", 2.0, above=0.0)  # of the motion: the wall's speed is a mean; longer lags behind
    after_tear: float = quantity("ms", 0.2, above=0.0)  # the run ends so long after the first cut


class TimeScalingP(NamedTuple):
    """v_cap [m/s], S_max, averaging time [s], time after a tear [s]."""

    cap: float
    largest: float
    averaging: float
    after_tear: float


def kernel(case) -> TimeScalingP:
    own = case.parameters["time_scaling"]
    return TimeScalingP(own.wall_speed_cap, own.largest, own.averaging, own.after_tear)


def check(case) -> None:
    """CaseError where what goes by time is not all scaled."""
    if case.solid is None or case.liquid is None or "bubble" not in case.effects:
        raise CaseError(
            "effects holds time_scaling, which is of a bubble in a liquid in a shell: give all, or leave it out"
        )
    if [body.shape for body in case.bodies.values()] != ["ring"]:
        raise CaseError('effects holds time_scaling, which needs one body of shape "ring", the shell: give that alone')
    if "liquid_heat" not in case.effects:
        raise CaseError("effects holds time_scaling, but nothing heats the droplet; give liquid_heat, or leave it out")
    bubble = case.parameters["bubble"]
    if bubble.content != "vapour" or bubble.flux:
        given = f'bubble.content = "{bubble.content}", flux_W_m2 = {bubble.flux:g}'
        raise CaseError(f'{given}; time_scaling scales a bubble of "vapour" that liquid_heat feeds, without a flux')
    for name in ("surface_tension", "gravity", "shifting", "xsph"):
        if name in case.effects:
            raise CaseError(f"effects holds {name} and time_scaling, and {name} is not scaled: leave one out")


def pace(p: TimeScalingP, speed: float, mach: float, before: float) -> float:
    """S of a wall speed [m/s] and of the fastest gel's over its sound's [-], in the motion's own time under the S
    `before`; 1 at least."""
    wanted = [most * before / own for most, own in ((p.cap, abs(speed)), (MACH, mach)) if own]
    return max(1.0, min([p.largest, *wanted]))


def pressure(density: float, inner: float, outer: float, speed: float, rate: float) -> float:
    """Pressure [Pa] that inertia takes of a cylinder of radii [m] whose inner face moves at `speed` [m/s] and gains
    speed at a rate [1/s]: rho ln(R/r) (r dv/dt + v^2) less v^2/2 (1 - r^2/R^2)."""
    moved = math.log(outer / inner) * (inner * rate * speed + speed * speed)
    return density * (moved - 0.5 * speed * speed * (1.0 - (inner / outer) ** 2))


def viscous_pressure(viscosity: float, inner: float, outer: float, speed: float) -> float:
    """Pressure [Pa] that a viscosity [Pa s] takes of a cylinder of radii [m] whose inner face moves at `speed` [m/s]:
    2 mu v r (1/r^2 - 1/R^2), from sigma_rr = -p - 2 mu v r/x^2."""
    return 2.0 * viscosity * speed * inner * (inner**-2 - outer**-2)


def call(scales) -> Judgement:
    """Without it a growth is right up to the tear, but takes all its steps: nothing errs."""
    return Judgement(
        "error without time scaling",
        0.0,
        1.0,
        "by definition: it saves steps, and changes no answer before the tear",
        0.0,
    )


EFFECT = Effect(
    name="time_scaling",
    summary="a slow growth of a droplet in fewer steps",
    parameters=TimeScaling,
    kernel=kernel,
    matter=("liquid", "solid"),
    call=call,
)
