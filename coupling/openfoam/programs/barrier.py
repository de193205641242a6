"""The second barrier against code in OpenFOAM cases, in the programs: they run no command and load no library.

OpenFOAM takes its switches from the control dictionaries of its installation, the site and the user, which it merges.
Their text with ours behind it goes to the programs by FOAM_CONTROLDICT, which OpenFOAM takes instead of these files; a
case cannot change that switch any more. Libraries are beyond it: codeGuard, loaded before the program, stops them.
"""

from __future__ import annotations

import os
import re
from pathlib import Path

from coupling.openfoam.programs import install
from coupling.openfoam.programs.installation import Installation

SWITCHES = "InfoSwitches { allowSystemOperations 0; }"
VARIABLES = {"controlDict": "FOAM_CONTROLDICT", "configDict": "FOAM_CONFIGDICT"}  # the latter of openfoam.org after 12
SPARED = re.compile(r'("(?:[^"\\]|\\.)*")|//[^\n]*|/\*.*?\*/|\s+', re.DOTALL)  # blanks: a variable has little room


def environment(libraries: bool = False) -> dict[str, str]:
    """Environment of OpenFOAM's programs in which a case runs no code; `libraries` lets cases of our own load some."""
    installation = install.require()
    variables = installation.environment()
    for name, variable in VARIABLES.items():
        files = (path for path in _dictionaries(installation, name) if path.is_file())
        if texts := [path.read_text("utf-8", "surrogateescape") for path in files]:
            variables[variable] = _short("\n".join([variables.get(variable) or "\n".join(texts), SWITCHES]))
    for name in variables.keys() & {"PATH", "LD_LIBRARY_PATH"}:
        variables[name] = _without_here(variables[name])
    return variables if libraries else _guarded(variables)


def _guarded(variables: dict[str, str]) -> dict[str, str]:
    guard = install.code_guard()
    first = {"LD_PRELOAD": guard.name, "LD_LIBRARY_PATH": str(guard.parent)}
    return variables | {name: os.pathsep.join(filter(None, [first[name], variables.get(name)])) for name in first}


def _dictionaries(installation: Installation, name: str) -> list[Path]:
    """Places where OpenFOAM looks for a dictionary of its own (etcFiles.C), the strongest last."""
    site = Path(os.environ.get("WM_PROJECT_SITE") or installation.project / "site") / "etc"
    user = Path.home() / ".OpenFOAM"
    folders = (installation.project / "etc", site, site / installation.version, user, user / installation.version)
    return [folder / name for folder in folders]


def _short(text: str) -> str:
    """A dictionary without comments."""
    return SPARED.sub(lambda found: found.group(1) or " ", text)


def _without_here(places: str) -> str:
    """Search paths less those that depend on the folder: programs run in the folder of the case."""
    return os.pathsep.join(place for place in places.split(os.pathsep) if os.path.isabs(place))
