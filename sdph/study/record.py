"""Records of `sdph validate`: the checks of a scene as they were last measured, with date, version and commit.

Checks of a study name the part that they are of. A part that was recorded by itself replaces its own checks alone, and
`parts` has date, version, commit and gas of those that differ in them from the whole.
"""

from __future__ import annotations

import datetime
import subprocess
from pathlib import Path

from sdph.running import output
from sdph.scenes import paths
from sdph.schema import CaseError
from sdph.version import __version__

STAMP = ("date", "version", "commit", "gas")


def write(
    folder: Path, scene: str, checks: list[dict], gas: str | None, acted: dict | None = None, long: tuple[str, ...] = ()
) -> Path:
    """Write `folder`/<scene>.json; `gas` is the solver that was asked for, None where none was, `acted` the limiters
    that acted in each run (sdph.running.limiters). Checks of the parts in `long` that this run lacks stay as the
    record had them (`kept`)."""
    new, old = stamp(gas), kept(folder, scene) or {"checks": []}
    ran = {check.get("part") for check in checks}
    carried = [check for check in old["checks"] if check.get("part") in set(long) - ran]
    stamps = {check["part"]: _stamp_of(old, check["part"]) for check in carried}
    return _written(folder, scene, new | {"parts": stamps, "limiters": acted or {}}, [*checks, *carried])


def write_part(
    folder: Path, study: str, part: str, checks: list[dict], gas: str | None, order: tuple[str, ...]
) -> Path:
    """Write the record of a study anew with other checks of one part of it; `order` names its parts as they run."""
    old, own = with_parts(folder, study), [check | {"part": part} for check in checks]
    others = [check for check in old["checks"] if check["part"] != part]
    rank = {name: k for k, name in enumerate(order)}
    placed = sorted([*others, *own], key=lambda check: rank.get(check["part"], len(order)))
    return _written(folder, study, old | {"parts": old.get("parts", {}) | {part: stamp(gas)}}, placed)


def with_parts(folder: Path, study: str) -> dict:
    """The record of a study (`kept`), which tells of each check of which part it is; CaseError for one that does
    not."""
    found = kept(folder, study)
    if found is None or not all("part" in check for check in found["checks"]):
        what = "is not there yet" if found is None else "is an old one that does not name the parts of its checks"
        whole = f"sdph validate {study} --record {folder}"
        raise CaseError(f"--record {folder}: the record of {study} {what}, so that no part can be put in; {whole}")
    return found


def kept(folder: Path | None, scene: str) -> dict | None:
    """The record of a scene in a folder, or else the one that came along; None where there is neither."""
    return (folder and read(folder, scene)) or read(paths.data("validation") / "record", scene)


def stamp(gas: str | None) -> dict:
    """Date, version and commit of now, and the gas that was asked for."""
    today = datetime.datetime.now(datetime.UTC).date().isoformat()
    return {"date": today, "version": __version__, "commit": commit(), "gas": gas or "as found"}


def _stamp_of(made: dict, part: str) -> dict:
    """The stamp of a part in a record."""
    return made.get("parts", {}).get(part) or {key: made[key] for key in STAMP}


def _written(folder: Path, scene: str, made: dict, checks: list[dict]) -> Path:
    """Write a record, its `parts` without those that are of the same stamp as the whole, or have no check."""
    whole, names = {key: made[key] for key in STAMP}, {check.get("part") for check in checks}
    parts = {name: own for name, own in made["parts"].items() if own != whole and name in names}
    own = {"scene": scene} | whole | ({"parts": parts} if parts else {}) | {"limiters": made.get("limiters", {})}
    folder.mkdir(parents=True, exist_ok=True)
    output.write_json(folder / f"{scene}.json", own | {"checks": checks})
    return folder / f"{scene}.json"


def read(folder: Path, scene: str) -> dict | None:
    """The record of a scene in a folder; None where there is none."""
    path = folder / f"{scene}.json"
    return output.read_json(path) if path.is_file() else None


def commit() -> str | None:
    """Commit of the checkout that runs, "+" behind it where its programs differ from that; None without one."""
    root = paths.PACKAGE.parent
    if not (root / ".git").exists():  # installed, perhaps inside a checkout of something else
        return None
    try:
        head = _git(root, "rev-parse", "--short", "HEAD").strip()
        return head + "+" * bool(_git(root, "status", "--porcelain", "--untracked-files=no", "--", "sdph", "coupling"))
    except (OSError, subprocess.CalledProcessError):
        return None


def _git(root: Path, *words: str) -> str:
    return subprocess.run(["git", "-C", str(root), *words], capture_output=True, text=True, check=True).stdout
