"""Force of a uniform electric field on grains that bear a charge, pi d^2 sigma E on each.

The field is that of electrodes outside, the same everywhere and at all times; the charge stays on its grain, so that no
droplet may shrink or break. What the charges do to the field and to each other, to walls and to the gas is left out:
`explain` and `run` tell where their own field is more than a tenth of the one given. The force on a particle is the sum
over its grains, of all sizes.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from sdph.effects.effect import NO_LIMIT, Effect, Judgement
from sdph.engine import arrays
from sdph.engine.ledger import Column
from sdph.engine.state import by_material
from sdph.laws import electrostatics as law
from sdph.laws.break_up import sauter_diameter
from sdph.schema import CaseError, quantity, record, vector

STEP = 0.25  # of sqrt(h/a), a the acceleration: Monaghan 1992, Annu. Rev. Astron. Astrophys. 30, 543


@record
class ElectricField:
    strength: tuple = vector("V_m")  # one component for each dimension
    surface_charge: float = quantity("C_m2")  # on the surface of the grains, of either sign

    def charge_per_mass(self, grains) -> float:
        """[C/kg] of the grains of a case."""
        d32 = sauter_diameter(grains.diameter, grains.diameter_std**2)
        return law.charge_per_mass(self.surface_charge, d32, grains.density)

    def acceleration(self, grains) -> np.ndarray:
        """(d,) [m/s2] of the grains of a case."""
        return np.array(self.strength) * self.charge_per_mass(grains)

    def own_field(self, grains, alpha_p: float, width: float) -> float:
        """Field of the charges themselves at the rim of grains, [m] wide, over that given."""
        own = law.slab_field(alpha_p * grains.density * abs(self.charge_per_mass(grains)), width)
        given = math.hypot(*self.strength)
        return own / given if given else math.inf


class ElectricFieldP(NamedTuple):
    """Field [V/m], the last component 0 in two dimensions; charge on the grains [C/m2]; their density [kg/m3]."""

    x: float
    y: float
    z: float
    surface_charge: float
    grain_density: float


def kernel(case) -> ElectricFieldP:
    own = case.parameters["electric_field"]
    for name in ("evaporation", "break_up", "reaction"):
        if name in case.effects:
            raise CaseError(
                f"electric_field: what charge a droplet has that shrinks or breaks is not known here; leave {name} or "
                "electric_field out of effects"
            )
    return ElectricFieldP(*(*own.strength, 0.0)[:3], own.surface_charge, case.grains.density)


def acceleration(p, state) -> np.ndarray:
    """(N, 3) [m/s2] of the particles, held over a window; 0 where the effect is off."""
    out = arrays.zeros((len(state.x), 3), state.x)
    if p:
        out += np.array(p[:3]) * _charge_per_mass(p, state)[:, None]
    return out


def _charge_per_mass(p, state) -> np.ndarray:
    """(N,) [C/kg]."""
    return law.charge_per_mass(p.surface_charge, _d32(state), by_material(state.grain_density, p.grain_density))


def _d32(state) -> np.ndarray:
    """Sauter mean diameters (N,) [m]: the law of sizes is log-normal, as nothing evaporates."""
    return sauter_diameter(state.diameter, state.diameter_variance)


def _strongest(p, state) -> float:
    """Largest acceleration [m/s2]."""
    return math.hypot(*p[:3]) * float(np.abs(_charge_per_mass(p, state)).max(initial=0.0))


def dt_limit(p, case, state) -> float:
    """A part of the time in which the field drives grains a smoothing length."""
    strongest = _strongest(p, state)
    return STEP * math.sqrt(case.smoothing_length / strongest) if strongest else NO_LIMIT


def call(scales) -> Judgement:
    """Way that the field drives grains within the run, free of drag, over all ways: of weight, jet and throw too."""
    s, own = scales, scales.case.parameters["electric_field"]
    driven = 0.5 * math.hypot(*own.acceleration(s.grains)) * s.end
    other = 0.5 * s.gravity * s.end + max(s.jet, s.thrown)
    share = driven / (driven + other) if driven and s.patches else 0.0
    return Judgement("q E/m t/((q E/m + g) t + 2 U)", share, 0.01, "Froude number of the field", share)


EFFECT = Effect(
    name="electric_field",
    summary="force of a uniform electric field on charged grains",
    parameters=ElectricField,
    kernel=kernel,
    arrays=("diameter", "diameter_variance"),
    moves=True,
    dt_limit=dt_limit,
    columns=(Column("work_of_electric_field_J", motion=1),),
    call=call,
)
