"""Turbulence of the gas in an OpenFOAM case: constant/turbulenceProperties, and the start fields of a model with wall
functions on walls."""

from __future__ import annotations

from pathlib import Path

from sdph.case.turbulent import brought

PROPERTIES = "constant/turbulenceProperties"
KINDS = {"kEpsilon": "RAS", "kOmegaSST": "RAS", "WALE": "LES"}  # model -> simulationType
# field -> its dimensions and the function that it has on walls
FIELDS = {
    "k": ("[0 2 -2 0 0 0 0]", "kqRWallFunction"),
    "epsilon": ("[0 2 -3 0 0 0 0]", "epsilonWallFunction"),
    "omega": ("[0 0 -1 0 0 0 0]", "omegaWallFunction"),
    "nut": ("[0 2 -1 0 0 0 0]", "nutkWallFunction"),
}
WITHOUT_K = "nutUSpaldingWallFunction"  # of nut, in a model that does not solve for k
HEAD = "FoamFile { version 2.0; format ascii; class dictionary; object turbulenceProperties; }\n"
CALCULATED = "type calculated; value uniform 0;"


def write_properties(case, folder: Path) -> None:
    """`constant/turbulenceProperties` of a turbulent gas, unless the folder has one."""
    path = folder / PROPERTIES
    if not case.gas.turbulent or path.exists():
        return
    model = case.gas.turbulence.model
    kind = KINDS[model]
    length = " delta cubeRootVol; cubeRootVolCoeffs { deltaCoeff 1; }" if kind == "LES" else ""
    text = f"simulationType {kind};\n{kind} {{ {kind}Model {model}; turbulence on; printCoeffs on;{length} }}\n"
    path.write_text(HEAD + text, encoding="utf-8")


def fields(case) -> dict[str, str]:
    """Field -> its value at the start, of those that the model solves for, and nut; none of a laminar gas."""
    return {name: repr(value) for name, value in brought(case).items()} | {"nut": "0"} if case.gas.turbulent else {}


def condition(case, boundary, name: str) -> str:
    """Entry of a boundary in a field."""
    own = brought(case, boundary if boundary.kind == "velocity_inlet" else None)
    value = own.get(name, 0.0)
    if boundary.kind == "slip_wall":
        return "type zeroGradient;"
    if boundary.kind == "wall":
        function = WITHOUT_K if name == "nut" and "k" not in own else FIELDS[name][1]
        return f"type {function}; value uniform {value!r};"
    if name == "nut":
        return CALCULATED
    if boundary.kind == "velocity_inlet":
        return f"type fixedValue; value uniform {value!r};"
    return f"type inletOutlet; inletValue uniform {value!r}; value uniform {value!r};"
