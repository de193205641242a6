"""Hostile run folders: attacks on `sdph run --resume`, on a place whose `run` is a run that has ended."""

import json
import os
import shutil
from collections.abc import Callable

from attack_places import Place

from sdph.scenes import paths

RESUMED: dict[str, Callable[[Place], None]] = {}


def resumed(edit):
    RESUMED[edit.__name__] = edit
    return edit


@resumed
def macros_of_a_run(place):
    """constant/sdphCase is made by sdph, and is not made anew."""
    gas = place.root / "run" / "gas"
    place.add("constant/sdphCase", '"lib." ("@LIB");\n', gas)
    place.add("system/controlDict", '#include "../constant/sdphCase"\n', gas)


@resumed
def linear_solver_of_a_run(place):
    gas = place.root / "run" / "gas"
    place.change("system/fvSolution", "GAMG;", 'GAMG;\n        ".*AgglomerationLibs" ("@LIB");', gas)


@resumed
def linked_case_of_a_run(place):
    gas = place.root / "run" / "gas"
    gas.rename(place.root / "outside" / "gas")
    gas.symlink_to(place.root / "outside" / "gas")
    place.add("system/controlDict", '#{li.s#} ("@LIB");\n', gas)


@resumed
def run_that_begins_again_with_its_own_permission(place):
    run = place.root / "run"
    place.add("system/controlDict", '"lib." ("@LIB");\n')
    shutil.rmtree(run / "checkpoints")
    origin = json.loads((run / "origin.json").read_text())
    (run / "origin.json").write_text(json.dumps(origin | {"gas_template": str(place.gas), "allow_code": True}))


@resumed
def run_that_begins_again_from_near_our_templates(place):
    """A path that begins as that of sdph's own templates does."""
    run, ours = place.root / "run", paths.gas_template("disc_cluster")
    place.add("system/controlDict", '"lib." ("@LIB");\n')
    shutil.rmtree(run / "checkpoints")
    origin = json.loads((run / "origin.json").read_text())
    away = os.path.join(ours, os.path.relpath(place.gas.resolve(), ours.resolve()))
    (run / "origin.json").write_text(json.dumps(origin | {"gas_template": away}))
