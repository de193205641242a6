"""Names that `run.forces` may hold: boundaries, sides of a box, meshes and parts; each matter has what it meets."""

from __future__ import annotations

from sdph.effects.around import tank
from sdph.engine.geometry import SIDES
from sdph.engine.walls import faces, sides
from sdph.schema import CaseError


def of_matter(case) -> dict[str, list[str]]:
    """Names that are allowed, by the matter whose forces they have: the gas's, those of grains and of a liquid."""
    found = {"gas": list(case.boundaries) if case.gas else []}
    if case.grains:
        found["grains"] = sides.names(case)
    if case.liquid and not case.incompressible:
        found["liquid"] = tank.names(case)
    return found


def check(case) -> None:
    """CaseError where `run.forces` holds a name that no matter of the case knows, or one twice."""
    known = dict.fromkeys(name for own in of_matter(case).values() for name in own)
    if case.run.forces and case.incompressible:
        raise CaseError(
            f'run.forces = {list(case.run.forces)}; with method.name = "mps" history.csv has the force on the whole '
            "tank alone (mean_force_x_N and the like): leave run.forces out"
        )
    for name in case.run.forces:
        if name not in known:
            allowed = ", ".join(known) or "no boundary, and no wall that has a name: leave it out"
            raise CaseError(f"run.forces holds {name!r}, which is no boundary or wall of the case; it has {allowed}")
    if len(set(case.run.forces)) < len(case.run.forces):
        raise CaseError(f"run.forces = {list(case.run.forces)}; name each once")


def check_parts(case) -> None:
    """CaseError where a part has a name that means something else, or is no box."""
    for name, part in case.parts.items():
        if name in {*case.boundaries, *SIDES, sides.MESH, tank.ALL}:
            raise CaseError(f"parts.{name} has the name of a boundary, a side or a mesh; rename it")
        if part.temperature and "wall_heat" not in case.effects:
            raise CaseError(f"parts.{name}.temperature_K is of the effect wall_heat; add it to effects, or leave it")
        if any(low > high for low, high in zip(part.lower, part.upper)):
            given = f"upper_m = {list(part.upper)} lies below lower_m = {list(part.lower)}"
            raise CaseError(f"parts.{name}: {given} along an axis; exchange them")


def refuse_cold(case, found: set[str]) -> None:
    """CaseError where the effect wall_heat is on, and no wall was `found` of a name that has a temperature."""
    for name in faces.temperatures(case) if "wall_heat" in case.effects else ():
        if name not in found:
            group = "parts" if name in case.parts else "boundaries"
            raise CaseError(f"{group}.{name}.temperature_K is given, and no wall of grains is there; leave it out")


def refuse_nowhere(case, found: set[str]) -> None:
    """CaseError where `run.forces` holds a name that is no boundary, and of whose walls none was `found`."""
    for name in case.run.forces:
        if name not in case.boundaries and name not in found:
            mend = f"move parts.{name}, or widen it" if name in case.parts else "leave it out"
            raise CaseError(f"run.forces holds {name!r}, and no wall is there; {mend}")


def rows(case) -> list[dict]:
    """Rows of `sdph explain`: each name, and whose forces `history.csv` and the summary have on it."""
    known = of_matter(case)
    return [
        {"forces on": name, "of": ", ".join(matter for matter, own in known.items() if name in own)}
        for name in case.run.forces
    ]
