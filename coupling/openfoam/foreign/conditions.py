"""Boundary conditions of an OpenFOAM case as [boundaries] of case.toml."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import NamedTuple

from coupling.openfoam.dictionary import number, of_patch, table, uneven, vector, word
from coupling.openfoam.foreign import properties
from coupling.openfoam.foreign.files import Files
from coupling.openfoam.poly_mesh import PolyMesh

PLANE = "empty"
SLIP = ("slip", "partialSlip", "symmetry", "symmetryPlane", "basicSymmetry")
STICK = ("noSlip", "movingWallVelocity")
SYMMETRIES = ("symmetry", "symmetryPlane")  # types of patches that OpenFOAM lets stand for no other condition
FREE = (
    "pressureInletOutletVelocity", "inletOutlet", "zeroGradient", "pressureInletVelocity", "outletInlet",
    "pressureNormalInletOutletVelocity", "fluxCorrectedVelocity", "pressureDirectedInletVelocity", "freestream",
)  # fmt: skip
HELD = (
    "fixedValue", "totalPressure", "prghPressure", "prghTotalPressure", "uniformFixedValue", "uniformTotalPressure",
    "fixedMean", "waveTransmissive", "entrainmentPressure", "prghEntrainmentPressure", "outletInlet",
    "fixedMeanOutletInlet",
)  # fmt: skip
ASIDE = 1e-9  # of a velocity: nothing
ALONG = 1e-3  # of a velocity, that may be across a wall which it moves along: what digits and facets leave; our choice
PLANE_ENOUGH = 0.9  # length of the mean normal of a patch that is no wall, so that along it means something; our choice
# velocity of a wall -> what is told
STILL = (
    "its wall moves in the OpenFOAM case (U is {}), and stands still here, for gas and grains: leave it if that does "
    "not matter; to have it move the gas alone, bring your 0/U in gas/0; else this is no case for sdph"
)
AS_AT_THE_START = {  # kind -> what is told where T has no entry for a patch
    "velocity_inlet": "T is not given there: gas comes in as warm as that of the start; choose temperature_K",
    "pressure_outlet": "T is not given there: gas that comes back is as warm as that of the start",
    "wall": "T is not given there: no heat goes through it",
}


class Condition(NamedTuple):
    """Entries of [boundaries.NAME], and the line that tells of them what the user must know; empty where nothing."""

    entries: dict
    note: str = ""


def conditions(files: Files, mesh: PolyMesh, dimensions: int, alpha_p: float) -> dict[str, Condition]:
    """Condition of each patch but the sides of a plane mesh; `alpha_p` is that of the bed."""
    fields = {"U": files.field("U"), "p": files.field("p_rgh") or files.field("p"), "T": files.field("T")}
    if files.grains:
        fields["alpha"] = files.first(f"{files.start}/alpha.{files.grains}")
    found = {}
    for name, patch in mesh.patches.items():
        if patch.kind == PLANE or patch.faces.start == patch.faces.stop:
            continue
        own = {key: of_patch(field.get("boundaryField", {}), name) for key, field in fields.items()}
        found[name] = _with_temperature(_condition(files, mesh, name, own, alpha_p, dimensions), own, bool(fields["T"]))
    return _relative(found)


def _condition(files: Files, mesh: PolyMesh, name: str, own: dict, alpha_p: float, dimensions: int) -> Condition:
    kind, patch = word(own["U"].get("type")), mesh.patches[name].kind
    if patch in SYMMETRIES or kind in SLIP:
        note = "partialSlip is taken as slip" if kind == "partialSlip" else ""
        return Condition({"kind": "slip_wall"}, note)
    if kind in STICK:
        return Condition({"kind": "wall"}, STILL.format(kind) if kind == "movingWallVelocity" else "")
    if kind in FREE and word(own["p"].get("type")) in HELD:
        value, note = _read("p", next(filter(None, map(own["p"].get, ("p0", "p", "value", "uniformValue"))), None))
        pressure = None if value is None else value * properties.level(files)["factor"]
        return Condition({"kind": "pressure_outlet", "pressure_Pa": pressure}, note)
    area, normal = mesh.outwards(name)
    if kind == "uniformFixedValue" and (rows := table(own["U"].get("uniformValue"))) is not None:
        return _in_time(rows, normal, own, alpha_p, dimensions) or _unknown(patch, kind, word(own["p"].get("type")))
    speed = _given(files, own["U"], area, normal)
    if speed is None:
        return _unknown(patch, kind, word(own["p"].get("type")))
    share, note = _open_share(kind, own.get("alpha"), alpha_p)
    velocity = [share * component for component in speed]
    if max(map(abs, velocity)) <= ASIDE:
        return Condition({"kind": "wall"})
    through, size = sum(v * n for v, n in zip(velocity, normal)), math.hypot(*velocity)
    if abs(through) <= ALONG * size and (patch == "wall" or math.hypot(*normal) > PLANE_ENOUGH):
        told = f"{kind} ({' '.join(f'{component:g}' for component in speed)}) along it"
        return Condition({"kind": "wall"}, STILL.format(told))
    if through > 0.0:
        what = "gas leaves here at a given speed, which is not known: taken as pressure_outlet"
        return Condition({"kind": "pressure_outlet", "pressure_Pa": None}, what)
    return Condition({"kind": "velocity_inlet", "velocity_m_s": _rounded(velocity)[:dimensions]}, note)


def _rounded(velocity: list[float]) -> list[float]:
    return [float(f"{component + 0.0:.9g}") if abs(component) > ASIDE else 0.0 for component in velocity]


def _in_time(rows, normal, own: dict, alpha_p: float, dimensions: int) -> Condition | None:
    """Inlet of a table of times [s] and velocities [m/s]; None where it is more than that: fewer than two rows, times
    below 0 or that do not rise, an end that is not held, gas that never comes in or leaves at times."""
    share, note = _open_share("uniformFixedValue", own.get("alpha"), alpha_p)
    times, inwards = [time for time, _ in rows], [-sum(v * n for v, n in zip(speed, normal)) for _, speed in rows]
    rising = all(now > before for before, now in pairwise(times))
    held = own["U"].get("outOfBounds", ["clamp"]) == ["clamp"]
    if len(rows) < 2 or times[0] < 0.0 or not (rising and held) or min(inwards) < -ASIDE or max(inwards) <= ASIDE:
        return None
    told = [[time, *_rounded([share * part for part in speed])[:dimensions]] for time, speed in rows]
    return Condition({"kind": "velocity_inlet", "velocities": told}, note)


def _given(files: Files, own: dict, area: float, normal) -> list[float] | None:
    """Velocity (3,) [m/s] that an entry of U gives; None where it is not known."""
    kind = word(own.get("type"))
    if kind in ("fixedValue", "uniformFixedValue", "interstitialInletVelocity", "surfaceNormalFixedValue"):
        for key in ("uniformValue",) if kind == "uniformFixedValue" else ("inletVelocity", "uniformValue", "value"):
            if key in own and (found := vector(own[key])):
                return found
        along = number(own.get("refValue"))
        return None if along is None else [along * component for component in normal]
    if kind == "flowRateInletVelocity" and area > 0.0:
        rate = number(own.get("volumetricFlowRate"))
        if rate is None and (mass := number(own.get("massFlowRate"))) is not None:
            rate = mass / (number(own.get("rhoInlet")) or properties.gas(files, [])["density_kg_m3"])
        return None if rate is None else [-rate / area * component for component in normal]
    return None


def _open_share(kind: str, alpha: dict | None, alpha_p: float) -> tuple[float, str]:
    """Superficial velocity over that of U, as that of a gas between grains is the larger; what is told of it."""
    if not alpha or kind == "interstitialInletVelocity":
        return 1.0, ""
    fixed = number(alpha.get("value")) if word(alpha.get("type")) == "fixedValue" else None
    if fixed is not None:
        return 1.0 - fixed, ""
    return 1.0 - alpha_p, f"superficial: U of the gas times 1 - {alpha_p:g}, the grains of the bed"


def _unknown(patch: str, kind: str, pressure: str) -> Condition:
    """A choice to make: a wall where the mesh says so, an outlet where the pressure is held, else closed."""
    entries = (
        {"kind": "pressure_outlet", "pressure_Pa": None} if pressure in HELD and patch != "wall" else {"kind": "wall"}
    )
    what = f"U is {kind or 'not given'}, p {pressure or 'not given'}"
    return Condition(entries, f"{what}, which is not known: taken as {entries['kind']}; choose wall, slip_wall, "
                     "velocity_inlet (with velocity_m_s) or pressure_outlet")  # fmt: skip


def _read(name: str, entry) -> tuple[float | None, str]:
    """The value of a field at a patch, and what is told of it."""
    value = number(entry)
    told = "is uneven there: its mean is taken" if uneven(entry) else ""
    told = "is not known there: choose it" if value is None else told
    return value, told and f"{name} {told}"


def _with_temperature(found: Condition, own: dict, told: bool) -> Condition:
    """The condition with the temperature that T gives there; `told`: there is a T."""
    kind = word(own["T"].get("type"))
    if told and not kind and found.entries["kind"] in AS_AT_THE_START:
        return found._replace(note="; ".join(filter(None, (found.note, AS_AT_THE_START[found.entries["kind"]]))))
    if kind not in ("fixedValue", "inletOutlet") or found.entries["kind"] == "slip_wall":
        return found
    value, note = _read("T", own["T"].get("value" if kind == "fixedValue" else "inletValue"))
    entries = {"temperature_K": value} if value else {}
    return found._replace(entries=found.entries | entries, note="; ".join(filter(None, (found.note, note))))


def _relative(found: dict[str, Condition]) -> dict[str, Condition]:
    """Pressures over the least of all outlets: the gas is told differences; the least where one is not known."""
    given = {name: own.entries["pressure_Pa"] for name, own in found.items() if "pressure_Pa" in own.entries}
    least = min((value for value in given.values() if value is not None), default=0.0)
    over = {name: 0.0 if value is None else value - least for name, value in given.items()}
    return {
        name: own._replace(entries=own.entries | {"pressure_Pa": over[name]}) if name in over else own
        for name, own in found.items()
    }
