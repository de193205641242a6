"""Messages of sdphGasFoam as they are read: its mesh, and its fields and budget after a step."""

from __future__ import annotations

import dataclasses

from coupling.gas import FIELDS, IMPULSES, ON_REQUEST, Budget, GasState, Mesh
from coupling.transport.messages import Message
from sdph.schema import CaseError

BY_PATCH = {"patches": ("patch_", 3, 3), "crossed": ("crossed_", 4)}  # of a budget: how names begin, and the shape


def mesh(told: Message) -> Mesh:
    """The mesh in a message."""
    centres = told.array("centres", None, 3)
    return Mesh(
        centres, told.array("volumes", len(centres)), int(told.number("dimensions")), float(told.number("depth"))
    )


def check(told: Message, case) -> None:
    """CaseError where the particles and the gas do not mean the same gas."""
    if told.number("dimensions") != case.dimensions:
        raise CaseError(
            f"the mesh has {told.number('dimensions')} dimensions; case.toml says dimensions = {case.dimensions}"
        )
    for name in told.values:
        section, _, key = name.partition("_")
        if section not in ("gas", "vapour", "domain"):
            continue
        ours = _ours(case, section, key)
        value = told[name] if isinstance(told[name], str) else told.number(name)
        if ours != value:
            raise CaseError(f"constant/gasProperties has {name} = {value}; case.toml has {ours}: make them the same")


def _ours(case, section: str, key: str):
    """Value of a case that the solver tells under `section`_`key`; None where the case has none."""
    own = getattr(case, section)
    if section == "domain":  # gravity_x, gravity_y, gravity_z
        return (*own.gravity, 0.0)["xyz".index(key[-1])]
    if key == "turbulence_model":
        return own.turbulence.model if own.turbulence else "laminar"
    if key.startswith("turbulence_"):
        own, key = own.turbulence, key.removeprefix("turbulence_")
    return getattr(own, key, None)


def state(message: Message, cells: int, vapour: bool, asked: tuple[str, ...] = ()) -> GasState:
    """The state in a message, of a mesh of `cells` cells, with the fields that were `asked` for."""
    totals = {f.name for f in dataclasses.fields(Budget)} - {"residuals", "held", *BY_PATCH}
    vectors = {name: tuple(message.array(f"budget_{name}", 3).tolist()) for name in ("momentum", *IMPULSES)}
    numbers = {name: float(message.number(f"budget_{name}")) for name in totals - vectors.keys()}
    named = {"residuals": _begun(message, "residual_"), "held": _begun(message, "held_")}
    for name, (begin, *shape) in BY_PATCH.items():
        own = [key for key in message.values if key.startswith(begin)]
        named[name] = {key.removeprefix(begin): message.array(key, *shape).tolist() for key in own}
    rows = {name: row for name, row in FIELDS.items() if vapour or name != "vapour_mass_fraction"}
    rows |= {name: ON_REQUEST[name] for name in asked}
    shapes = {name: (cells, 3)[: 1 + (row[1] == 3)] for name, row in rows.items()}
    fields = {name: message.array(name, *shape) for name, shape in shapes.items()}
    return GasState(float(message.number("time")), fields, Budget(**numbers, **vectors, **named))


def _begun(message: Message, begin: str) -> dict[str, float]:
    """Numbers whose names `begin` so, by the rest of their names."""
    return {name[len(begin) :]: float(message.number(name)) for name in message.values if name.startswith(begin)}
