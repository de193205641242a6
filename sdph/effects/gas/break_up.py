"""Secondary break-up of droplets by TAB (sdph.laws.break_up): in each window a drop swings as it does in the slip of
the window's start, exactly; at y = 1 it breaks, and what it breaks into swings on from rest, until the window ends.

Mass and momentum of a particle stay. The energy of the new surface, and of the speed with which the products part,
which is agitation where the case has it, comes out of the heat of the drops. Drops of several sizes in one particle
swing as that of their Sauter mean.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import prange

from sdph.effects.effect import NO_LIMIT, Effect, Judgement
from sdph.engine.ledger import Column
from sdph.engine.state import GRAIN
from sdph.laws import break_up as law
from sdph.laws.compiled import parallel
from sdph.schema import CaseError, choice, quantity, record

PRODUCTS = ("equal", "chi_squared")
# Of the time in which drag stops a drop that can break, most that a window takes: its slip is held over it; our choice
SLIP = 0.1
STOP = 8.0 / 3.0  # rho/rho_g r/u: time in which drag stops a drop whose C_D is 1
SOURCE = "O'Rourke & Amsden 1987"
# of the ledger: mass that broke, heat that new surfaces take, motion that products take from heat
COLUMNS = (
    Column("broken_kg"),
    Column("break_up_surface_J", heat=-1, of_grains=True),
    Column("break_up_agitation_J", motion=1, heat=-1, of_grains=True),
)
NOTHING_BROKEN = {column.name: 0.0 for column in COLUMNS}


@record
class BreakUp:
    liquid_viscosity: float = quantity("Pa_s", above=0.0)
    # what a drop breaks into: drops of its Sauter mean, or the distribution of the source about it
    products: str = choice(*PRODUCTS)


class BreakUpP(NamedTuple):
    """1 where products differ in size, else 0; surface tension [N/m]; liquid viscosity [Pa s]; densities of drops and,
    for the limit of windows alone, of the gas [kg/m3]; heat capacity of the drops [J/(kg K)]."""

    differ: int
    surface_tension: float
    viscosity: float
    density: float
    gas_density: float
    heat_capacity: float


def kernel(case) -> BreakUpP:
    own, grains = case.parameters["break_up"], case.grains
    if grains.surface_tension is None:
        raise CaseError("the effect break_up needs grains.surface_tension_N_m, which holds droplets together; add it")
    return BreakUpP(
        PRODUCTS.index(own.products), grains.surface_tension, own.liquid_viscosity, grains.density, case.gas.density,
        grains.heat_capacity,
    )  # fmt: skip


@parallel
def advance(p, s, slip, gas_density, dt, swing, speed, weber, diameter, variance, surface, parted):
    """All drops through a window of `dt` [s]. Of each particle: deformation, its rate, Weber number, number mean [m]
    and variance [m2] of the diameters after it; energy of the surface that the drops gained, 0 where none broke, and of
    the speed with which they parted [J]. Slip (N,) [m/s]; gas density (N,) [kg/m3]."""
    for i in prange(len(s.x)):
        swing[i], speed[i], weber[i] = s.deformation[i], s.deformation_rate[i], s.weber[i]
        diameter[i], variance[i], surface[i], parted[i] = s.diameter[i], s.diameter_variance[i], 0.0, 0.0
        if s.kind[i] != GRAIN or s.mass[i] == 0.0:  # waits in its nozzle, or has evaporated
            continue
        r = 0.5 * law.sauter_diameter(s.diameter[i], s.diameter_variance[i])
        y, rate, left = s.deformation[i], s.deformation_rate[i], dt
        number = law.weber(slip[i], r, gas_density[i], p.surface_tension)
        while True:
            b, spring = law.decay(r, p.density, p.viscosity), law.stiffness(r, p.density, p.surface_tension)
            given = law.rest(number), b, spring
            time = law.time_to_break(y, rate, *given, left)
            y, rate = law.after(y, rate, *given, min(time, left))
            if time > left:
                break
            product = law.product_radius(r, rate, p.density, p.surface_tension)
            surface[i] += 3.0 * p.surface_tension * s.mass[i] / p.density * (1.0 / product - 1.0 / r)
            parted[i] += 0.5 * s.mass[i] * law.parting_speed(r, rate) ** 2
            number *= product / r
            r, y, rate, left = product, 0.0, 0.0, left - time
        swing[i], speed[i], weber[i] = y, rate, number
        if surface[i] > 0.0:
            diameter[i], variance[i] = 2.0 * r, 0.0
            if p.differ:
                diameter[i], variance[i] = 2.0 * r * law.CHI_MEAN, 4.0 * r * r * law.CHI_VARIANCE


def apply(p, s, slip, gas_density, dt: float) -> dict[str, float]:
    """Let drops break for a window of `dt` [s]; columns of the ledger."""
    *after, surface, parted = (np.empty(len(s.x)) for _ in range(7))
    advance(p, s, slip, gas_density, dt, *after, surface, parted)
    for array, values in zip((s.deformation, s.deformation_rate, s.weber, s.diameter, s.diameter_variance), after):
        array[:] = values
    own = surface > 0.0
    parted *= float(len(s.theta) > 0)  # without agitation nobody parts
    if len(s.theta):
        s.theta[own] += 2.0 / 3.0 * parted[own] / s.mass[own]
    if len(s.temperature):
        s.temperature[own] -= (surface + parted)[own] / (p.heat_capacity * s.mass[own])
    if len(s.born_mass):
        _bear(s, own)
    return dict(zip(NOTHING_BROKEN, map(float, (s.mass[own].sum(), surface.sum(), parted.sum()))))


def _bear(s, own) -> None:
    """Products are born now: nothing of them has evaporated. `own` (N,) marks them."""
    for born, now in (("mass", s.mass), ("diameter", s.diameter), ("variance", s.diameter_variance)):
        getattr(s, f"born_{born}")[own] = now[own]
    s.lost_still[own] = s.lost_moving[own] = 0.0


def window_limit(p, case, state) -> float:
    """A part of the time in which drag stops the drops that can break."""
    able = (state.weber > law.CRITICAL_WEBER) & (state.kind == GRAIN)
    if not able.any():
        return NO_LIMIT
    r = 0.5 * law.sauter_diameter(state.diameter[able], state.diameter_variance[able])
    slip = np.sqrt(state.weber[able] * p.surface_tension / (p.gas_density * r))
    return float((SLIP * STOP * p.density / p.gas_density * r / slip).min())


def call(scales) -> Judgement:
    """Weber number of the drops that are the likeliest to break over the critical one; those that do not break are too
    large."""
    s, sigma, own = scales, scales.grains.surface_tension, scales.breaking
    number = own.slip**2 * s.gas.density * 0.5 * own.diameter / sigma / law.CRITICAL_WEBER if sigma else 0.0
    return Judgement("Weber / 6", number, 1.0, SOURCE, s.rim if number > 1.0 else 0.0)


EFFECT = Effect(
    name="break_up",
    summary="secondary break-up of droplets (TAB)",
    parameters=BreakUp,
    kernel=kernel,
    arrays=("diameter", "diameter_variance", "deformation", "deformation_rate", "weber"),
    window_limit=window_limit,
    columns=COLUMNS,
    sums=tuple(NOTHING_BROKEN),
    call=call,
)
