"""case.toml -> a frozen `Case` in SI, and back.

Sections are declared in `sdph.sections`; the section of an effect is declared in the effect's own file. An
unknown key, a bad value or a section of an effect that is off is a `CaseError`.
"""

from __future__ import annotations

import math
import os
import re
import tomllib
from pathlib import Path

import tomli_w

from sdph import checks, effects, scenes
from sdph.checks import SAME
from sdph.liquid import GasPhase, Liquid, Pool
from sdph.schema import CaseError, fields, plausible, read, record, unknown, vector, write
from sdph.sections import GROUPS, SECTIONS, Case, Coupling, Region, Vapour

MOST_OUTPUTS = 1e5  # of fields, and of history rows of a liquid as it sets them; our choice
STRETCH = 100.0  # of the last cell of a row over its first, at most, either way; our choice
LONGEST = 100  # letters of a name; our choice
LARGEST, DEEPEST = 2**20, 50  # bytes of a case file, parts of a dotted key (the parser's time goes with their square); our choice
PART = r"""(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')"""
DOTTED = re.compile(rf"(?<![\w-])(?:{PART}[ \t]{{0,9}}\.[ \t]{{0,9}}){{{DEEPEST}}}")
FILES = [  # (section, key) of all that name a file
    (name, key) for name, row in effects.REGISTRY.items() for key, (_, kind) in fields(row.parameters).items() if kind.of is Path
]


def load(path: Path, overrides: tuple[str, ...] = ()) -> Case:
    """The case of a TOML file, with `key=value` overrides (dotted keys, TOML values).

    Files that the case names lie where they do from its own folder, those of the overrides from the working directory.
    """
    given = parsed(path)
    _locate(given, Path(path).parent)
    for override in overrides:
        _override(given, override)
    _locate(given, Path())
    return from_table(given)


def parsed(path: Path) -> dict:
    """What a TOML file holds; some editors put a byte order mark before it."""
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
        raise CaseError(f"{path} is too large for a case: at most {LARGEST} letters are read; a long motion belongs into a file, frame.table")
    raise CaseError(f"{path}: a key there has {DEEPEST} parts or more; the longest that a case has are section.name.key")


def _locate(table: dict, folder: Path) -> None:
    """Make the paths of files absolute, from `folder`."""
    for section, key in FILES:
        entries = table.get(section)
        if isinstance(entries, dict) and isinstance(entries.get(key), str) and entries[key]:
            entries[key] = os.path.abspath(folder / entries[key])


def _override(table: dict, text: str) -> None:
    key, equals, value = text.partition("=")
    *sections, last = key.strip().split(".")
    if not equals or not all([*sections, last]):
        raise CaseError(f"--set {text}: give it as section.key=value")
    for section in sections:
        table = table.setdefault(section, {})
        if not isinstance(table, dict):
            raise CaseError(f"--set {text}: {section} is a value, not a section")
    try:
        table[last] = tomllib.loads(f"value = {value}")["value"]
    except (ValueError, RecursionError):
        table[last] = value


def from_table(table: dict) -> Case:
    """The case of a parsed TOML table."""
    head = {"title", "scene", "dimensions", "effects", "coupling", "vapour", "track", "liquid", "gas_phase"}
    for key in table:
        if key not in head | SECTIONS.keys() | GROUPS.keys() | effects.REGISTRY.keys():
            raise CaseError(unknown(key, head | SECTIONS.keys() | GROUPS.keys() | effects.REGISTRY.keys()))
    spared = {"gas", "grains"} if "liquid" in table else set()
    given = {name: cls for name, cls in SECTIONS.items() if name not in spared - table.keys()}
    sections = dict.fromkeys(SECTIONS) | {name: _section(cls, table.get(name, {}), name) for name, cls in given.items()}
    groups = {name: _group(cls, table.get(name, {}), name) for name, cls in GROUPS.items()}
    on = _effects(table)
    case = Case(
        title=_text(table, "title"),
        scene=_text(table, "scene"),
        dimensions=_dimensions(table),
        effects=on,
        coupling=_section(Coupling, table.get("coupling", {}), "coupling"),
        liquid=_section(Liquid, table["liquid"], "liquid") if "liquid" in table else None,
        gas_phase=_section(GasPhase, table["gas_phase"], "gas_phase") if "gas_phase" in table else None,
        vapour=_section(Vapour, table["vapour"], "vapour") if "vapour" in table else None,
        track=_track(table),
        parameters={name: _section(effects.REGISTRY[name].parameters, table.get(name, {}), name) for name in on},
        **sections,
        **groups,
    )
    _check(case)
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


def _effects(table: dict) -> tuple[str, ...]:
    on = table.get("effects", [])
    if on == "auto":
        return _automatic(table)
    if not isinstance(on, list) or not all(isinstance(name, str) for name in on):
        raise CaseError(f"effects = {on!r}; it must be a list of names out of {', '.join(sorted(effects.REGISTRY))}")
    for name in on:
        if name not in effects.REGISTRY:
            raise CaseError(unknown(name, effects.REGISTRY).replace("key", "effect", 1))
    if len(set(on)) < len(on):
        raise CaseError(f"effects = {on}; each may stand there once")
    for name in effects.REGISTRY.keys() & table.keys() - set(on):
        raise CaseError(f"[{name}] is given, but {name} is not among effects = {list(on)}; add it there or remove the section")
    return tuple(on)


def _automatic(table: dict) -> tuple[str, ...]:
    """The effects that a case calls for, and those that cannot judge themselves but have a section."""
    from sdph.explain import judge

    given = [name for name in effects.REGISTRY if name in table]
    called = judge.called_for(from_table(table | {"effects": given}))
    return tuple(name for name, row in effects.REGISTRY.items() if name in called or (name in given and not row.call))


def _check(case: Case) -> None:
    """What no single key can tell."""
    if case.scene and case.scene not in scenes.names():
        raise CaseError(f"{unknown(case.scene, scenes.names()).replace('unknown key', 'scene =', 1)}; or leave it out")
    matter = "liquid" if case.liquid else "grains"
    for name in case.effects:
        if matter not in effects.REGISTRY[name].matter:
            raise CaseError(f"effects holds {name}, which does not act on {'a liquid' if case.liquid else 'grains'}; leave it out")
    _check_phases(case)
    if case.resolution.cell is None and not case.liquid:
        raise CaseError("resolution.cell_mm is missing; it has no default: give it in [resolution]")
    vectors = {"domain.size_m": case.domain.size, "domain.gravity_m_s2": case.domain.gravity, "resolution.stretch": case.resolution.stretch}
    for group, places, cls in (("particles", case.particles, Region), ("pools", case.pools, Pool)):
        for name, place in places.items():
            vectors |= {f"{group}.{name}.{key}": getattr(place, at) for key, (at, kind) in fields(cls).items() if kind.components is None}
    for name, probe in case.probes.items():
        vectors[f"probes.{name}.at_m"] = probe.at
    for name, boundary in case.boundaries.items():
        vectors[f"boundaries.{name}.velocity_m_s"] = boundary.velocity
    for name, nozzle in case.nozzles.items():
        own = {"centre_m": nozzle.centre, "direction": nozzle.direction, "across": nozzle.across}
        vectors |= {f"nozzles.{name}.{key}": value for key, value in own.items()}
    if own := case.parameters.get("tank"):
        vectors |= {"tank.lower_m": own.lower, "tank.upper_m": own.upper, "tank.centre_m": own.centre}
    for key, value in vectors.items():
        if value is not None and (len(value) != case.dimensions or any(isinstance(v, tuple) for v in value)):
            raise CaseError(f"{key} has {len(value)} components; dimensions = {case.dimensions} asks for {case.dimensions}")
    if any(not 1.0 / STRETCH <= ratio <= STRETCH for ratio in case.resolution.stretch or ()):
        given = f"resolution.stretch = {list(case.resolution.stretch)}"
        raise CaseError(f"{given}; every ratio must be from {1.0 / STRETCH:g} to {STRETCH:g}: 1 for equal cells")
    if min(case.domain.size) <= 0.0:
        raise CaseError(f"domain.size_m = {list(case.domain.size)}; every length must be above 0")
    _check_period(case)
    if any(isinstance(t, tuple) or t <= 0.0 for t in case.run.report_at):
        raise CaseError(f"run.report_at_s = {list(case.run.report_at)}; it must be a list of times above 0")
    _check_outputs(case)
    for name, pool in case.pools.items():
        if pool.shape != "tank":
            _check_place(case, f"pools.{name}", pool)
        checks.flow(case, f"pools.{name}", pool)
    for name, boundary in case.boundaries.items():
        checks.side(case, f"boundaries.{name}", boundary)
    for name, region in case.particles.items():
        _check_region(case, name, region)
    for name, probe in case.probes.items():
        checks.probe(case, f"probes.{name}", probe)
    for name, nozzle in case.nozzles.items():
        checks.mouth(case, f"nozzles.{name}", nozzle)
    checks.columns_of_history(case)


def _check_outputs(case: Case) -> None:
    intervals = {"run.output_interval_s": case.run.output_interval}
    if case.liquid:
        intervals["liquid.history_interval_s"] = case.liquid.history_interval
    for key, interval in intervals.items():
        if interval and case.run.end_time > MOST_OUTPUTS * interval:
            given = f"{key} = {interval:g} up to run.end_time_s = {case.run.end_time:g}"
            raise CaseError(f"{given} makes {case.run.end_time / interval:.3g} outputs; {MOST_OUTPUTS:.0e} are allowed: lengthen the one or shorten the other")


def _check_place(case: Case, where: str, part) -> None:
    """A region or a pool has what its shape needs, is no box upside down, and no narrower than the spacing."""
    needs = ("lower", "upper") if part.shape == "box" else ("centre", "radius")
    for key in needs:
        if getattr(part, key) is None:
            raise CaseError(f"{where}.{key}_m is missing; a {part.shape} needs {' and '.join(f'{n}_m' for n in needs)}")
    size = part.radius if part.shape != "box" else min(b - a for a, b in zip(part.lower, part.upper))
    if size <= 0.0:
        raise CaseError(f"{where}: upper_m = {list(part.upper)} must lie above lower_m = {list(part.lower)} along every axis")
    if case.resolution.spacing > size * (1.0 + SAME):
        spacing = f"resolution.spacing_mm = {case.resolution.spacing * 1e3:g}"
        raise CaseError(f"{spacing} is larger than {where} ({size * 1e3:g} mm); give a spacing well below that")


def _check_phases(case: Case) -> None:
    if case.gas_phase is None:
        two = [f"pools.{name}.phase = \"gas\"" for name, pool in case.pools.items() if pool.phase == "gas"]
        two += [name for name in case.effects if effects.REGISTRY[name].two_phases]
        if two:
            raise CaseError(f"{two[0]} needs a second phase; give its properties in [gas_phase]")
        return
    if case.liquid is None:
        raise CaseError("[gas_phase] is given without [liquid]; a gas around grains goes into [gas]")
    if "drain" in case.effects:
        raise CaseError("effects holds drain, which knows one phase; leave it or [gas_phase] out")
    if case.gas_phase.density_by == "summation" and "density_diffusion" in case.effects:
        raise CaseError("effects holds density_diffusion, but with gas_phase.density_by = \"summation\" no density is advanced; leave one out")


def _check_period(case: Case) -> None:
    axes, least = "xyz"[: case.dimensions], 4.0 * case.smoothing_length  # two reaches, or an image would be missed
    for axis in case.domain.periodic:
        if axis not in axes:
            raise CaseError(f"domain.periodic holds {axis!r}; allowed: {', '.join(axes)}")
        if case.domain.period[axes.index(axis)] < least:
            raise CaseError(f"domain.size_m is below {least:g} m along {axis}, which is periodic; lengthen it or take finer grains")
    if case.liquid:
        _check_period_of_liquid(case)


def _check_period_of_liquid(case: Case) -> None:
    given, least = case.liquid.periodic, 4.1 * case.smoothing_length  # two reaches of the neighbour rows
    if given and (len(given) != case.dimensions or any(on not in (0.0, 1.0) for on in given)):
        raise CaseError(f"liquid.periodic = {list(given)}; it must be {case.dimensions} numbers, 1 along periodic axes and 0 along the others")
    for axis, length, on in zip("xyz", case.domain.size, given):
        if on and length < least:
            raise CaseError(f"domain.size_m is below {least:g} m along {axis}, which is periodic; lengthen it or take a finer spacing")


def _check_region(case: Case, name: str, region: Region) -> None:
    _check_place(case, f"particles.{name}", region)
    if region.volume_fraction > case.grains.packing_limit:
        given = f"particles.{name}.volume_fraction = {region.volume_fraction:g}"
        raise CaseError(f"{given}; grains pack to grains.packing_limit = {case.grains.packing_limit:g} at most: lower the one or raise the other")
    box = region.shape == "box"
    lower = region.lower if box else [c - region.radius for c in region.centre]
    checks.inside(case, f"particles.{name}", lower, region.upper if box else [c + region.radius for c in region.centre])


def to_table(case: Case) -> dict:
    """The TOML table of a case, every value resolved."""
    table = {"title": case.title, "scene": case.scene, "dimensions": case.dimensions, "effects": list(case.effects)}
    table |= {name: write(getattr(case, name)) for name in (*SECTIONS, "coupling", "liquid", "gas_phase") if getattr(case, name)}
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


def cells(case: Case) -> tuple[int, ...]:
    """Number of gas cells along each axis: the lengths over the cell size, rounded."""
    return tuple(max(1, math.floor(length / case.resolution.cell + 0.5)) for length in case.domain.size)
