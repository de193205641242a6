"""`sdph completion`: bash completes what it should; and the steps of the Dockerfile are those of CI."""

import subprocess
from pathlib import Path

import pytest

from sdph import cli, scenes

ROOT = Path(__file__).parents[2]


def completed(words: str, folder: Path, script: str) -> set[str]:
    """Words that bash offers after `words`, the last of which is begun."""
    own = words.split(" ")
    line = f"COMP_WORDS=({words}); COMP_CWORD={len(own) - 1}; _shtab_sdph sdph '{own[-1]}' '{own[-2]}'"
    command = ["bash", "-c", f'{script}\n{line}\nprintf "%s\\n" "${{COMPREPLY[@]}}"']
    return set(subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True).stdout.split())


def test_bash_completes(tmp_path, capsys):
    assert cli.main(["completion", "bash"]) == 0
    script = capsys.readouterr().out
    (tmp_path / "bubbles.toml").touch()
    bubbling = {name for name in scenes.names() if name.startswith("bub")}
    assert completed("sdph run bub", tmp_path, script) == bubbling | {"bubbles.toml"}
    assert completed("sdph validate bubble_r", tmp_path, script) == {"bubble_rise"}
    assert completed("sdph do", tmp_path, script) == {"doctor"}
    assert "--transport" in completed("sdph run --tra", tmp_path, script)


@pytest.mark.parametrize("shell", ["zsh", "bash"])
def test_the_script_names_all_scenes(shell, capsys):
    assert cli.main(["completion", shell]) == 0
    assert " ".join(scenes.names()) in capsys.readouterr().out


def test_the_dockerfile_takes_the_steps_of_ci():
    """`make` from apt, then `make setup` with CI=true, which `make test` of CI begins with."""
    steps = [
        line.removeprefix("RUN ") for line in (ROOT / "Dockerfile").read_text().splitlines() if line.startswith("RUN ")
    ]
    ci, makefile = (ROOT / ".ci" / "run").read_text(), (ROOT / "Makefile").read_text()
    install = "apt-get install -y -qq --no-install-recommends make"
    assert install in steps[0] and install in ci
    assert steps[1:] == ["CI=true make -C /sdph setup"]
    assert "CI=true make test" in ci and "\ntest: setup" in makefile
