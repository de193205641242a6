"""`sdph validate`: runs scenes and checks them against all their references.

A scene's validation/<scene>/compare.py has functions `exact`, `tfm`, `dpm` and `paper`, each Run -> checks, and may
name in VARIANTS what else is to be run: name -> (overrides, references to check it against).
"""

from __future__ import annotations

import re
import tempfile
from pathlib import Path

from sdph import scenes
from sdph.case import read as cases
from sdph.running import driver
from sdph.schema import CaseError
from sdph.study import compare

REFERENCES = ("exact", "paper", "tfm", "dpm")


def validate(scene: str, overrides: tuple[str, ...], reporter, folder: Path | None = None) -> list[dict]:
    """The checks of a scene and its variants, each run anew under `folder` (None: one that goes when done)."""
    module = compare.scene_module(scene)
    if module is None:
        raise CaseError(f"{scene} has no validation; scenes that have: {', '.join(validated())}")
    if folder is None:
        with tempfile.TemporaryDirectory(prefix="sdph-validate-") as temporary:
            return validate(scene, overrides, reporter, Path(temporary))
    whole = {scene: ((), [name for name in REFERENCES if hasattr(module, name)])}
    checks = []
    for name, (own, references) in getattr(module, "VARIANTS", whole).items():
        _, file = scenes.find(scene)
        case = cases.load(file, (*own, *overrides))
        own_folder = folder / re.sub(r"[^\w.-]+", "-", name)
        driver.run(case, scene, own_folder, None, reporter)
        run = compare.open_run(own_folder)
        for reference in references:
            checks += [
                check | {"name": f"{name}, {reference}: {check['name']}"} for check in getattr(module, reference)(run)
            ]
    return checks


def validated() -> list[str]:
    """Scenes that have a validation."""
    return [name for name in scenes.names() if compare.scene_module(name)]
