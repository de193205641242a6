"""Cases in Python: keys as in case.toml, with their units in their names."""

from __future__ import annotations

import copy
import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import tomli_w

from sdph import scenes
from sdph.api import launch
from sdph.case import read as cases
from sdph.case.sections import Case as Resolved
from sdph.running import driver, inputs, output, vessel
from sdph.schema import CaseError, flat, unknown


class Case:
    """A case that can be changed; it is whole at any time, and a change that would harm it is refused.

    Keys are those of case.toml, dotted: `case["resolution.spacing_mm"] = 1.25`, `case["effects"]`. What is read is
    resolved: defaults are there too.
    """

    def __init__(self, table: Mapping[str, Any], name: str = "case", file: Path | None = None) -> None:
        """A case from a table as case.toml has it; relative paths of files are taken from the working directory."""
        self.name, self.file = name, file  # `file` is the case.toml that it is of; the folder gas beside it is its gas
        self._take(copy.deepcopy(dict(table)))

    @classmethod
    def load(cls, target: str | os.PathLike[str]) -> Case:
        """The case of a scene's name, a folder that holds a case.toml, or a case file."""
        name, file = scenes.find(os.fspath(target))
        table = cases.located(file)
        for override in vessel.domain(file, table):
            cases.put(table, override)
        return cls(table, name, file)

    @classmethod
    def of(cls, given: Case | str | os.PathLike[str]) -> Case:
        """The case itself, or the one that a name or path tells."""
        return given if isinstance(given, Case) else cls.load(given)

    def _take(self, table: dict[str, Any]) -> None:
        self._resolved = cases.from_working_directory(table)
        self._table = table

    @property
    def resolved(self) -> Resolved:
        """The frozen case in SI, as the engine has it."""
        return self._resolved

    @property
    def title(self) -> str:
        """The line that says what it is."""
        return self._resolved.title

    @property
    def table(self) -> dict[str, Any]:
        """All sections with every value resolved, in the units of their keys."""
        return cases.to_table(self._resolved)

    @property
    def gas_folder(self) -> Path:
        """The OpenFOAM case that its gas is made from."""
        return driver.template_of(self._resolved, self.name, self.file)

    def update(self, changes: Mapping[str, Any]) -> None:
        """Change several keys at once: they need to fit each other only when all are there."""
        table = copy.deepcopy(self._table)
        for key, value in changes.items():
            entries, last = cases.place(table, key, key)
            entries[last] = _plain(value)
        self._take(table)

    def copy(self) -> Case:
        """Another case with the same values."""
        return Case(self._table, self.name, self.file)

    def validate(self, *, allow_code: bool = False) -> list[str]:
        """Warnings of a case that can run; `CaseError` where `run` would end with one."""
        return launch.looked_at(self._resolved, self.gas_folder, allow_code=allow_code, whole=True)

    def save(self, folder: str | os.PathLike[str]) -> Path:
        """Write case.toml, the files that it names, and the OpenFOAM case of its gas into a new folder; the case is of
        there from then on."""
        target, table = Path(folder), copy.deepcopy(self._table)
        gas = self.gas_folder
        output.create(target, ())
        inputs.take_along(table, Path(), target)
        output.write_text(target / output.MARK, tomli_w.dumps(table))
        if "grains" in self._resolved.matters:
            output.copy_template(gas, target / "gas")
        self.name, self.file = target.resolve().name, target.resolve() / output.MARK
        self._take(cases.located(self.file))
        return target

    def keys(self) -> list[str]:
        """All dotted keys that it has, those with defaults too."""
        return list(flat(self.table))

    def __iter__(self) -> Iterator[str]:
        return iter(self.keys())

    def __contains__(self, key: object) -> bool:
        return key in flat(self.table)

    def __getitem__(self, key: str) -> Any:
        """The value of a key in its own unit, or a section."""
        found: Any = self.table
        for part in key.split("."):
            if not isinstance(found, dict) or part not in found:
                raise CaseError(unknown(key, found if isinstance(found, dict) else self.keys()))
            found = found[part]
        return found

    def __setitem__(self, key: str, value: Any) -> None:
        self.update({key: value})

    def __delitem__(self, key: str) -> None:
        """Take a key or a section out: its default holds then."""
        table = copy.deepcopy(self._table)
        entries, last = cases.place(table, key, key)
        if last not in entries:
            raise CaseError(f"{key} is not given in {self.name}, so it cannot be taken out")
        del entries[last]
        self._take(table)

    def __str__(self) -> str:
        """TOML text of the resolved case."""
        return cases.dumps(self._resolved)

    def __repr__(self) -> str:
        return f"<sdph.Case {self.name}: {self.title}>"


def _plain(value: Any) -> Any:
    """The value as TOML has it: of numpy a number or list, of a path a text."""
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, Mapping):
        return {str(key): _plain(own) for key, own in value.items()}
    if hasattr(value, "tolist"):
        value = value.tolist()
    return [_plain(own) for own in value] if isinstance(value, (list, tuple)) else value
