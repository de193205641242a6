"""An effect: a row of facts about one piece of physics that a case can switch on.

An effect that is off costs nothing: kernels get `OFF` for its parameters and drop its terms when they are compiled
(`if len(p) == 0` inside the term), its arrays have length zero, its fields are not sent to the gas.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from sdph.engine.ledger import Column

OFF = ()
NO_LIMIT = float("inf")
DIFFUSIVE = 0.125  # of h^2/nu, Morris, Fox & Zhu 1997, J. Comput. Phys. 136, 214, Eq. 21


@dataclass(frozen=True)
class Judgement:
    """Need of a case for an effect, told by a number of the case.

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
    sources     quantities by which it acts on the gas (names of coupling.gas.SOURCES)
    fields      fields that it asks of the gas besides the usual ones (names of coupling.gas.ON_REQUEST)
    to_gas      (window's exchange, sdph.exchange.amounts.Handed; case) -> quantity -> what each particle gives of it,
                (N,) or (N, 3), beside what the exchange tells of the conductance, drag and force that effects add up to
    holds_force whether the gas pushes by it with a force that is held over a window
    moves       whether particles move by it
    matter      what it acts on: "grains", "liquid", "solid"
    dt_limit    (kernel parameters, case, state as it is) -> largest stable sub-step [s]; asked before every sub-step
    window_limit  the same for windows, where exchange or splitting asks for short ones; asked at the start and after
                  every window
    renew       (kernel parameters, method) puts the effect's arrays of the state right for where the particles of a
                liquid are now; called before its forces
    tells       (kernel parameters, state) -> columns of its own for history.csv of a liquid
    held        (kernel parameters, method as it is after its last sub-step) -> what its limiters hold in grains, by
                column of history.csv: shares and numbers of particles; summary.json has the largest of the run
    columns     columns of the ledger of grains that are its own, with their signs (sdph.engine.ledger.Column)
    sums        columns of that ledger whose sums summary.json tells where it is on
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
    fields: tuple[str, ...] = ()
    holds_force: bool = False
    moves: bool = False
    matter: tuple[str, ...] = ("grains",)
    dt_limit: Callable = lambda p, case, state: NO_LIMIT
    window_limit: Callable | None = None
    renew: Callable | None = None
    tells: Callable | None = None
    held: Callable | None = None
    columns: tuple[Column, ...] = ()
    sums: tuple[str, ...] = ()
    two_phases: bool = False
    to_gas: Callable | None = None
    call: Callable | None = None


def diffusive_limit(h: float, diffusivity: float) -> float:
    """Longest stable step [s] of what spreads with a diffusivity [m2/s] over kernels of h [m]."""
    return DIFFUSIVE * h**2 / diffusivity if diffusivity else NO_LIMIT


class Live:
    """A state as limits are asked of it: `most` has the largest diffusivities [m2/s], or paces [m/s], by effect, that
    are known of it already."""

    def __init__(self, state, most: dict[str, float]):
        self.state, self.most = state, most

    def __getattr__(self, name: str):
        return getattr(self.state, name)


def found(state, name: str) -> float | None:
    """Largest diffusivity [m2/s], or pace [m/s], of an effect that is known of a state already."""
    return state.most.get(name) if isinstance(state, Live) else None


def kernel_of(effect: Effect, case):
    """The effect's parameters for kernels, or OFF where the case does not call for it."""
    return effect.kernel(case) if effect.name in case.effects else OFF
