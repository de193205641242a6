"""Heat of grains from walls that have a temperature: boundaries of the gas that are walls, and parts.

A wall touches grains in points; heat goes through the gas in the wedges around them (Schluender 1971), and from there
into the bed (`sdph.laws.wall_heat`). A particle is a packet of the bed. As long as its warm layer is thinner than its
way to the wall it takes what a half-space would, by the time that it has been there; then its own temperature and the
bed between it and the wall decide. The second is exact where the layer is resolved, the first where it is not: in a
moving bed it is as thick as a grain.

With S the surface, n its normal and q = U (T_wall - T_i), the flux into the bed there is the heat of particle i of
volume V_i = m_i/rho_i by

    Q_i = 2 V_i sum_f A_f W(r_i - r_f) U_i (T_f - T_i)

over faces f of S: what pairs with an image of the bed behind a plane wall would give whose temperature goes on beyond
it at the slope q/k (the integral over its depth of -2 W' (y + z)/r is 2 W). So a linear temperature stays as it is up
to the wall. The sum of the shares 2 V_i W is 1 where grains cover a plane wall, and 0 where there are none.
Radiation is not in it, and the gas takes its own heat from its boundary.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import prange

from sdph.effects.effect import Effect, Judgement
from sdph.effects.grains import conduction
from sdph.engine.geometry import deep, nearest_image
from sdph.engine.ledger import Column
from sdph.engine.rows import entry
from sdph.engine.state import INFLOW
from sdph.engine.walls.faces import temperatures
from sdph.laws import kernels
from sdph.laws import wall_heat as law
from sdph.laws.compiled import in_turn, inlined, parallel
from sdph.schema import CaseError, quantity, record

NEEDS = ("walls", "conduction")
STEEPEST = 1.4  # of 1/h: sum of 2 A W over a plane through a particle, 4/3 to 1.4 in one to three dimensions
STABLE = 0.5  # of the time in which a wall alone would bring a particle to its temperature; 1 is where steps overshoot


@record
class WallHeat:
    # share of a wall that the grains of a packed bed shade: Schluender 1984; between 0.7 and 0.9 there
    coverage: float = quantity("", 0.8, above=0.0, most=1.0)
    roughness: float = quantity("um", 0.0, least=0.0)  # of grains and wall together: it keeps them apart
    # share of a molecule's heat that it leaves on a surface; None: that of air (sdph.laws.wall_heat)
    accommodation: float | None = quantity("", None, above=0.0, most=1.0)


class WallHeatP(NamedTuple):
    """Share of a wall in the shade of grains over alpha_p [-], conductivity of the gas [W/m/K], gap between a grain and
    a wall [m]; diameter [m], density [kg/m3] and heat capacity [J/kg/K] of grains that have none of their own."""

    shade: float
    gas_conductivity: float
    gap: float
    diameter: float
    grain_density: float
    heat_capacity: float


def kernel(case) -> WallHeatP:
    for name in NEEDS:
        if name not in case.effects:
            raise CaseError(f"effects holds wall_heat, which needs {name}; add it, or leave wall_heat out")
    if not temperatures(case):
        raise CaseError(
            "effects holds wall_heat, and no wall has a temperature; give boundaries.NAME.temperature_K of a wall, or "
            "parts.NAME.temperature_K, or leave wall_heat out"
        )
    return _kernel(case, case.parameters["wall_heat"])


def _kernel(case, own) -> WallHeatP:
    gas, grains = case.gas, case.grains
    leaves = own.accommodation or law.accommodation_of_air(gas.temperature)
    jump = law.temperature_jump(
        gas.conductivity, gas.heat_capacity, gas.molar_mass, gas.temperature, gas.operating_pressure, leaves
    )
    given = grains.diameter, grains.density, grains.heat_capacity
    return WallHeatP(own.coverage / grains.packing_limit, gas.conductivity, jump + own.roughness, *given)


@inlined
def contact(p, alpha_p, diameter):
    """Coefficient [W/m2/K] between a wall and grains; as many shade it as there are, up to `coverage` where packed."""
    return p.shade * alpha_p * law.schluender(diameter, p.gas_conductivity, p.gap)


@inlined
def own(p, s, i):
    """alpha_p [-], diameter [m] and heat capacity [J/kg/K] of particle i."""
    alpha_p = s.density[i] / (s.grain_density[i] if len(s.grain_density) else p.grain_density)
    diameter = s.diameter[i] if len(s.diameter) else p.diameter
    return alpha_p, diameter, s.grain_capacity[i] if len(s.grain_capacity) else p.heat_capacity


@inlined
def seen(kernel, box, faces, f, s, i):
    """Area [m^(d-1)] of face f that is particle i's, and the way [m] from there to the particle; none from behind."""
    dz = s.z[i] - faces.z[f] if deep(box) else 0.0
    dx, dy, dz = nearest_image(box, s.x[i] - faces.x[f], s.y[i] - faces.y[f], dz)
    way = dx * faces.normal_x[f] + dy * faces.normal_y[f] + dz * faces.normal_z[f]
    near = kernels.cubic_spline(math.sqrt(dx * dx + dy * dy + dz * dz), kernel.h, kernel.sigma)
    return 2.0 * s.mass[i] / s.density[i] * faces.area[f] * near * (way > 0.0), way


@inlined
def given(p, conduction_p, kernel, box, faces, f, s, i):
    """Heat [W] that face f gives particle i, and the area [m^(d-1)] through which it does."""
    area, way = seen(kernel, box, faces, f, s, i)
    alpha_p, diameter, capacity = own(p, s, i)
    k, touched = conduction.conducted(conduction_p, s, i), contact(p, alpha_p, diameter)
    u = law.passed(touched, k, s.density[i] * capacity, max(way, 0.0), s.wall_age[i])
    return area * u * (faces.temperature[f] - s.temperature[i]), area


@parallel
def give(p, conduction_p, kernel, box, faces, facing, s, dt, gave):
    """Add to gave (F, 2) what each face gives in dt [s]: heat [J], and the area that is covered times dt [m^(d-1) s].

    `facing` are the rows of the faces. A particle upstream of a nozzle meets no wall; what a copy gets is told where
    it is no copy.
    """
    for f in prange(len(gave)):
        heat = covered = 0.0
        for n in range(facing.number[f]):
            i = entry(facing, f, n)
            if s.kind[i] == INFLOW or (len(s.copy) > 0 and s.copy[i]):
                continue
            got, area = given(p, conduction_p, kernel, box, faces, f, s, i)
            heat += got
            covered += area
        gave[f, 0] += dt * heat
        gave[f, 1] += dt * covered


@parallel
def take(p, conduction_p, kernel, box, faces, s, dt, temperature, age):
    """Temperature (N,) [K] of the particles, and for how long they have been at a wall, age (N,) [s], after dt [s]."""
    for i in prange(len(temperature)):
        heat = met = 0.0
        for n in range(faces.number[i] * (s.kind[i] != INFLOW)):
            got, area = given(p, conduction_p, kernel, box, faces, entry(faces, i, n), s, i)
            heat += got
            met += area
        _, _, capacity = own(p, s, i)
        temperature[i] += heat * dt / (s.mass[i] * capacity)
        age[i] = age[i] + dt if met > 0.0 else 0.0


@in_turn
def exchange(p, conduction_p, kernel, box, heated, s, dt, gave):
    """Heat from walls in dt [s]: `heated` are the faces as particles see them, and the rows of these; see `give`."""
    if len(p):
        faces, facing = heated
        give(p, conduction_p, kernel, box, faces, facing, s, dt, gave)
        take(p, conduction_p, kernel, box, faces, s, dt, s.temperature, s.wall_age)


def dt_limit(p, case, state) -> float:
    """A share of the time in which walls alone would heat the particles to their temperature, one beside each axis."""
    finest = float(np.min(state.diameter, where=state.diameter > 0.0, initial=case.grains.diameter))
    stored = min(grains.density * grains.heat_capacity for grains in case.kinds)
    rate = case.dimensions * STEEPEST / case.smoothing_length * contact(p, 1.0, finest) / stored
    return STABLE / rate


def call(scales) -> Judgement:
    """Share of their way to the temperature of the walls that walls bring grains in the run: heat into a half-space
    over what the patch stores."""
    s, case = scales, scales.case
    walls = temperatures(case).values() if "walls" in case.parameters else ()
    apart = max((abs(wall - patch.temperature) for wall in walls for patch in s.patches), default=0.0)
    number = 0.0
    if apart and s.alpha_p:
        p, stored = _kernel(case, case.parameters["wall_heat"]), s.alpha_p * s.grains.density * s.grains.heat_capacity
        h, k = contact(p, s.alpha_p, s.grains.diameter), s.alpha_p * conduction.conductivity(case, s.alpha_p)
        met = s.end / stored / (1.0 / h + 0.5 * math.sqrt(math.pi * s.end / (k * stored)))
        number = met / s.length
    source = "Schluender 1984: contact and penetration in series"
    return Judgement("heat from walls / heat of the grains", number, 0.01, source, -math.expm1(-number))


EFFECT = Effect(
    name="wall_heat",
    summary="heat of grains from walls that have a temperature",
    parameters=WallHeat,
    kernel=kernel,
    arrays=("temperature", "wall_age"),
    dt_limit=dt_limit,
    columns=(Column("heat_of_walls_J", heat=1, of_grains=True),),
    sums=("heat_of_walls_J",),
    call=call,
)


def received(gave: np.ndarray) -> float:
    """Heat [J] that walls gave the grains, of gave (F, 2) as of `give`."""
    return math.fsum(gave[:, 0])
