"""`sdph compare`: a run against a reference."""

from __future__ import annotations

import json
import shlex
from collections.abc import Callable
from pathlib import Path

from coupling.openfoam.comparators import droplet_cloud, two_fluid_numbers
from sdph.running import output
from sdph.schema import CaseError
from sdph.study import droplets, two_fluid
from sdph.study.compare import open_run, scene_module

LACKS = {"tfm": two_fluid.lacks, "dpm": droplet_cloud.lacks}


def compare(folder: Path, against: str, say: Callable[[str], None]) -> list[dict]:
    """The checks of a run against `tfm`, `dpm` or `exact`, the scene's own first; the figure goes to the run folder,
    and what it lacks is said."""
    run = open_run(folder)
    module = scene_module(run.case.scene)
    shared = _shared(run.case)
    function = getattr(module, against, shared.get(against))
    if function is None:
        known = [name for name in ("exact", "tfm", "dpm") if hasattr(module, name) or name in shared]
        raise CaseError(
            f"--against {against}: {run.case.scene or 'this case'} has no such reference; it has: "
            f"{', '.join(known) or 'none'}"
        )
    try:
        checks = function(run)
    except KeyError as error:  # regions, effects and arrays go by the names that the scene gives them
        lacks = f"{folder} cannot be compared as {run.case.scene}: it lacks {error.args[0]}"
        how = "compare a run of the scene as it is, or one whose case names no scene"
        raise CaseError(f"{lacks}; {how}") from None
    if not checks:
        raise CaseError(
            f"the run ends at {run.summary['time_s']:g} s, before the first time that its reference tells of; go on "
            f"with: sdph run --resume {shlex.quote(str(folder))} --until T"
        )
    for notice in run.notices:
        say(notice)
    output.write_json(folder / f"compare_{against}.json", {"checks": checks} | _told(run.case, against))
    return checks


def offered(case) -> list[dict]:
    """Rows of `explain`: references that a case can be compared with, and what they lack of it where it cannot."""
    module, shared, rows = scene_module(case.scene), _shared(case), []
    for name in ("exact", "tfm", "dpm"):
        if hasattr(module, name):  # of the scene as it is
            lacking = two_fluid_numbers.lacks(case) if name == "tfm" else []
        elif name in shared and (name == "tfm" or {"evaporation", "inflow"} & set(case.effects)):
            lacking = LACKS[name](case)
        else:
            continue
        rows.append({"compare --against": name, "possible": "no" if lacking else "yes", "lacks": ";  ".join(lacking)})
    return rows


def _shared(case) -> dict:
    """References that any case of its kind has: two fluids for grains, OpenFOAM's droplets for what flies in a gas."""
    if not case.grains:
        return {}
    return {"dpm": droplets.dpm} | ({} if case.vapour else {"tfm": two_fluid.tfm})


def _told(case, against: str) -> dict:
    """Words of what a reference does otherwise than the case, where it tells of it."""
    return {"unlike": droplet_cloud.unlike(case)} if against == "dpm" else {}


def unlike(folder: Path, against: str) -> list[str]:
    """The same of a comparison that was made."""
    return json.loads((folder / f"compare_{against}.json").read_text(encoding="utf-8")).get("unlike", [])
