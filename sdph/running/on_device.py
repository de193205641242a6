"""`sdph run --device cuda`: which cases have their particles on a device."""

from __future__ import annotations

from sdph import effects
from sdph.engine.gpu import found
from sdph.schema import CaseError

# by matter, effects whose loops, and what is between them, run there
EFFECTS = {
    "liquid": (
        "density_diffusion", "frame", "gravity", "laminar_viscosity", "liquid_damping", "shifting", "tank", "xsph",
    ),
    "mps": ("free_energy_tension", "gravity", "inflow", "laminar_viscosity", "outflow", "tank"),
    "grains": (
        "artificial_viscosity", "conduction", "drag", "friction", "gas_pressure", "grain_drag", "granular_pressure",
        "granular_temperature", "granular_viscosity", "gravity", "heat", "walls",
    ),
}  # fmt: skip


def refuse(case, processes: int = 1) -> None:
    """CaseError where the particles of a case are not taken to the device that it asks for, or there is none."""
    if case.run.device == "cpu":
        return
    given, mend = f"run.device = {case.run.device!r}", 'give "cpu"'
    if why := _unknown(case, processes):
        raise CaseError(f"{given}: {why}; {mend}")
    if why := found.missing():
        raise CaseError(f"{given}: {why}; or {mend}")


def _unknown(case, processes: int) -> str:
    """Reason why a case is not taken there; empty where it is."""
    if processes > 1:
        return f"a device is of one process, and these are {processes}"
    known = EFFECTS.get(case.moved_by(case.matters[0]), ())
    if not known or len(case.matters) > 1:
        return "only a liquid alone, or grains in a gas, are taken to a device"
    if left := sorted(set(case.effects) - set(known)):
        return f"{left[0]} is not taken to a device; known: {', '.join(known)}"
    if other := next((name for name, own in case.nozzles.items() if own.shape != "annulus"), ""):
        return f"nozzles.{other} is no annulus: others are not taken to a device"
    if case.run.forces:
        return "run.forces is not told of a device"
    return _of_grains(case) if case.grains else ""


def _of_grains(case) -> str:
    if not effects.moving(case):
        return "grains that stay where they are are not taken to a device"
    own = case.parameters.get("walls")
    return "walls.mesh is not taken to a device" if own and own.mesh else ""
