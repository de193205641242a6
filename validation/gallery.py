"""`make gallery`: a picture of every scene, of a short and coarse run each, into runs/gallery.

python validation/gallery.py [SCENE ...]: all of gallery.toml, or those named. One that is there is not made again.
"""

from __future__ import annotations

import subprocess
import sys
import time
import tomllib
from pathlib import Path

FOLDER = Path("runs") / "gallery"
LARGEST = 300_000  # bytes of a picture
LIMIT = 600  # s that a run may take; our choice


def main(names: list[str]) -> int:
    """Make them in turn; returns how many failed."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    entries = tomllib.loads(Path(__file__).with_name("gallery.toml").read_text(encoding="utf-8"))
    failed = [name for name in names or entries if not made(name, entries[name])]
    print(
        f"{FOLDER}: {len(list(FOLDER.glob('*.png')))} pictures", *(f"no picture of {name}" for name in failed), sep="\n"
    )
    return len(failed)


def made(name: str, entry: dict) -> bool:
    """Run and draw a scene, unless its picture is there; says how long it took."""
    picture, run, begun = FOLDER / f"{name}.png", FOLDER / "runs" / name, time.perf_counter()
    if picture.exists():
        return True
    if not (run / "summary.json").is_file():
        begin = ["run", name, "--out", str(run), *settings(entry)]
        _say(["run", "--resume", str(run)] if run.exists() else begin, name)
    drawn = _say(["view", str(run), "--png", str(picture), *entry.get("view", [])], name)
    if drawn:
        shrink(picture)
        print(f"{name}: {time.perf_counter() - begun:.0f} s, {picture.stat().st_size / 1e3:.0f} kB", flush=True)
    return drawn


def settings(entry: dict) -> list[str]:
    """Options of `sdph run` for an entry."""
    gas = ["--gas", entry["gas"]] if "gas" in entry else []
    return [*gas, *(word for value in entry["set"] for word in ("--set", value))]


def shrink(picture: Path) -> None:
    """Fewer colours, where the file is larger than `LARGEST`."""
    from PIL import Image

    if picture.stat().st_size > LARGEST:
        Image.open(picture).convert("RGB").quantize(128).save(picture, optimize=True)


def _say(words: list[str], name: str) -> bool:
    """Run `sdph` with words; what it says goes to a file beside the pictures."""
    with open(FOLDER / f"{name}.log", "a", encoding="utf-8") as log:
        try:
            command = [sys.executable, "-m", "sdph.cli", *words]
            done = subprocess.run(command, stdout=log, stderr=subprocess.STDOUT, timeout=LIMIT, check=False)
        except subprocess.TimeoutExpired:
            print(f"{name}: took longer than {LIMIT} s", flush=True)
            return False
    return done.returncode == 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
