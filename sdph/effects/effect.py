"""What an effect is: a row of facts about one piece of physics that a case can switch on.

An effect that is off costs nothing: kernels get `OFF` for its parameters and drop its terms when they are compiled
(`if len(p) == 0` inside the term), its arrays have length zero, its fields are not sent to the gas.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

OFF = ()
NO_LIMIT = float("inf")


@dataclass(frozen=True)
class Judgement:
    """Whether a case calls for an effect, told by a number of the case.

    number, name   the dimensionless number, and what it is
    threshold      from which on it matters at the usual accuracy
    source         where number and threshold come from
    error_if_off   error of the answer without the effect, as a share of what there is to compute (0 to 1, an estimate)
    """

    name: str
    number: float
    threshold: float
    source: str
    error_if_off: float


@dataclass(frozen=True)
class Effect:
    """A registry row.

    name        as in `effects = [...]` of a case, and of its section
    summary     one line for `sdph explain` and the reference
    parameters  dataclass of its section (sdph.schema)
    kernel      case -> the floats that its terms take, as a NamedTuple
    arrays      arrays of the state that it needs
    sources     what it hands to the gas (names of coupling.gas.SOURCES)
    moves       whether particles move by it
    matter      what it acts on: "grains", "liquid"
    dt_limit    (kernel parameters, case, state) -> largest stable sub-step [s]
    two_phases  whether it needs a second phase
    call        scales of a case (sdph.methods.grains.scales) -> Judgement; without it the effect is on where the user
                says so
    """

    name: str
    summary: str
    parameters: type
    kernel: Callable
    arrays: tuple[str, ...] = ()
    sources: tuple[str, ...] = ()
    moves: bool = False
    matter: tuple[str, ...] = ("grains",)
    dt_limit: Callable = lambda p, case, state: NO_LIMIT
    two_phases: bool = False
    call: Callable | None = None


def kernel_of(effect: Effect, case):
    """The effect's parameters for kernels, or OFF where the case does not call for it."""
    return effect.kernel(case) if effect.name in case.effects else OFF
