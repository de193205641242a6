"""Records of `sdph validate`: the checks of a scene as they were last measured, with date, version and commit."""

from __future__ import annotations

import datetime
import subprocess
from pathlib import Path

from sdph.running import output
from sdph.scenes import paths
from sdph.version import __version__


def write(folder: Path, scene: str, checks: list[dict], gas: str | None, acted: dict | None = None) -> Path:
    """Write `folder`/<scene>.json; `gas` is the solver that was asked for, None where none was, `acted` the limiters
    that acted in each run (sdph.running.limiters)."""
    folder.mkdir(parents=True, exist_ok=True)
    today = datetime.datetime.now(datetime.UTC).date().isoformat()
    own = {"scene": scene, "date": today, "version": __version__, "commit": commit(), "gas": gas or "as found"}
    output.write_json(folder / f"{scene}.json", own | {"limiters": acted or {}, "checks": checks})
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
