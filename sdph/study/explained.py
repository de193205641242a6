"""Table of what `sdph explain` and Python's `explain` tells of a case, as a run would have it."""

from __future__ import annotations

from pathlib import Path

from sdph.case import fluids, forces, hot_walls, paced, usual
from sdph.effects.solids import rigid_sides
from sdph.study import against, closed_vessels, gas_keys, inlets, rehearsal
from sdph.study.explain import gel, lockstep, materials, recorded, tables, vessel


def explained(case, template: Path, *, allow_code: bool = False) -> dict[str, list[dict]]:
    """All parts of `tables.explain`; `CaseError` where `sdph run` would end with one. Arguments as of
    `rehearsal.rehearsed`."""
    with rehearsal.rehearsed(case, template, allow_code=allow_code, whole=True) as (seen, mesh, grains):
        parts = tables.explain(seen, rehearsal.priced(seen, mesh))
        told = grains.notices if grains else []
        last = next(name for name in parts if name.startswith("warnings"))  # grains come first
        parts[last] += [{"warning": text} for text in (*_of_case(case, mesh), *told)]
        parts["filled"] = materials.filled(seen, grains.filled) if grains else []
        parts["tank"] = vessel.rows(seen)
        parts["droplet"] = gel.rows(seen)
        parts["runs before it"] = recorded.rows(seen, parts.get("expected", []))
        parts["forces"], parts["fluids"] = forces.rows(seen), fluids.rows(seen)
        parts["comparisons"] = against.offered(seen)
    return parts


def warned(case, template: Path, *, allow_code: bool = False, whole: bool = False) -> list[str]:
    """The warnings alone; what cannot run is refused, without `whole` but for its particles."""
    with rehearsal.rehearsed(case, template, allow_code=allow_code, whole=whole) as (seen, mesh, _):
        return [*tables.warnings(seen, priced=rehearsal.priced(seen, mesh)), *_of_case(case, mesh)]


def _of_case(case, mesh) -> list[str]:
    """Warnings of a case with all its matters."""
    of_gas = [*gas_keys.warnings(case), *gas_keys.unseen(case, mesh), *inlets.warnings(case, mesh)]
    of_gas += closed_vessels.warnings(case, mesh)
    of_grains = *paced.warnings(case), *hot_walls.warnings(case)
    told = usual.warnings(case) + rigid_sides.warnings(case) + gel.warnings(case) + lockstep.warnings(case)
    return [*of_gas, *of_grains, *told]
