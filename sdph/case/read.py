"""case.toml -> a frozen `Case` in SI, and back.

Sections are declared in `sdph.case.sections`; the section of an effect is declared in the effect's own file. An
unknown key, a bad value or a section of an effect that is off is a `CaseError`.
"""

from __future__ import annotations

import contextlib
import os
import re
import tomllib
from pathlib import Path

import tomli_w

from sdph import effects, scenes
from sdph.case import elsewhere, fluids, judge, materials, moving
from sdph.case.check import check
from sdph.case.sections import GROUPS, SECTIONS, Case, Coupling, Vapour
from sdph.methods.liquids.sections import GasPhase, Liquid
from sdph.methods.mps.sections import LiquidMethod
from sdph.methods.solids.sections import Solid
from sdph.schema import CaseError, fields, plausible, read, record, unknown, vector, write

METHODS = {
    "liquid": Liquid,
    "gas_phase": GasPhase,
    "solid": Solid,
    "method": LiquidMethod,
}  # sections of methods without a gas
LONGEST = 100  # letters of a name; our choice
# bytes of a case file, parts of a dotted key (the parser's time goes with their square); our choice
LARGEST, DEEPEST = 2**20, 50
PART = r"""(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')"""
DOTTED = re.compile(rf"(?<![\w-])(?:{PART}[ \t]{{0,9}}\.[ \t]{{0,9}}){{{DEEPEST}}}")
FILES = [  # (section, key) of all that name a file
    (name, key)
    for name, row in effects.REGISTRY.items()
    for key, (_, kind) in fields(row.parameters).items()
    if kind.of is Path
]
OF_GROUPS = {"nozzles": ("table", "record"), "particles": ("mesh",)}  # keys that do so in sections with names


def load(path: Path, overrides: tuple[str, ...] = ()) -> Case:
    """The case of a TOML file, with `key=value` overrides (dotted keys, TOML values).

    Files that the case names lie where they do from its own folder, those of the overrides from the working directory.
    """
    given = located(path)
    for override in overrides:
        put(given, override)
    return from_working_directory(given)


def located(path: Path) -> dict:
    """Table of a TOML file, the paths of files in it absolute."""
    given = parsed(path)
    _locate(given, Path(path).parent)
    return given


def from_working_directory(table: dict) -> Case:
    """The case of a table whose relative paths are taken from the working directory."""
    _locate(table, Path())
    return from_table(table)


def parsed(path: Path) -> dict:
    """Table of a TOML file; some editors put a byte order mark before it."""
    try:
        with open(path, encoding="utf-8-sig") as file:
            text = file.read(LARGEST + 1)
        large, deep = len(text) > LARGEST, DOTTED.search(text)
        if not large and not deep:
            return tomllib.loads(text)
    except (ValueError, RecursionError) as error:  # not TOML, not UTF-8, numbers too long, lists too deep
        raise CaseError(f"{path} is not TOML: {error}") from None
    except OSError as error:
        raise CaseError(f"{path} cannot be read: {error.strerror}; give a case.toml that can") from None
    if large:
        long = "a long motion belongs into a file, frame.table"
        raise CaseError(f"{path} is too large for a case: at most {LARGEST} letters are read; {long}")
    raise CaseError(
        f"{path}: a key there has {DEEPEST} parts or more; the longest that a case has are section.name.key"
    )


def _locate(table: dict, folder: Path) -> None:
    """Make the paths of files absolute, from `folder`."""
    for _, entries, key in files(table):
        entries[key] = os.path.abspath(folder / entries[key])


def files(table: dict) -> list[tuple[str, dict, str]]:
    """(section, its entries, key) of all in a TOML table that names a file, or the case that a nozzle records."""
    parts = [(section, table.get(section), key) for section, key in FILES]
    parts += [
        (f"{group}.{name}", entries, key)
        for group, keys in OF_GROUPS.items()
        for name, entries in (table[group].items() if isinstance(table.get(group), dict) else ())
        for key in keys
    ]
    return [
        (where, entries, key)
        for where, entries, key in parts
        if isinstance(entries, dict) and isinstance(entries.get(key), str) and entries[key]
        if key != "record" or entries[key] not in scenes.names()
    ]


def put(table: dict, text: str) -> None:
    """Put `section.key=value`, the value as in TOML, into a table."""
    key, equals, value = text.partition("=")
    entries, last = place(table, key, f"--set {text}")
    if not equals:
        raise CaseError(f"--set {text}: give it as section.key=value")
    entries[last] = value_of(value)


def value_of(text: str):
    """The value of a text as in TOML; the text itself where it is none."""
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except (ValueError, RecursionError):
        return text


def place(table: dict, key: str, told: str) -> tuple[dict, str]:
    """The section (made where there is none) and the last part of a dotted key; `told` begins the message."""
    *sections, last = key.strip().split(".")
    if not all([*sections, last]):
        raise CaseError(f"{told}: give it as section.key=value")
    for section in sections:
        table = table.setdefault(section, {})
        if not isinstance(table, dict):
            raise CaseError(f"{told}: {section} is a value, not a section")
    return table, last


def from_table(table: dict) -> Case:
    """The case of a parsed TOML table."""
    head = {"title", "scene", "dimensions", "effects", "coupling", "vapour", "track", *METHODS}
    known = head | SECTIONS.keys() | GROUPS.keys() | effects.REGISTRY.keys()
    for key in table:
        if key not in known:
            raise CaseError(unknown(key, known))
    elsewhere.refuse(table, SECTIONS)
    table = fluids.filled(_decided(moving.taken_over(table)))
    spared = {"gas", "grains"} if table.keys() & {"liquid", "solid"} else set()
    given = {name: cls for name, cls in SECTIONS.items() if name not in spared - table.keys()}
    kinds = materials.materials(table)
    if kinds:
        del given["grains"]
    sections = dict.fromkeys(SECTIONS) | {name: _section(cls, table.get(name, {}), name) for name, cls in given.items()}
    sections |= {"grains": next(iter(kinds.values()))} if kinds else {}
    groups = {name: _group(cls, table.get(name, {}), name) for name, cls in GROUPS.items()}
    on = _effects(table)
    case = Case(
        title=_text(table, "title"),
        scene=_text(table, "scene"),
        dimensions=_dimensions(table),
        effects=on,
        coupling=_section(Coupling, table.get("coupling", {}), "coupling"),
        **{name: _section(cls, table[name], name) if name in table else None for name, cls in METHODS.items()},
        vapour=_section(Vapour, table["vapour"], "vapour") if "vapour" in table else None,
        track=_track(table),
        materials=kinds,
        parameters={name: _section(effects.REGISTRY[name].parameters, table.get(name, {}), name) for name in on},
        **sections,
        **groups,
    )
    check(case)
    return case


def _section(cls, table, where: str):
    return plausible(read(cls, table, where), where)


def _text(table: dict, key: str) -> str:
    given = table.get(key, "")
    if not isinstance(given, str):
        raise CaseError(f"{key} = {str(given)[:80]}; it must be a text, in quotes")
    return given


@record
class _Track:
    particles: tuple = vector("", ())  # numbers, counted from 1


def _track(table: dict) -> tuple[int, ...]:
    named = _section(_Track, table.get("track", {}), "track").particles
    if any(isinstance(number, tuple) or number != int(number) for number in named):
        raise CaseError(f"track.particles = {list(named)}; they must be whole numbers, counted from 1")
    if any(number < 1 for number in named):
        raise CaseError(f"track.particles = {list(named)}; numbers of particles begin at 1")
    return tuple(int(number) for number in named)


def _group(cls, table: dict, where: str) -> dict:
    if not isinstance(table, dict) or not all(isinstance(entry, dict) for entry in table.values()):
        raise CaseError(f"[{where}] must hold named sections, such as [{where}.some_name]")
    for name in table:
        if not name.isprintable() or not name.strip() or len(name) > LONGEST:
            allowed = f"give one of 1 to {LONGEST} letters that can be printed"
            raise CaseError(f"{where} holds the name {name[:LONGEST]!r}; {allowed}")
    return {name: _section(cls, entry, f"{where}.{name}") for name, entry in table.items()}


def _dimensions(table: dict) -> int:
    given = table.get("dimensions")
    if not isinstance(given, int) or given not in (2, 3):
        raise CaseError(f"dimensions = {given!r}; it must be 2 or 3")
    return given


def _refuse_names(on: list[str]) -> None:
    """CaseError where one is no effect, or stands there twice."""
    for name in on:
        if name not in effects.REGISTRY:
            raise CaseError(unknown(name, effects.REGISTRY).replace("key", "effect", 1))
    if len(set(on)) < len(on):
        raise CaseError(f"effects = {on}; each may stand there once")


def _effects(table: dict) -> tuple[str, ...]:
    on = table.get("effects", [])
    if not isinstance(on, list) or not all(isinstance(name, str) for name in on):
        raise CaseError(f"effects = {on!r}; it must be a list of names out of {', '.join(sorted(effects.REGISTRY))}")
    _refuse_names(on)
    if off := sorted(effects.REGISTRY.keys() & table.keys() - set(on)):
        given = ", ".join(f"[{name}]" for name in off)
        raise CaseError(
            f"{given} given, but {', '.join(off)} not among effects = {list(on)}; add there what is meant to act, or "
            "remove the section"
        )
    return tuple(on)


def _decided(table: dict) -> dict:
    """The table of a case with the effects that it calls for in the place of "auto", and no section of another."""
    if table.get("effects") != "auto":
        return table
    return _with_effects(table, _automatic(table))


def _with_effects(table: dict, on: tuple[str, ...]) -> dict:
    return {key: own for key, own in table.items() if key not in effects.REGISTRY or key in on} | {"effects": [*on]}


def _automatic(table: dict) -> tuple[str, ...]:
    """The effects that a case calls for, and those that cannot judge themselves but have a section. Droplets of a fluid
    that is named can evaporate, by heat from the gas: it has all that evaporation asks for, unless the case has what
    evaporation does not go with. What is wrong with both is told as of the first."""
    grains = table.get("grains")
    if not (isinstance(grains, dict) and isinstance(grains.get("fluid"), str) and grains["fluid"]):
        return _called(table, ())
    try:
        on = _called(table, ("evaporation",))
        on += ("heat",) * ("evaporation" in on and "heat" not in on)
        case = from_table(_with_effects(table, on))
        for name in case.effects:
            effects.kernel_of(effects.REGISTRY[name], case)
        return on
    except CaseError as error:
        with contextlib.suppress(CaseError):
            return _called(table, ())
        raise error


def _called(table: dict, more: tuple[str, ...]) -> tuple[str, ...]:
    """The effects that a case calls for among all that have a section or need none, and `more`."""
    given = [name for name in effects.REGISTRY if name in table or name in more]
    bare = table | {"effects": given}
    if isinstance(table.get("run"), dict):  # walls that forces are asked of may not be there yet
        bare |= {"run": {key: value for key, value in table["run"].items() if key != "forces"}}
    called = judge.called_for(from_table(bare))
    return tuple(name for name, row in effects.REGISTRY.items() if name in called or (name in given and not row.call))


def to_table(case: Case) -> dict:
    """The TOML table of a case, every value resolved."""
    table = {"title": case.title, "scene": case.scene, "dimensions": case.dimensions, "effects": list(case.effects)}
    table |= {name: write(getattr(case, name)) for name in (*SECTIONS, "coupling", *METHODS) if getattr(case, name)}
    table |= {"grains": materials.tables(case)} if case.materials else {}
    table |= {group: {name: write(entry) for name, entry in getattr(case, group).items()} for group in GROUPS}
    table |= {name: write(parameters) for name, parameters in case.parameters.items() if write(parameters)}
    if case.vapour:
        table["vapour"] = write(case.vapour)
    if case.track:
        table["track"] = {"particles": list(case.track)}
    return table


def dumps(case: Case) -> str:
    """The resolved case as TOML text."""
    return tomli_w.dumps(to_table(case))
