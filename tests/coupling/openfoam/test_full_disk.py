"""A disk that is full under OpenFOAM, whoever finds out: exit code 4, and what is there goes on."""

import subprocess

import pytest

from coupling.openfoam.programs import install
from sdph.cli import main

pytestmark = pytest.mark.openfoam

SETTINGS = ("resolution.cell_mm=10", "resolution.spacing_mm=10", "run.output_interval_s=1e-4", "run.end_time_s=4e-4")


@pytest.fixture
def disk(tmp_path):
    """size -> a new folder on a disk of that size."""
    folders = []

    def mount(size: int):
        folders.append(tmp_path / f"disk{len(folders)}")
        folders[-1].mkdir()
        command = ["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", folders[-1]]
        if subprocess.run(command, capture_output=True).returncode:
            pytest.skip("only root can mount a tmpfs")
        return folders[-1]

    yield mount
    for folder in folders:  # lazily: errors that are kept hold open files
        subprocess.run(["umount", "--lazy", folder], check=True)


def run(folder, *options: str) -> int:
    settings = [f"--set={text}" for text in SETTINGS]
    return main(["run", "disc_cluster", "--gas", "openfoam", *settings, *options, "--out", str(folder / "run")])


def room(folder) -> int:
    """Bytes that a whole run takes."""
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())


def test_full_disk(tmp_path, disk, capsys):
    """Disks on which the mesh, the first checkpoint, an output or the exchange by files finds no room."""
    assert run(tmp_path) == 0
    whole = room(tmp_path / "run")
    for share, options in ((0.05, ()), (0.2, ()), (0.5, ()), (0.8, ()), (0.5, ("--transport", "file"))):
        capsys.readouterr()
        folder = disk(int(share * whole))
        code, said = run(folder, *options), capsys.readouterr().err.splitlines()
        assert code == 4, (share, said)
        assert "No space left" in said[-1] and not any("Traceback" in line for line in said), (share, said)
        if (folder / "run" / "checkpoints" / "000000000").is_dir():
            subprocess.run(["mount", "-o", "remount,size=100m", folder], check=True)
            assert main(["run", "--resume", str(folder / "run")]) == 0


def test_a_solver_that_fails_does_not_end_with_0(tmp_path):
    command = [install.gas_solver(), "-case", tmp_path, "-address", "file:/nowhere"]
    done = subprocess.run(command, env=install.environment(), capture_output=True, text=True)
    assert done.returncode == 1, done.stderr
