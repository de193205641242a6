"""A case folder made from another's OpenFOAM case: its mesh, patches, boundary conditions and properties."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path

from coupling.openfoam import dictionary, foreign
from coupling.openfoam.foreign.conditions import SYMMETRIES
from coupling.openfoam.poly_mesh import FOLDER
from sdph import effects
from sdph.case.hot_walls import FELT
from sdph.engine.walls.faces import KINDS
from sdph.running import output
from sdph.scenes import paths

MESH = ("points", "faces", "owner", "neighbour")
BED = (
    "drag", "gas_pressure", "gravity", "granular_pressure", "friction", "granular_viscosity", "granular_temperature",
    "artificial_viscosity", "walls",
)  # fmt: skip
FINER = 2.0  # gas cells over spacings of particles, as in the scenes of beds
ONSET = 0.97  # of the packing limit, at most: where contacts begin to last; 0.60 where the limit is 0.63, our choice


def adopt(source: Path, folder: Path) -> list[str]:
    """Make `folder`/case.toml and `folder`/gas of the OpenFOAM case `source`; what could not be taken over, a line
    each."""
    found = foreign.look(source)
    found.notes.extend(_of_hot_walls(found))
    output.create(folder, ())
    output.copy_template(paths.gas_template(""), folder / "gas")
    _limit(folder / "gas" / "system" / "fvSchemes")
    _copy_mesh(source, folder / "gas")
    output.write_text(folder / output.MARK, text(found, source))
    told = [f"boundaries.{name}: {own.note}" for name, own in found.boundaries.items() if own.note]
    return [*found.notes, *told]


def _of_hot_walls(found) -> list[str]:
    """A note where walls have a temperature: cases are made without the effect that brings it to the grains."""
    given = {name: own.entries for name, own in found.boundaries.items()}
    hot = [name for name, own in given.items() if own["kind"] in KINDS and "temperature_K" in own]
    return [f"boundaries {', '.join(hot)}: {FELT}"] if hot else []


def _limit(schemes: Path) -> None:
    """Have the gradients that vanLeer looks at limited: on cells that are no boxes gas that passes a cold wall else
    gets hotter than any around it (3363 K of 3000 K, beside a wall of 2200 K)."""
    text = schemes.read_text(encoding="utf-8")
    output.write_text(schemes, re.sub(r"(grad\([TY]\) +)leastSquares", r"\1cellLimited leastSquares 1", text))


def _copy_mesh(source: Path, gas: Path) -> None:
    """The mesh; patches of symmetry become plain ones, on which the gas slips."""
    (gas / FOLDER).mkdir(parents=True)
    for path in (path for name in MESH for path in (source / FOLDER).glob(f"{name}*") if path.stem == name):
        shutil.copyfile(path, gas / FOLDER / path.name)
    kinds = "|".join(sorted(SYMMETRIES, key=len, reverse=True))
    whole = dictionary.content(source / FOLDER / "boundary") or b""
    plain = re.sub(rf"(type\s+)(?:{kinds})\s*;".encode(), rb"\1patch;", whole)
    (gas / FOLDER / "boundary").write_bytes(re.sub(rb"inGroups[^;]*;", b"", plain) if plain != whole else whole)


def text(found, source: Path) -> str:
    """case.toml of what was found; what was not known stands in its comments."""
    spacing = max(found.cell / FINER * 1e3, found.grains["diameter_mm"])
    end, interval = found.times
    hot = len({found.gas["temperature_K"], *_temperatures(found)}) > 1
    on = [name for name in BED if any(found.gravity) or name != "gravity"]
    on += ["heat", "conduction"] if hot else []
    on += ["outflow"] if any(own.entries["kind"] == "pressure_outlet" for own in found.boundaries.values()) else []
    head = [f"# Made by sdph from the OpenFOAM case {source.name}; its mesh is in gas/{FOLDER}"]
    head += [f"# note: {note}" for note in found.notes]
    whole = [
        *head,
        _entries({"title": f"{source.resolve().name}, from OpenFOAM", "dimensions": found.dimensions, "effects": on}),
        _section("run", {"end_time_s": end, "output_interval_s": interval}),
        _section("domain", {"gravity_m_s2": found.gravity}, "size_m and lower_m, left out, are those of the mesh"),
        _section("resolution", {"spacing_mm": _short(spacing), "cell_mm": _short(found.cell * 1e3)},
                 "cell_mm is the mean of the mesh"),
        _section("gas", found.gas),
        _section("grains", found.grains),
        _section("particles.bed", found.bed),
        *(_section(f"boundaries.{_key(name)}", own.entries, own.note) for name, own in found.boundaries.items()),
        *_laws(found),
    ]  # fmt: skip
    return "\n".join(whole) + "\n"


def _laws(found) -> list[str]:
    """Sections of effects that differ from their defaults."""
    limit = found.grains.get("packing_limit", 0.63)
    friction = {"onset": _short(min(0.60, ONSET * limit))} if ONSET * limit < 0.60 else {}
    friction |= {} if found.friction_angle is None else {"angle_deg": found.friction_angle}
    rows = [("drag", {"law": found.drag} if found.drag else {}), ("friction", friction)]
    return [_section(name, entries) for name, entries in rows if entries and name in effects.REGISTRY]


def _temperatures(found) -> list[float]:
    given = [own.entries.get("temperature_K") for own in found.boundaries.values()]
    return [value for value in (found.bed["temperature_K"], *given) if value]


def _section(name: str, entries: dict, note: str = "") -> str:
    return f"\n[{name}]{f'  # {note}' if note else ''}\n{_entries(entries)}"


def _entries(entries: dict) -> str:
    return "\n".join(f"{key} = {json.dumps(_told(value))}" for key, value in entries.items())


def _told(value):
    """A value to be written: of a number nine digits."""
    return float(f"{value:.9g}") if isinstance(value, float) else value


def _key(name: str) -> str:
    return name if re.fullmatch(r"[\w-]+", name) else json.dumps(name)


def _short(value: float) -> float:
    return float(f"{value:.3g}")
