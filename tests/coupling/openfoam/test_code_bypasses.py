"""Cases that try to run code of their own: `sdph run` refuses them in one line, and nothing of them has run.

Each plants a library that leaves a marker file when it is loaded.
"""

import json
import os
import shutil
import subprocess
import sys

import pytest

from sdph.scenes import paths

pytestmark = pytest.mark.openfoam

COARSE = ("resolution.spacing_mm=20", "resolution.cell_mm=50", "run.output_interval_s=0.001")
SMALL = ("--gas", "openfoam", *(word for key in COARSE for word in ("--set", key)))
SOURCE = '#include <cstdio>\nstatic const auto run = std::fopen("{marker}", "w");\n'
COMPILER = '#!/bin/sh\ntouch "{marker}"\nexit 1\n'  # wmake, which #calc calls


class Trap:
    """A case with its own gas folder, a library and a compiler that leave `marker`, and a folder outside."""

    def __init__(self, root):
        self.root, self.case, self.outside, self.marker = root, root / "case", root / "outside", root / "marker"
        self.outside.mkdir()
        shutil.copytree(paths.data("openfoam_case_templates") / "disc_cluster" / "gas", self.case / "gas")
        shutil.copy(paths.PACKAGE / "scenes" / "disc_cluster" / "case.toml", self.case / "case.toml")
        (root / "library.cpp").write_text(SOURCE.format(marker=self.marker))
        subprocess.run(["g++", "-shared", "-fPIC", root / "library.cpp", "-o", root / "library.so"], check=True)
        (root / "bin").mkdir()
        (root / "bin" / "wmake").write_text(COMPILER.format(marker=self.marker))
        (root / "bin" / "wmake").chmod(0o755)
        self.load = f'libs ("{root / "library.so"}");'
        self.control = self.case / "gas" / "system" / "controlDict"

    def add(self, text, name="system/controlDict"):
        """Append to a file of the case."""
        path = self.case / "gas" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.open("a") as file:
            file.write(f"{text}\n")

    def sdph(self, *arguments):
        """`sdph run` from elsewhere."""
        command = [sys.executable, "-m", "sdph.cli", "run", *map(str, arguments)]
        path = os.pathsep.join([str(self.root / "bin"), os.environ["PATH"]])
        more = {"PYTHONPATH": str(paths.PACKAGE.parent), "PATH": path, "WM_OPTIONS": "any"}
        settings = {"cwd": self.outside, "env": os.environ | more, "capture_output": True, "text": True, "timeout": 240}
        return subprocess.run(command, **settings, check=False)

    def is_refused(self, *arguments):
        done = self.sdph(*arguments)
        assert not self.marker.exists(), "the code has run"
        assert done.returncode == 2, done.stderr
        told = [line for line in done.stderr.splitlines() if "begins again" not in line]
        assert len(told) == 1 and told[0].startswith("sdph: ") and "--allow-code" in told[0]
        return done.stderr


@pytest.fixture
def trap(tmp_path):
    return Trap(tmp_path)


def include_outside(trap):
    (trap.outside / "evil").write_text(trap.load)
    trap.add(f'#include "{trap.outside}/evil"')


def include_above(trap):
    (trap.case / "evil").write_text(trap.load)
    trap.add('#include "../../evil"')


def linked_system(trap):
    trap.add(trap.load)
    trap.control.parent.rename(trap.outside / "system")
    trap.control.parent.symlink_to(trap.outside / "system")


def linked_file(trap):
    trap.add(trap.load)
    trap.control.rename(trap.outside / "controlDict")
    trap.control.symlink_to(trap.outside / "controlDict")


def behind_an_address(trap):
    trap.add(f'note "http://x"; {trap.load}')


def between_quoted_comments(trap):
    trap.add(f'a "/*"; {trap.load} b "*/";')


def in_the_mesh(trap):
    trap.add('#include "../constant/polyMesh/owner"')
    trap.add(trap.load, "constant/polyMesh/owner")


def in_a_header_of_the_mesh(trap):
    header = 'version 2.0; format ascii; class vectorField; object points; a #calc "1 + 1";'
    trap.add(f"FoamFile {{ {header} }}\n0()", "constant/polyMesh/points")


def under_an_expression(trap):
    trap.add(trap.load.replace("libs", '"li.*"'))


def under_a_scoped_key(trap):
    trap.add(trap.load.replace("libs", '"/libs"'))


def by_a_renamed_folder(trap):
    (trap.outside / "evil").write_text(trap.load)
    trap.add(f'FOAM_CASE "{trap.outside}";\n#include "$FOAM_CASE/evil"')


def compressed_in_name_alone(trap):
    trap.add(trap.load, "system/evil.gz")
    trap.add('#include "evil"')


@pytest.mark.parametrize(
    "plant",
    [
        include_outside,
        include_above,
        linked_system,
        linked_file,
        behind_an_address,
        between_quoted_comments,
        in_the_mesh,
        in_a_header_of_the_mesh,
        under_an_expression,
        under_a_scoped_key,
        by_a_renamed_folder,
        compressed_in_name_alone,
    ],
    ids=lambda plant: plant.__name__,
)
def test_a_case_that_brings_code_is_refused(trap, plant):
    plant(trap)
    trap.is_refused(trap.case, "--out", trap.root / "run", *SMALL, "--until", "0.001")
    assert not (trap.root / "run").exists()


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A trap that has not been set, and the folder of a run of it."""
    trap = Trap(tmp_path_factory.mktemp("finished"))
    done = trap.sdph(trap.case, "--out", trap.root / "run", *SMALL, "--until", "0.001")
    assert done.returncode == 0, done.stderr
    return trap, trap.root / "run"


@pytest.fixture
def elsewhere(finished, tmp_path):
    """A run folder that came from elsewhere, and brings permission of its own."""
    trap, run = finished
    trap.marker.unlink(missing_ok=True)
    shutil.copytree(run, tmp_path / "run")
    brought = {"allow_code": True, "gas_template": str(tmp_path / "run" / "gas")}
    origin = json.loads((run / "origin.json").read_text()) | brought
    (tmp_path / "run" / "origin.json").write_text(json.dumps(origin))
    return trap, tmp_path / "run"


def append(path, text):
    with path.open("a") as file:
        file.write(f"{text}\n")


def test_a_run_folder_from_elsewhere_gives_no_permission(elsewhere):
    trap, run = elsewhere
    append(run / "gas" / "system" / "controlDict", f'note "http://x"; {trap.load}')
    trap.is_refused("--resume", run, "--until", "0.002")
    assert any((run / "checkpoints").iterdir())
    done = trap.sdph("--resume", run, "--until", "0.002", "--allow-code")  # given anew
    assert done.returncode == 0, done.stderr
    assert trap.marker.exists()


def test_a_run_folder_without_checkpoint_gives_no_permission(elsewhere):
    trap, run = elsewhere
    shutil.rmtree(run / "checkpoints")
    append(run / "inputs" / "gas" / "system" / "controlDict", trap.load)  # it begins again from there
    trap.is_refused("--resume", run, "--json")


def test_a_run_folder_with_a_linked_case_is_refused(elsewhere):
    trap, run = elsewhere
    (run / "gas").rename(run / "other")
    (run / "gas").symlink_to(run / "other")
    done = trap.sdph("--resume", run, "--until", "0.002")
    assert done.returncode == 2 and "gas is a link" in done.stderr and done.stderr.count("\n") == 1


def test_a_run_folder_without_code_goes_on(elsewhere):
    trap, run = elsewhere
    done = trap.sdph("--resume", run, "--until", "0.002")
    assert done.returncode == 0, done.stderr


def test_with_permission_the_code_of_a_case_runs(trap):
    include_outside(trap)
    done = trap.sdph(trap.case, "--out", trap.root / "run", *SMALL, "--until", "0.001", "--allow-code")
    assert done.returncode == 0, done.stderr
    assert trap.marker.exists()
    assert "allow_code" not in (trap.root / "run" / "origin.json").read_text()
