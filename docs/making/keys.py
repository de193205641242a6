"""Tables of the keys of a case, from their declarations; what they mean stands in docs/keys.toml.

A key without a meaning there, or a meaning of a key that is gone, ends the building.
"""

from __future__ import annotations

import dataclasses
import tomllib
from pathlib import Path

from making.docstrings import escaped
from sdph import effects
from sdph.case import matter
from sdph.case import sections as declared
from sdph.schema import PLAUSIBLE, SAME_AS, fields, write
from sdph.study.gel_droplet.sections import CLASSES

MEANINGS = Path(__file__).parents[1] / "keys.toml"
SINGLE = {
    "gas.turbulence": matter.Turbulence, "coupling": declared.Coupling, "vapour": declared.Vapour,
    "liquid": declared.Liquid, "method": declared.LiquidMethod, "gas_phase": declared.GasPhase, "solid": declared.Solid,
}  # fmt: skip
WRITTEN = {  # unit in a key -> as it is written
    "": "1", "kg_m3": "kg/m³", "Pa_s": "Pa s", "W_m_K": "W/(m K)", "J_kg_K": "J/(kg K)", "J_kg": "J/kg", "m_s": "m/s",
    "m_s2": "m/s²", "m2_s": "m²/s", "m2_s2": "m²/s²", "kg_kmol": "kg/kmol", "kg_s": "kg/s", "N_m": "N/m",
    "Pa_m6_kg2": "Pa m⁶/kg²", "rad_s": "rad/s", "1_s": "1/s", "W_m2": "W/m²", "deg": "degrees",
    "V_m": "V/m", "C_m2": "C/m²", "m2_s3": "m²/s³",
}  # fmt: skip
HEAD = "| key | meaning | unit | default | allowed |\n|--|--|--|--|--|"
KINDS = {bool: "true, false", int: "whole number", str: "text", Path: "path of a file, from the folder of the case"}


def of_a_case() -> dict[str, type]:
    """Sections of a case, in the order of the reference."""
    groups = {f"{name}.NAME": cls for name, cls in declared.GROUPS.items()}
    return declared.SECTIONS | groups | SINGLE | {name: row.parameters for name, row in effects.REGISTRY.items()}


def of_a_droplet() -> dict[str, type]:
    """Sections of `sdph droplet`."""
    return {f"droplet: {name}": cls for name, cls in CLASSES.items()}


def meanings() -> dict[str, dict[str, str]]:
    """Section -> key -> meaning; as many as there are keys."""
    given = tomllib.loads(MEANINGS.read_text(encoding="utf-8"))
    known = {name: set(fields(cls)) for name, cls in (of_a_case() | of_a_droplet()).items()}
    for name in known.keys() | given.keys():
        missing = known.get(name, set()) ^ set(given.get(name, {}))
        if missing:
            raise ValueError(f"{MEANINGS.name}: [{name}] and the code differ in {', '.join(sorted(missing))}")
    return given


def tables(sections: dict[str, type], intro: dict[str, str] | None = None) -> str:
    """A heading, what the section is, and a table for each section."""
    told = meanings()
    return "\n".join(
        _section(name, cls, told.get(name, {}), (intro or {}).get(name, "")) for name, cls in sections.items()
    )


def _section(name: str, cls: type, told: dict[str, str], intro: str) -> str:
    own = "" if (cls.__doc__ or "").startswith(f"{cls.__name__}(") else escaped(" ".join((cls.__doc__ or "").split()))
    rows = [_row(cls, key, attribute, kind, told[key]) for key, (attribute, kind) in fields(cls).items()]
    table = "\n".join([HEAD, *rows]) if rows else "No keys."
    label = "keys-" + name.replace("droplet: ", "droplet-").replace(".NAME", "").replace("_", "-").replace(".", "-")
    return "\n\n".join(filter(None, [f"({label})=\n### [{name.removeprefix('droplet: ')}]", intro, own, table])) + "\n"


def _row(cls: type, key: str, attribute: str, kind, meaning: str) -> str:
    numbers = not kind.choices and kind.of is None
    unit = WRITTEN.get(kind.unit, kind.unit) if numbers else ""
    return f"| `{key}` | {meaning} | {unit} | {_default(cls, attribute)} | {_allowed(kind)} |"


def _default(cls: type, attribute: str) -> str:
    field = next(f for f in dataclasses.fields(cls) if f.name == attribute)
    if field.default is dataclasses.MISSING:
        return "**required**"
    bare = object.__new__(cls)
    for other in dataclasses.fields(cls):
        object.__setattr__(bare, other.name, None if other.default is dataclasses.MISSING else other.default)
    value = write(bare).get(field.metadata["kind"].key(attribute))
    return "none" if value in (None, "", []) else f"`{str(value).lower() if isinstance(value, bool) else value}`"


def _allowed(kind) -> str:
    if kind.choices:
        return ", ".join(f"`{word}`" for word in kind.choices)
    low = f"> {kind.above:g}" if kind.above > float("-inf") else f">= {kind.least:g}"
    bounds = [low] * (low != ">= -inf") + [f"<= {kind.most:g}"] * (kind.most < float("inf"))
    what = KINDS.get(kind.of, "number" if kind.components == 0 else "list of numbers")
    if kind.of is str and kind.components is None:
        what = "text or list of texts"
    if dataclasses.is_dataclass(kind.of):
        return "a section"
    if kind.of is None and kind.components:
        what = f"list of {kind.components} numbers"
    return escaped(" ".join([what, ", ".join(bounds)]).strip())


def plausible() -> str:
    """Table of what makes sense, by unit."""
    same = {unit: [unit, *(other for other, base in SAME_AS.items() if base == unit)] for unit in PLAUSIBLE}
    rows = [
        f"| {', '.join(WRITTEN.get(own, own) for own in same[unit])} | {least:g} | {most:g} | {why} |"
        for unit, (least, most, why) in PLAUSIBLE.items()
    ]
    return "\n".join(
        ["| unit | least, of what must be above 0 (SI) | most (SI) | what lies there |\n|--|--|--|--|", *rows]
    )
