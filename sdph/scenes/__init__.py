"""Built-in scenes: each folder holds a case.toml and a README."""

from __future__ import annotations

import tomllib
from pathlib import Path

from sdph.schema import CaseError, unknown

HERE = Path(__file__).parent


def names() -> list[str]:
    """Names of the built-in scenes."""
    return sorted(path.parent.name for path in HERE.glob("*/case.toml"))


def title(name: str) -> str:
    """The one line that says what a scene is."""
    return tomllib.loads((HERE / name / "case.toml").read_text(encoding="utf-8"))["title"]


def _without_case(folder: str) -> str:
    """The message for a folder that is no case folder; one that is called as a scene hides that."""
    told = f"{folder} is a folder that holds no case.toml; give one that does, or a case file"
    if (HERE / folder / "case.toml").is_file():
        return f"{told}; for the scene {folder} rename that folder, or call sdph from another one"
    return f"{told}; `sdph init SCENE DIR` makes one in a new folder, `sdph list` tells the scenes"


def find(target: str) -> tuple[str, Path]:
    """(scene name, case.toml) of a scene's name, a folder made by `sdph init`, or a case file."""
    path = Path(target)
    if (HERE / target / "case.toml").is_file() and not path.exists():
        return target, HERE / target / "case.toml"
    file = path / "case.toml" if path.is_dir() else path
    if path.is_dir() and not file.is_file():
        raise CaseError(_without_case(target))
    if not file.is_file():
        raise CaseError(unknown(target, names()).replace("unknown key", "no scene, folder or case file called", 1))
    return file.resolve().parent.name, file
