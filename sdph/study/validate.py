"""`sdph validate`: runs scenes and checks them against all their references.

A scene's validation/<scene>/compare.py has functions `exact`, `tfm`, `dpm` and `paper`, each Run -> checks, and may
name in VARIANTS what else is to be run: name -> (overrides, references to check it against). What others have measured
and no scene stands for is under `experiments`, the kinetic theory of grains under `kinetic_theory`, grains
that heap up and flow out under `granular_piles`, a plug of spray under `spray_plug`, a gel droplet without particles
under `gel_droplet_reduced`, free bodies of moving particles under `moving_particles`, pools by them and by the weakly
compressible method under `two_methods`, vessels of any mesh under `own_vessel`, turbulence of the gas under
`gas_turbulence`, a beam and a cavity of the gel droplet's ladder under `gel_ladder`: each is a folder of
validation/ with a module for each part of it, which STUDY.PART runs alone; those named in LONG are run so only.
"""

from __future__ import annotations

import importlib.util
import math
import re
import sys
import tempfile
from collections import Counter
from pathlib import Path

from sdph import scenes
from sdph.case import read as cases
from sdph.running import balances, driver, limiters
from sdph.scenes import paths
from sdph.schema import CaseError, unknown
from sdph.study import compare, record

REFERENCES = ("exact", "paper", "tfm", "dpm")
EXPERIMENTS = "experiments"
# name -> how overrides begin that it takes: what has no gas, or is one case, takes none
STUDIES = {
    EXPERIMENTS: ("coupling.",), "kinetic_theory": (), "granular_piles": (), "spray_plug": (),
    "gel_droplet_reduced": (), "moving_particles": (), "two_methods": (), "own_vessel": (),
    "gas_turbulence": (), "gel_ladder": (),
}  # fmt: skip


def validate(scene: str, overrides: tuple[str, ...], reporter, folder: Path | None = None, acted=None) -> list[dict]:
    """The checks of a scene and its variants, each run anew under `folder` (None: one that goes when done); a dict
    `acted` takes the limiters that acted in each run, by its name."""
    module, (study, _, name) = compare.scene_module(scene), scene.partition(".")
    if module is None and study not in STUDIES:
        found = unknown(scene, validated()).replace(f"unknown key {scene}", f"{scene} has no validation", 1)
        raise CaseError(found.replace("known here", "those that have", 1))
    if folder is None:
        with tempfile.TemporaryDirectory(prefix="sdph-validate-") as temporary:
            return validate(scene, overrides, reporter, Path(temporary), acted)
    if study in STUDIES:
        return _parts(study, name, overrides, reporter, folder)
    whole = {scene: ((), [name for name in REFERENCES if hasattr(module, name)])}
    checks = []
    for name, (own, references) in getattr(module, "VARIANTS", whole).items():
        _, file = scenes.find(scene)
        case = cases.load(file, (*own, *overrides))
        own_folder = folder / re.sub(r"[^\w.-]+", "-", name)
        driver.run(case, scene, own_folder, None, reporter)
        run = compare.open_run(own_folder)
        if acted is not None:
            acted[name] = limiters.acted(run.summary)
        checks += [check | {"name": f"{name}, balances: {check['name']}"} for check in balances.checks(run.summary)]
        for reference in references:
            found = some(getattr(module, reference)(run), "gives a check")
            checks += [check | {"name": f"{name}, {reference}: {check['name']}"} for check in found]
        for notice in run.notices:
            reporter.status(notice)
    return checks


def some(checks: list[dict], name: str) -> list[dict]:
    """The checks; where there are none, a failed one of that name: what tells nothing holds nothing."""
    return checks or [compare.check(name, 0.0, 1.0, 0.0)]


def vanished(scene: str, checks: list[dict], folder: Path | None) -> list[dict]:
    """Failed checks, their values nan, for the names in the record of a scene that `checks` has not; the record in
    `folder`, or else the one that came along. Of a study only those of the parts that it runs: STUDY.PART that part,
    STUDY all but those in LONG."""
    study, _, name = scene.partition(".")
    kept = record.kept(folder, study)
    left, gone = Counter(check["name"] for check in checks), []
    for check in kept["checks"] if kept else ():
        part = check.get("part")
        if part != name if name else part in long(study):
            continue
        left[check["name"]] -= 1
        if left[check["name"]] < 0:
            gone.append(check | _numbers(check) | {"value": math.nan, "ok": False})
    return gone


def _numbers(check: dict) -> dict:
    """Reference and tolerance of a recorded check; JSON knows no nan."""
    return {key: math.nan if check[key] is None else check[key] for key in ("reference", "tolerance")}


def _parts(study: str, name: str, overrides: tuple[str, ...], reporter, folder: Path) -> list[dict]:
    """The checks of a part of a study, or without its name of all, each with its `part`; their runs and figures go to
    `folder`."""
    for text in overrides:
        if not text.startswith(STUDIES[study]):
            raise CaseError(f"--set {text}: {study} is run as it is; leave it out")
    names, known = part(study).NAMES, parts(study)
    if name and name not in known:
        raise CaseError(f"{study}.{name}: {study} has no such part; it has: {', '.join(known)}")
    folder.mkdir(parents=True, exist_ok=True)
    own = [part(study, name) for name in ([name] if name else names)]
    return [
        check | {"part": _name(module)}
        for module in own
        for check in some(module.checks(folder, overrides, reporter), f"{_name(module)}: gives a check")
    ]


def parts(study: str) -> tuple[str, ...]:
    """Names of the parts of a study, in the order in which they run; those in LONG at the end."""
    return (*part(study).NAMES, *long(study))


def long(study: str) -> tuple[str, ...]:
    """Names of the parts that run by name alone; none of what is no study."""
    return getattr(part(study), "LONG", ()) if study in STUDIES else ()


def _name(module) -> str:
    """Name of a part of a study."""
    return module.__name__.rpartition(".")[2]


def part(study: str, name: str = ""):
    """A module of validation/<study>; without a name the package."""
    package = f"sdph_validation_{study}"
    if package not in sys.modules:
        place = paths.data("validation") / study
        spec = importlib.util.spec_from_file_location(
            package, place / "__init__.py", submodule_search_locations=[str(place)]
        )
        sys.modules[package] = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(sys.modules[package])
    return importlib.import_module(f"{package}.{name}" if name else package)


def validated() -> list[str]:
    """Scenes that have a validation, and the studies."""
    return [*(name for name in scenes.names() if compare.scene_module(name)), *STUDIES]
