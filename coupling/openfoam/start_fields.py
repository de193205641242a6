"""The start fields `0/*` of a box of gas at rest, with the boundaries of case.toml, for templates that have none.

Each kind of boundary is a row: what it asks of every field.
"""

from __future__ import annotations

from collections.abc import Callable

from coupling.openfoam import turbulence
from sdph.case import inlet_profiles
from sdph.case.sections import Boundary
from sdph.schema import CaseError

# field -> (class, dimensions)
FIELDS = {
    "alpha_g": ("volScalarField", "[0 0 0 0 0 0 0]"),
    "U": ("volVectorField", "[0 1 -1 0 0 0 0]"),
    "p_rgh": ("volScalarField", "[1 -1 -2 0 0 0 0]"),
    "T": ("volScalarField", "[0 0 0 1 0 0 0]"),
    "Y": ("volScalarField", "[0 0 0 0 0 0 0]"),
}
HEAD = "FoamFile {{ version 2.0; format ascii; class {cls}; object {name}; }}\n"
ZERO_GRADIENT = "type zeroGradient;"
CALCULATED = "type calculated; value $internalField;"
EMPTY = "empty"  # type of the sides of a plane mesh
CYCLIC = "cyclic"  # type of patches through which gas comes in again on the other side
STILL = Boundary(kind="wall")
GIVEN_FLUX = "type fixedFluxPressure; value uniform 0;"


def start_fields(case, others: dict[str, str] | None = None) -> dict[str, str]:
    """File name -> text; the mass fraction of vapour only where the case has a vapour. `others`: name -> type of the
    patches that the case does not name; with None those of the mesh that is made."""
    if others is None:
        others = {"frontAndBack": EMPTY} if case.dimensions == 2 else {}
    names = [name for name in FIELDS if name != "Y" or case.vapour is not None]
    inside = {"alpha_g": "1", "U": "(0 0 0)", "p_rgh": "0", "T": repr(case.gas.temperature)}
    inside |= {"Y": repr(case.vapour.mass_fraction)} if case.vapour else {}
    made = {name: _field(case, name, inside[name], others) for name in names}
    return made | {name: _turbulent(case, name, own, others) for name, own in turbulence.fields(case).items()}


def _field(case, name: str, inside: str, others: dict[str, str]) -> str:
    conditions = {patch: KINDS[b.kind](case, b, patch)[name] for patch, b in case.boundaries.items()}
    return _text(name, FIELDS[name], inside, conditions | _of_others(others, _wall(case, STILL, name)[name]))


def _turbulent(case, name: str, inside: str, others: dict[str, str]) -> str:
    conditions = {patch: turbulence.condition(case, b, name) for patch, b in case.boundaries.items()}
    still = turbulence.condition(case, STILL, name)
    return _text(name, ("volScalarField", turbulence.FIELDS[name][0]), inside, conditions | _of_others(others, still))


def _of_others(others: dict[str, str], still: str) -> dict[str, str]:
    return {patch: f"type {kind};" if kind in (EMPTY, CYCLIC) else still for patch, kind in others.items()}


def _text(name: str, kind: tuple[str, str], inside: str, conditions: dict[str, str]) -> str:
    cls, dimensions = kind
    patches = "".join(f"    {patch} {{ {condition} }}\n" for patch, condition in conditions.items())
    head = HEAD.format(cls=cls, name=name)
    return f"{head}dimensions {dimensions};\ninternalField uniform {inside};\nboundaryField\n{{\n{patches}}}\n"


def fixed(value) -> str:
    return f"type fixedValue; value uniform {value};"


def vector(case, velocity) -> str:
    components = [*(velocity or [0.0] * case.dimensions), 0.0][:3]
    return f"({' '.join(repr(c) for c in components)})"


def _wall(case, boundary, name: str) -> dict[str, str]:
    return {
        "alpha_g": ZERO_GRADIENT,
        "U": fixed(vector(case, boundary.velocity)),
        "p_rgh": GIVEN_FLUX,
        "T": ZERO_GRADIENT if boundary.temperature is None else fixed(boundary.temperature),
        "Y": ZERO_GRADIENT,
    }


def _slip_wall(case, boundary, name: str) -> dict[str, str]:
    return _wall(case, boundary, name) | {"U": "type slip;"}


def _velocity_inlet(case, boundary, name: str) -> dict[str, str]:
    """The velocity is the superficial one: nothing but gas goes through the faces, alpha_g = 1."""
    if boundary.strongest is None:
        raise CaseError(f"boundaries.{name}.velocity_m_s is missing; a velocity_inlet needs it, or velocities")
    return {
        "alpha_g": fixed(1),
        "U": let_in(case, boundary),
        "p_rgh": GIVEN_FLUX,
        "T": fixed(boundary.temperature or case.gas.temperature),
        "Y": fixed(case.vapour_through(boundary)),
    }


def let_in(case, boundary) -> str:
    """Velocity of the gas that comes in: the same everywhere, at all times or by a table of them, or
    `sdph.case.inlet_profiles.over_mean` times the mean, as a polynomial of the way along the side."""
    if boundary.velocities:
        rows = " ".join(f"({time!r} {vector(case, velocity)})" for time, *velocity in boundary.velocities)
        return f"type uniformFixedValue; uniformValue table ({rows});"
    if boundary.profile == "uniform":
        return fixed(vector(case, boundary.velocity))
    axis, low, high = inlet_profiles.extent(case, boundary)
    slope = [6.0 * u / (high - low) for u in boundary.velocity]
    terms = f"({vector(case, slope)} (1 1 1)) ({vector(case, [-s / (high - low) for s in slope])} (2 2 2))"
    along = vector(case, [float(a == axis) for a in range(2)])
    return f"type fixedProfile; direction {along}; origin {low!r}; profile polynomial ({terms});"


def _pressure_outlet(case, boundary, name: str) -> dict[str, str]:
    """Open side: gas that flows back has the given temperature and vapour, and comes in at right angles to the face."""
    back = {"T": boundary.temperature or case.gas.temperature, "Y": case.vapour_through(boundary)}
    return {
        "alpha_g": ZERO_GRADIENT,
        "U": "type pressureInletOutletVelocity; value uniform (0 0 0);",
        "p_rgh": fixed(boundary.pressure or 0.0),
        **{
            field: f"type inletOutlet; inletValue uniform {value}; value uniform {value};"
            for field, value in back.items()
        },
    }


KINDS: dict[str, Callable] = {
    "wall": _wall,
    "slip_wall": _slip_wall,
    "velocity_inlet": _velocity_inlet,
    "pressure_outlet": _pressure_outlet,
}
