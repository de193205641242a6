"""The settings that a scene is measured with. validation/<scene>/cost.toml declares them, or for a case of one's own a
cost.toml beside its case.toml, of which [knobs] and metrics are enough:

    reference = "..."   what the metrics' shares are taken from; errors are distances from the limit of the
                        ladder itself (`sdph.study.cost.converged`)
    settings = ["..."]  `key=value` that go with every rung, and with `sdph run --accuracy`
    excerpt = ["..."]   `key=value` of the ladder alone: how much of the scene a rung computes
    drop = ["..."]      effects that are switched off, one at a time
    [knobs]             key of the case -> values, coarse to fine, all of one length; the first is the step h that
                        orders are observed in, so that the others should shrink with it
    [alone]             key of the case -> values that are tried by themselves, all else in the middle
    metrics = ["..."]   keys of summary.json, relative to the limit of the ladder

In place of metrics, validation/<scene>/compare.py may have `metrics(run) -> {name: (value, reference, scale)}`, where a
reference of None leaves the value as it is and a scale of None means the reference, or else the limit; its
`others(case, folder)` yields (label, solver, wall time [s], metrics) of other solvers on the same scene, each on cells
of half the size.
"""

from __future__ import annotations

import difflib
import tomllib
from dataclasses import dataclass, field, fields
from pathlib import Path

from sdph import scenes
from sdph.case import read as cases
from sdph.running import vessel
from sdph.scenes import paths
from sdph.schema import CaseError, flat, unknown

LEVELS = 3  # of a ladder of one's own: an order takes three
ALL = "-"  # in the column `without`: no effect is left out


@dataclass(frozen=True)
class Ladder:
    """Settings of validation/<scene>/cost.toml; `usual`: what the scene has for the keys of `alone`."""

    knobs: dict
    reference: str = "Richardson's limit of the ladder"
    settings: list = field(default_factory=list)
    excerpt: list = field(default_factory=list)
    drop: list = field(default_factory=list)
    alone: dict = field(default_factory=dict)
    metrics: list = field(default_factory=list)
    usual: dict = field(default_factory=dict)

    @property
    def count(self) -> int:
        """Levels of the knobs."""
        return len(next(iter(self.knobs.values())))

    @property
    def middle(self) -> dict:
        """The level in the middle, of two the coarser one."""
        return self.level((self.count - 1) // 2)

    @property
    def steps(self) -> list[float]:
        """Step of each level: the values of the first knob."""
        return next(iter(self.knobs.values()))

    @property
    def keys(self) -> list[str]:
        """Keys of the case that a rung sets."""
        return [*self.knobs, *self.alone]

    def level(self, n: int) -> dict:
        """Settings of all knobs at level n, all else as usual."""
        return (
            {key: values[n] for key, values in self.knobs.items()}
            | {key: self.usual[key] for key in self.alone}
            | {"without": ALL}
        )


def declared(scene: str) -> Ladder:
    """The ladder of a scene, or of a case of one's own by its folder or file."""
    name, case = scenes.find(scene)
    shipped = scenes.HERE in case.resolve().parents
    file = (paths.data("validation") / name if shipped else case.parent) / "cost.toml"
    if not file.is_file():
        raise CaseError(
            f'{scene} declares no ladder; give {file} with [knobs], such as "resolution.spacing_mm" = [20.0, 14.1, '
            f"10.0], and metrics, a list of keys of summary.json; scenes that have one: {', '.join(with_ladder())}"
        )
    table = _read(file) if shipped else _checked(_read(file), file)
    resolved = flat(cases.to_table(vessel.load(case, tuple(table.get("settings", ())))))
    strange = [key for key in (*table["knobs"], *table.get("alone", ())) if key not in resolved]
    if strange:
        near = difflib.get_close_matches(strange[0], resolved, n=1)
        hint = f"; did you mean {near[0]}?" if near else ""
        raise CaseError(f"{file}: the case has no key {strange[0]}{hint}")
    return Ladder(**table, usual={key: resolved[key] for key in table.get("alone", ())})


def _read(file: Path) -> dict:
    try:
        return tomllib.loads(file.read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise CaseError(f"{file}: {error}") from None


def _checked(table: dict, file: Path) -> dict:
    """The table of a ladder of one's own, with all that one has."""
    known = {own.name for own in fields(Ladder)} - {"usual"}
    for key in table.keys() - known:
        raise CaseError(f"{file}: {unknown(key, known)}")
    knobs, metrics = table.get("knobs"), table.get("metrics")
    levels = list(knobs.values()) if isinstance(knobs, dict) else []
    if not levels or not all(isinstance(own, list) and len(own) == len(levels[0]) >= LEVELS for own in levels):
        raise CaseError(f"{file}: [knobs] must hold lists of one length, of {LEVELS} values or more, coarse to fine")
    if not isinstance(metrics, list) or not metrics or not all(isinstance(own, str) for own in metrics):
        raise CaseError(f"{file}: metrics must be a list of keys of summary.json, what errors are told of")
    return table


def with_ladder() -> list[str]:
    """Scenes that declare one."""
    return [name for name in scenes.names() if (paths.data("validation") / name / "cost.toml").is_file()]


def rungs(own: Ladder) -> list[tuple[str, dict]]:
    """(label, settings): all knobs together from coarse to fine, then one at a time from the middle, then effects
    off."""
    found = [(f"all {n + 1}/{own.count}", own.level(n)) for n in range(own.count)]
    for key, values in (own.knobs | own.alone).items():
        found += [(key, own.middle | {key: value}) for value in values if value != own.middle[key]]
    return found + [(f"without {name}", own.middle | {"without": name}) for name in own.drop]


def overrides(settings: dict) -> tuple[str, ...]:
    """`--set` arguments of a rung."""
    return tuple(f"{key}={value}" for key, value in settings.items() if key != "without")


def case_of(scene: str, own: Ladder, settings: dict, *more: str) -> cases.Case:
    """The case of a rung."""
    table = cases.to_table(
        vessel.load(scenes.find(scene)[1], (*own.settings, *own.excerpt, *overrides(settings), *more))
    )
    if settings["without"] != ALL:
        table["effects"] = [name for name in table["effects"] if name != settings["without"]]
        table.pop(settings["without"], None)
    return cases.from_table(table)
