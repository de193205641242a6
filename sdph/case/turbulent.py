"""Turbulence of the gas: which keys of [gas.turbulence] a model takes, and what flows in with the gas."""

from __future__ import annotations

from sdph.laws import turbulence as law
from sdph.schema import CaseError

SECTION = "gas.turbulence"
# model -> what it solves for beside k, and its key
RATES = {"kEpsilon": ("epsilon", "epsilon_m2_s3"), "kOmegaSST": ("omega", "omega_1_s")}
OF_RATES = {"epsilon": law.dissipation, "omega": law.frequency}
GIVEN = {"k": "k_m2_s2", "epsilon": "epsilon_m2_s3", "omega": "omega_1_s", "mixing_length": "mixing_length_m"}


def check(case) -> None:
    """The turbulence has what its model needs, and nothing that this does not know."""
    own = case.gas.turbulence if case.gas else None
    if own is None:
        return
    rate, key = RATES.get(own.model, (None, None))
    for name in GIVEN:
        known = rate is not None and name in ("k", rate, "mixing_length")
        if getattr(own, name) is not None and not known:
            given = f"{SECTION}.{GIVEN[name]} is given"
            raise CaseError(f'{given}, but model = "{own.model}" does not take it; leave it out')
    if rate is None:
        return
    if (getattr(own, rate) is None) == (own.mixing_length is None):
        raise CaseError(f'{SECTION}: model = "{own.model}" needs mixing_length_m or {key}; give one of them')
    if own.k is None and not fastest_inlet(case):
        raise CaseError(
            f"{SECTION}.k_m2_s2 is missing; without a velocity_inlet that flows, intensity tells of none: give it"
        )


def fastest_inlet(case) -> float:
    """Speed [m/s] of the fastest velocity_inlet; 0 without one."""
    return max((speed(b) for b in case.boundaries.values() if b.kind == "velocity_inlet"), default=0.0)


def speed(boundary) -> float:
    """Largest size [m/s] of the velocity of a boundary."""
    return sum(component**2 for component in boundary.strongest or ()) ** 0.5


def brought(case, inlet=None) -> dict[str, float]:
    """k [m2/s2] and epsilon [m2/s3] or omega [1/s] of the gas that an inlet brings; without one (or with one at rest)
    as of the fastest, which the gas has at the start too. Nothing of a model that solves for neither."""
    own = case.gas.turbulence
    if own.model not in RATES:
        return {}
    rate, _ = RATES[own.model]
    flowing = (speed(inlet) if inlet else 0.0) or fastest_inlet(case)
    k = law.kinetic_energy(flowing, own.intensity) if own.k is None else own.k
    given = getattr(own, rate)
    return {"k": k, rate: OF_RATES[rate](k, own.mixing_length) if given is None else given}
