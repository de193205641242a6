"""`sdph warm`: a run after it compiles nothing, and cases that cannot be run are told."""

import os
import subprocess
import sys
from pathlib import Path

from sdph.cli import main
from sdph.study import pool, warm


def kernels(folder: Path) -> set[str]:
    return {path.name for path in folder.rglob("*.nbc")}


def sdph(*words, cache: Path):
    command = [sys.executable, "-m", "sdph.cli", *map(str, words)]
    own = os.environ | {"NUMBA_CACHE_DIR": str(cache)}
    return subprocess.run(command, env=own, capture_output=True, text=True, check=False)


def test_a_run_after_it_compiles_nothing(tmp_path):
    done = sdph("warm", "colliding_rings", cache=tmp_path / "cache")
    assert done.returncode == 0 and "1/1 colliding_rings: is warm" in done.stderr
    compiled = kernels(tmp_path / "cache")
    out = tmp_path / "run"
    assert sdph("run", "colliding_rings", "--until", "2e-4", "--out", out, cache=tmp_path / "cache").returncode == 0
    assert len(compiled) > 5 and kernels(tmp_path / "cache") == compiled


def test_workers_compile_for_runs_of_all_threads(monkeypatch):
    """Those of one thread, as a worker of several has, are other kernels."""
    given = []
    monkeypatch.delenv("NUMBA_NUM_THREADS", raising=False)
    monkeypatch.setattr(pool, "outcomes", lambda jobs, *_: given.extend(jobs) or ())
    assert warm.warm(["disc_cluster"], None, (os.cpu_count(), None), print) == 0
    assert [warm.environment(job.threads).get("NUMBA_NUM_THREADS") for job in given] == [None]


def test_who_cannot_be_run_is_told(tmp_path, capsys):
    case = tmp_path / "case.toml"
    case.write_text('title = "nothing"\n', encoding="utf-8")
    assert main(["warm", str(case)]) == 2
    assert "is missing; it has no default" in capsys.readouterr().err
    assert main(["warm", "nobodys_scene"]) == 2
