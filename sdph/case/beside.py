"""Checks of what stands side by side in a case; each raises a CaseError: what was given, and what is allowed."""

from __future__ import annotations

from sdph.effects.liquids import time_scaling
from sdph.schema import CaseError

# effects that know no bodies in a liquid, and why
STRANGE = {
    "frame": "bodies do not move with it; baffles are part of the tank (tank.shape: outline in 2-D, mesh in 3-D)",
    "inflow": "no body lets it through; what stands in a channel is part of its tank (tank.shape: outline, mesh)",
    "outflow": "no body lets it through",
    "drain": "no body lets it through", "shear_thinning": "it knows no distance behind a body's face",
    "inflation": "the liquid takes its place",
}  # fmt: skip
# effects by which grains act on each other
PAIRS = (
    "granular_pressure", "granular_viscosity", "granular_temperature", "friction", "artificial_viscosity", "conduction",
)  # fmt: skip


def check(case) -> None:
    """Grains or solids stand beside a liquid, in a domain that is not periodic, or the case is refused."""
    if case.solid and case.grains:
        raise CaseError("a solid stands alone or beside a liquid: leave [grains] and [gas] out, or [solid]")
    _of_tables(case)
    if "time_scaling" in case.effects:
        time_scaling.check(case)
    if len(case.matters) < 2:
        return
    if case.incompressible:
        raise CaseError(
            'method.name = "mps" moves a liquid alone; beside grains or bodies it is weakly compressible: leave '
            "[method] out, and give liquid.sound_speed_m_s"
        )
    if case.domain.periodic or any(case.liquid.periodic or ()):
        which = "grains" if case.grains else "bodies"
        mend = "leave domain.periodic and liquid.periodic out"
        raise CaseError(f"{which} beside a liquid need a domain without periodic axes; {mend}")
    if case.solid:
        _of_bodies(case)


def _of_tables(case) -> None:
    """Drops of a table stand in a case without effects of pairs, or it is refused."""
    tables = [name for name, nozzle in case.nozzles.items() if nozzle.shape == "table"]
    for name in PAIRS:
        if tables and name in case.effects:
            raise CaseError(
                f"nozzles.{tables[0]}.shape = 'table' gives particles of very unequal mass, and by {name} heavy ones "
                "throw light ones away; leave it out of effects: drops of a spray are too few to meet"
            )


def _of_bodies(case) -> None:
    """A liquid with bodies in it has one phase, and no effect that knows no bodies."""
    vents = "bubble" in case.effects and case.parameters["bubble"].content == "vapour" and case.solid.failure
    if vents and "time_scaling" not in case.effects:
        raise CaseError(
            "a shell that fails lets its vapour out, and time_scaling looks for the tear: add it to effects, or leave "
            "solid.failure out"
        )
    if case.gas_phase:
        raise CaseError("bodies touch a liquid of one phase: leave [gas_phase] out, or [solid]")
    for name in case.effects:
        if name in STRANGE:
            raise CaseError(f"effects holds {name}, beside bodies in a liquid: {STRANGE[name]}; leave it out")
    if case.liquid.pressure_gradient == "corrected":
        raise CaseError(
            'liquid.pressure_gradient = "corrected" knows no bodies: set "plain" in a liquid that touches them'
        )
