"""Keys of [coupling] that the gas solver of a case does not read."""

from __future__ import annotations

from coupling.choice import expected
from sdph.case.sections import Coupling
from sdph.schema import fields

OF = {"openfoam": ("gas_ranks", "transport"), "embedded": ("gas_tolerance",)}  # solver -> keys that it alone reads


def warnings(case) -> list[str]:
    """A line for each key that was given for the other solver."""
    if "grains" not in case.matters:
        return []
    chosen, usual = expected(case.only("grains")), Coupling()
    (other,) = OF.keys() - {chosen}
    return [
        f"coupling.{key} = {getattr(case.coupling, at)} is of the {other} gas, and the gas is {chosen}: it does nothing"
        for key, (at, _) in fields(Coupling).items()
        if at in OF[other] and getattr(case.coupling, at) != getattr(usual, at)
    ]
