"""The start fields `0/*` of reactingParcelFoam with the boundaries of case.toml.

Each kind of boundary is a row: what it asks of every field. The vapour goes under the name of the liquid whose code it
borrows.
"""

from __future__ import annotations

from collections.abc import Callable

from coupling.openfoam.start_fields import (
    CALCULATED,
    EMPTY,
    GIVEN_FLUX,
    HEAD,
    STILL,
    ZERO_GRADIENT,
    fixed,
    let_in,
    vector,
)

VAPOUR = "C10H22"
CARRIER = "air"
FIELDS = {  # field -> (class, dimensions)
    "U": ("volVectorField", "[0 1 -1 0 0 0 0]"),
    "T": ("volScalarField", "[0 0 0 1 0 0 0]"),
    "p": ("volScalarField", "[1 -1 -2 0 0 0 0]"),
    "p_rgh": ("volScalarField", "[1 -1 -2 0 0 0 0]"),
    CARRIER: ("volScalarField", "[0 0 0 0 0 0 0]"),
    VAPOUR: ("volScalarField", "[0 0 0 0 0 0 0]"),
}


def start_fields(case, others: dict[str, str] | None = None) -> dict[str, str]:
    """File name -> text. `others`: name -> type of the patches that the case does not name; with None those of the mesh
    that is made."""
    if others is None:
        others = {"frontAndBack": EMPTY} if case.dimensions == 2 else {}
    level, share = repr(case.gas.operating_pressure), case.vapour.mass_fraction if case.vapour else 0.0
    inside = {"U": "(0 0 0)", "T": repr(case.gas.temperature), "p": level, "p_rgh": level}
    inside |= {CARRIER: repr(1.0 - share), VAPOUR: repr(share)}
    return {name: _field(case, name, inside[name], others) for name in FIELDS}


def _field(case, name: str, inside: str, others: dict[str, str]) -> str:
    cls, dimensions = FIELDS[name]
    sides = {patch: KINDS[own.kind](case, own)[name] for patch, own in case.boundaries.items()}
    sides |= {patch: f"type {EMPTY};" if kind == EMPTY else _wall(case, STILL)[name] for patch, kind in others.items()}
    patches = "".join(f"    {patch} {{ {condition} }}\n" for patch, condition in sides.items())
    body = f"dimensions {dimensions};\ninternalField uniform {inside};\nboundaryField\n{{\n{patches}}}\n"
    return HEAD.format(cls=cls, name=name) + body


def _wall(case, own) -> dict[str, str]:
    return {
        "U": fixed(vector(case, own.velocity)),
        "T": ZERO_GRADIENT if own.temperature is None else fixed(own.temperature),
        "p": CALCULATED,
        "p_rgh": GIVEN_FLUX.replace("uniform 0", "$internalField"),
        CARRIER: ZERO_GRADIENT,
        VAPOUR: ZERO_GRADIENT,
    }


def _slip_wall(case, own) -> dict[str, str]:
    return _wall(case, own) | {"U": "type slip;"}


def _velocity_inlet(case, own) -> dict[str, str]:
    share = case.vapour_through(own)
    return _wall(case, own) | {
        "U": let_in(case, own),
        "T": fixed(own.temperature or case.gas.temperature),
        CARRIER: fixed(1.0 - share),
        VAPOUR: fixed(share),
    }


def _pressure_outlet(case, own) -> dict[str, str]:
    share, level = case.vapour_through(own), case.gas.operating_pressure + (own.pressure or 0.0)
    return {
        "U": "type pressureInletOutletVelocity; value $internalField;",
        "T": _back(own.temperature or case.gas.temperature),
        "p": CALCULATED,
        "p_rgh": fixed(level),
        CARRIER: _back(1.0 - share),
        VAPOUR: _back(share),
    }


def _back(value: float) -> str:
    """Condition of an open side whose gas, where it flows in, has `value`."""
    return f"type inletOutlet; inletValue uniform {value!r}; value uniform {value!r};"


KINDS: dict[str, Callable] = {
    "wall": _wall,
    "slip_wall": _slip_wall,
    "velocity_inlet": _velocity_inlet,
    "pressure_outlet": _pressure_outlet,
}
