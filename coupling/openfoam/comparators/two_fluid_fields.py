"""The start fields `0/*` of twoPhaseEulerFoam with the boundaries of case.toml, for templates that have none.

Each kind of boundary is a row: what it asks of every field. Grains meet a wall as they do in the run: a wall holds
them, a slip wall lets them slide, and `walls.specularity` is Johnson and Jackson's, by `walls.friction` that of grains
which stick.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from coupling.openfoam import fields
from coupling.openfoam.comparators import known
from coupling.openfoam.comparators.start import Start
from coupling.openfoam.start_fields import CALCULATED, EMPTY, HEAD, STILL, ZERO_GRADIENT, fixed, let_in, vector
from sdph.effects.around import wall_grip

# field -> (class, dimensions)
FIELDS = {
    "alpha.particles": ("volScalarField", "[0 0 0 0 0 0 0]"),
    "U.gas": ("volVectorField", "[0 1 -1 0 0 0 0]"),
    "U.particles": ("volVectorField", "[0 1 -1 0 0 0 0]"),
    "T.gas": ("volScalarField", "[0 0 0 1 0 0 0]"),
    "T.particles": ("volScalarField", "[0 0 0 1 0 0 0]"),
    "Theta.particles": ("volScalarField", "[0 2 -2 0 0 0 0]"),
    "alphat.particles": ("volScalarField", "[1 -1 -1 0 0 0 0]"),
    "nut.particles": ("volScalarField", "[0 2 -1 0 0 0 0]"),
    "p": ("volScalarField", "[1 -1 -2 0 0 0 0]"),
    "p_rgh": ("volScalarField", "[1 -1 -2 0 0 0 0]"),
}
SAME = {"alphat.particles": CALCULATED, "nut.particles": CALCULATED, "p": CALCULATED, "Theta.particles": ZERO_GRADIENT}
GIVEN_FLUX = "type fixedFluxPressure; value $internalField;"
STARTED = ("alpha.particles", "U.particles", "T.particles")  # of which a start tells cell by cell


def start_fields(case, others: dict[str, str] | None = None) -> dict[str, str]:
    """File name -> text, even inside; `tell_start` says how the grains stand. `others`: name -> type of the patches
    that the case does not name; with None those of the mesh that is made."""
    if others is None:
        others = {"frontAndBack": EMPTY} if case.dimensions == 2 else {}
    known.refuse(lacks(case))
    given = [region.temperature for region in case.particles.values() if region.temperature is not None]
    inside = {
        "T.gas": repr(case.gas.temperature), "T.particles": repr(given[0] if given else case.gas.temperature),
        "Theta.particles": repr(case.grains.granular_temperature), "p": repr(case.gas.operating_pressure),
        "p_rgh": repr(case.gas.operating_pressure), "U.gas": "(0 0 0)", "U.particles": "(0 0 0)",
    }  # fmt: skip
    return {name: _field(case, name, inside.get(name, "0"), others) for name in FIELDS}


def lacks(case) -> list[str]:
    """Lines on what the template that all cases share lacks of a case: it would run another one."""
    asked = {
        "effects without drag": "drag" not in case.effects,
        "gravity in domain, none in effects": any(case.domain.gravity) and "gravity" not in case.effects,
        "grains.diameter_std_mm above 0": case.grains.diameter_std > 0.0,
        "coupling.one_way = true": case.coupling.one_way,
        "coupling.voidage = false": not case.coupling.voidage,
    }
    found = [what for what, there in asked.items() if there]
    return [f"{', '.join(found)}: the two-fluid reference has drag, gravity, one size, and both ways"] if found else []


def tell_start(folder: Path, start: Start) -> None:
    """Write how the grains stand at the start into the fields of a case whose mesh is made: to each cell what the
    nearest of the start's has."""
    centres = fields.read(folder / "0/C", fields.cell_count(folder))
    own = start.at(centres[:, : start.centres.shape[1]])
    for name, values in zip(STARTED, (own.alpha_p, own.velocity, own.temperature)):
        path = folder / "0" / name
        head, _, tail = path.read_text(encoding="utf-8").partition("internalField ")
        path.write_text(f"{head}internalField {_list(values)};{tail.partition(';')[2]}", encoding="utf-8")


def _list(values: np.ndarray) -> str:
    """A field of OpenFOAM, cell by cell."""
    kind, rows = "scalar", map(repr, values.tolist())
    if values.ndim == 2:
        kind, rows = "vector", (f"({' '.join(map(repr, row))})" for row in values.tolist())
    return f"nonuniform List<{kind}> {len(values)}\n(\n" + "\n".join(rows) + "\n)"


def _field(case, name: str, inside: str, others: dict[str, str]) -> str:
    cls, dimensions = FIELDS[name]
    sides = {patch: (SAME | KINDS[own.kind](case, own))[name] for patch, own in case.boundaries.items()}
    still = (SAME | _wall(case, STILL))[name]
    sides |= {patch: f"type {EMPTY};" if kind == EMPTY else still for patch, kind in others.items()}
    patches = "".join(f"    {patch} {{ {condition} }}\n" for patch, condition in sides.items())
    head = '#include "$FOAM_CASE/constant/sdphCase"\n' + f"dimensions {dimensions};\n"
    body = f"internalField uniform {inside};\nboundaryField\n{{\n{patches}}}\n"
    return HEAD.format(cls=cls, name=name) + head + body


def _wall(case, own) -> dict[str, str]:
    return {
        "alpha.particles": ZERO_GRADIENT,
        "U.gas": fixed(vector(case, own.velocity)),
        "U.particles": _grip(case, own),
        "T.gas": ZERO_GRADIENT if own.temperature is None else fixed(own.temperature),
        "T.particles": ZERO_GRADIENT,
        "p_rgh": GIVEN_FLUX,
    }


def _grip(case, own) -> str:
    """Condition of the grains' velocity at a wall."""
    walls = case.parameters.get("walls") if "walls" in case.effects else None
    share = wall_grip.NO_SLIP if walls is None else wall_grip.specularity(walls, case.grains.restitution)[0]
    if share == wall_grip.NO_SLIP:
        return fixed(vector(case, own.velocity))
    return f"type JohnsonJacksonParticleSlip; specularityCoefficient {share!r}; value uniform (0 0 0);"


def _slip_wall(case, own) -> dict[str, str]:
    return _wall(case, own) | {"U.gas": "type slip;", "U.particles": "type slip;"}


def _velocity_inlet(case, own) -> dict[str, str]:
    """Nothing but gas comes in, at its superficial velocity."""
    return _wall(case, STILL) | {
        "alpha.particles": fixed(0),
        "U.gas": let_in(case, own),
        "T.gas": fixed(own.temperature or case.gas.temperature),
    }


def _pressure_outlet(case, own) -> dict[str, str]:
    """Grains stay inside unless the case has `outflow`."""
    back, level = own.temperature or case.gas.temperature, case.gas.operating_pressure + (own.pressure or 0.0)
    return {
        "alpha.particles": ZERO_GRADIENT,
        "U.gas": "type pressureInletOutletVelocity; phi phi.gas; value $internalField;",
        "U.particles": ZERO_GRADIENT if "outflow" in case.effects else "type noSlip;",
        "T.gas": f"type inletOutlet; phi phi.gas; inletValue uniform {back!r}; value $internalField;",
        "T.particles": ZERO_GRADIENT,
        "p_rgh": f"type prghPressure; p uniform {level!r}; value uniform {level!r};",
    }


KINDS: dict[str, Callable] = {
    "wall": _wall,
    "slip_wall": _slip_wall,
    "velocity_inlet": _velocity_inlet,
    "pressure_outlet": _pressure_outlet,
}
