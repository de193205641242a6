"""Dashboard: every recorded check of every scene, misses first; records stand in validation/record."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from functools import cache

from making.docstrings import escaped
from sdph.scenes import paths
from sdph.study import compare, record, validate

# study -> its parts -> what names of a part's checks have in them and those of no other part
PARTS = {
    "experiments": {
        "packed_bed": "friction", "minimum_fluidisation": "U_mf", "liquid_fluidisation": "index n",
        "liquid_beds": "liquid bed of",
        "water_drops": "drop's", "heptane_drops": "heptane", "humid_drops": "water drop",
        "micro_drops": "micrometric drop", "bed_transfer": "transfer in a bed",
        "bed_heat": "heat in a packed bed", "heated_bed": "packed steel",
        "hot_tube": "hot tube", "tube_bank": "tube bank", "bed_pressure": "bed of beads",
        "bed_profiles": "bed of seeds",
        "drop_spread": "spread of a drop",
    },
    "kinetic_theory": {
        "cooling": "Haff", "diffusion": "wave of", "shear": "over the closure [", "flows": "Couette",
        "slopes": "slope of",
    },
    "granular_piles": {"columns": "column", "slopes": "slope", "hopper": "slot"},
    "spray_plug": {"plug": "film", "spreading": "onset"},
    "gel_droplet_reduced": {
        "course": "work on the shell", "rings": " ring at", "changes": "flux x2", "claims": "sonic",
    },
    "moving_particles": {"films": "pull over", "drops": "drop, ", "threads": "thread", "holes": "hole"},
    "two_methods": {"pools": "by mps"},
    "own_vessel": {"flows": "packed bed", "orders": "order of", "dummies": "nearest two", "leaks": "shaken"},
    "gas_turbulence": {"frozen": "frozen flow", "channel": "of a channel", "eddies": "of eddies"},
    "gel_ladder": {"beam": "beam of", "cavity": "swing of a cavity"},
}  # fmt: skip
HEAD = "| check | value | reference | off by | tolerance | verdict |\n|--|--|--|--|--|--|"


@cache
def validated() -> list[str]:
    """Scenes and studies that have checks."""
    return validate.validated()


@cache
def records() -> dict[str, dict]:
    """The record of each scene and study that has one."""
    found = {name: record.read(paths.data("validation") / "record", name) for name in validated()}
    return {name: own for name, own in found.items() if own}


def of_scene(name: str) -> str:
    """The checks of one scene, and when they were measured."""
    if name not in validated():
        return "None but the balances of its ledger, which every run prints."
    own = records().get(name)
    if own is None:
        return f"No record yet: `sdph validate {name} --record validation/record` makes one."
    return _told(own) + "".join(f"\n\nNot recorded: {lacking}." for lacking in [_listed(name, own)] if lacking)


def lacking(name: str, own: dict) -> list[str]:
    """Variants of a scene, or parts of a study, that `sdph validate` runs and a record has no check of."""
    names = [check["name"] for check in own["checks"]]
    if name in PARTS:
        return [part for part, words in PARTS[name].items() if not any(words in check for check in names)]
    variants = getattr(compare.scene_module(name), "VARIANTS", (name,))
    return [variant for variant in variants if not any(check.startswith(f"{variant}, ") for check in names)]


def _listed(name: str, own: dict) -> str:
    return "; ".join(lacking(name, own))


def whole() -> str:
    """The whole page."""
    found = records()
    misses = [check for own in found.values() for check in _missed(own)]
    missing = [name for name in validated() if name not in found]
    count = sum(len(own["checks"]) for own in found.values())
    short = {name: listed for name, own in found.items() if (listed := _listed(name, own))}
    parts = [
        f"{len(found)} of {len(found) + len(missing)} scenes and studies have a record, with {count} checks, of which "
        f"{len(misses)} miss their tolerance. What `sdph validate` runs and no record has is told "
        "[below](#without-a-record).",
        "## Against what others measured", measured(found),
        "## Misses", _table(misses) if misses else "None.",
        "## Scenes and studies", _overview(found),
        "## Without a record", ", ".join(_title(name) for name in missing) + "." if missing else "None.",
        *(f"Not recorded of {_title(name)}: {listed}." for name, listed in short.items()),
        "## Every check", *(f"### {name}\n\n{_told(own)}" for name, own in found.items()),
    ]  # fmt: skip
    return "\n\n".join(parts) + "\n"


def measured(found: dict[str, dict]) -> str:
    """A line for each experiment of others: checks, how many miss, the farthest of them over its tolerance."""
    told = validate.part(validate.EXPERIMENTS).MEASURED
    rows = [
        _experiment(name, source, what, ours, [c for c in found[name]["checks"] if re.match(begin, c["name"])])
        for name in told if name in found for begin, (source, what, ours) in told[name].items()
    ]  # fmt: skip
    head = (
        "| measured by | what | ours | checks | within | farthest off, in tolerances | more |\n|--|--|--|--|--|--|--|"
    )
    return "\n".join([head, *(row for row in rows if row)])


def _experiment(name: str, source: str, what: str, ours: str, checks: list[dict]) -> str:
    """The line of one; none where it has no checks yet."""
    if not checks:
        return ""
    far = max(math.inf if check["value"] is None else abs(_off(check)) / check["tolerance"] for check in checks)
    within = len(checks) - sum(not check["ok"] for check in checks)
    return f"| {source} | {what} | {ours} | {len(checks)} | {within} | {far:.2g} | {_title(name)} |"


def _missed(own: dict) -> list[dict]:
    return [check for check in own["checks"] if not check["ok"]]


def _title(name: str) -> str:
    from making import embedding

    page = embedding.page_of_scene(name)
    return f"[{name}]({page})" if page else name


def _overview(found: dict[str, dict]) -> str:
    """A line for each record, those with misses first."""
    ordered = sorted(found, key=lambda name: (-len(_missed(found[name])), name))
    rows = [
        f"| {_title(name)} | {len(own['checks'])} | {len(_missed(own)) or ''} | {own['date']} | {own['version']} | "
        f"{own['commit'] or '?'} | {own['gas']} |"
        for name in ordered
        for own in [found[name]]
    ]
    head = "| scene | checks | misses | measured | version | commit | gas |\n|--|--|--|--|--|--|--|"
    return "\n".join([head, *rows])


def _told(own: dict) -> str:
    """When a record was made, and its checks."""
    made = f"Measured {own['date']}, sdph {own['version']}, commit {own['commit'] or 'unknown'}, gas: {own['gas']}."
    made += "".join(f" {name}: {of['date']}, {of['commit'] or '?'}." for name, of in own.get("parts", {}).items())
    short = [check | {"name": check["name"].removeprefix(f"{own['scene']}, ")} for check in own["checks"]]
    return f"{made}\n\n{_table(short)}"


def _table(checks: Iterable[dict]) -> str:
    """Rows of checks, misses first."""
    rows = "\n".join([HEAD, *map(_row, sorted(checks, key=lambda check: check["ok"]))])
    return f":::{{container}} numbers\n\n{rows}\n\n:::"


def _row(check: dict) -> str:
    numbers = [check["value"], check["reference"], _off(check), check["tolerance"]]
    value, reference, off, tolerance = ("none" if x is None else f"{x:.5g}" for x in numbers)
    verdict = "ok" if check["ok"] else "**missed**"
    return f"| {escaped(check['name'])} | {value} | {reference} | {off} | {tolerance} | {verdict} |"


def _off(check: dict) -> float | None:
    value, reference = check["value"], check["reference"]
    return None if value is None or reference is None else value - reference
