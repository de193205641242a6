"""Keys that stand in the wrong section of a case, with the place where they belong."""

from __future__ import annotations

from sdph import effects
from sdph.schema import CaseError, fields

FEW = 3  # places that are named; our choice


def refuse(table: dict, sections: dict[str, type]) -> None:
    """CaseError where a key is none of its section, but a section, by its last word, or a key of another one."""
    own = {name: fields(cls) for name, cls in sections.items()}
    own |= {name: fields(row.parameters) for name, row in effects.REGISTRY.items() if row.parameters}
    for where, entries in table.items():
        for key in _strange(entries, own.get(where)):
            if found := _places(key, where, own):
                hint = f"did you mean {' or '.join(found[:FEW])}?"
                known = ", ".join(sorted(own[where]))
                raise CaseError(f"unknown key {where}.{key}; {hint} known here: {known}")


def _strange(entries, known) -> list[str]:
    """Keys of a section that are none of those known, not even without a unit."""
    if known is None or not isinstance(entries, dict):
        return []
    whole = [key for key, value in entries.items() if key not in known and not isinstance(value, dict)]
    return [key for key in whole if not any(name.startswith(f"{key}_") for name in known)]


def _places(key: str, where: str, own: dict) -> list[str]:
    """Sections and keys that a key of the section `where` may mean."""
    word = key.rpartition("_")[2]
    found = [f"[{word}]"] if word in own and word != where else []
    return found + [f"{name}.{key}" for name, known in own.items() if key in known]
