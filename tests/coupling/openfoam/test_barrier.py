"""What a case cannot do even where its files were not read: run commands and load libraries."""

import os
import shutil
import subprocess
import tempfile
from pathlib import Path

import pytest
from gas_boxes import TEMPLATE, box_case

from coupling.gas import GasError
from coupling.openfoam import case as case_files
from coupling.openfoam.comparators import run as comparators
from coupling.openfoam.programs import barrier, install
from coupling.openfoam.programs import run as programs
from coupling.openfoam.solver import OpenFoamGas
from sdph import scenes
from sdph.case import read as cases
from sdph.schema import CaseError

pytestmark = pytest.mark.openfoam

SWITCHED_ON = "InfoSwitches { allowSystemOperations 1; }\nOptimisationSwitches { allowSystemOperations 1; }\n"


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    """A library that leaves the file `marker` beside it when it is loaded."""
    folder = tmp_path_factory.mktemp("library")
    source = f'#include <cstdio>\nstatic const auto run = std::fopen("{folder}/marker", "w");\n'
    (folder / "library.cpp").write_text(source)
    subprocess.run(["g++", "-shared", "-fPIC", folder / "library.cpp", "-o", folder / "library.so"], check=True)
    return folder / "library.so"


@pytest.fixture
def marker(library):
    marker = library.with_name("marker")
    marker.unlink(missing_ok=True)
    return marker


@pytest.fixture
def case(tmp_path):
    """An OpenFOAM case with a mesh of two ranks."""
    folder = tmp_path / "gas"
    case_files.write_case(box_case((0.1, 0.1), 0.01), TEMPLATE, folder, 2)
    programs.run(["blockMesh"], folder, tmp_path / "log")
    return folder


def append(path, text):
    with path.open("a") as file:
        file.write(f"{text}\n")


@pytest.mark.parametrize("program", ["blockMesh", "decomposePar"])
@pytest.mark.parametrize("entry", ['libs ("{0}");', '"li.*" ("{0}");'])
def test_programs_load_no_library_of_a_case(case, library, marker, program, entry):
    append(case / "system" / "controlDict", entry.format(library))
    programs.run([program], case, case / "log", install.environment())
    assert marker.exists()  # it would
    marker.unlink()
    shutil.rmtree(case / "processor0", ignore_errors=True)
    shutil.rmtree(case / "processor1", ignore_errors=True)
    with pytest.raises(
        GasError, match=f"{program} ended with code 1: the case loads the library {library}; give --allow-code"
    ):
        programs.run([program], case, case / "log")
    assert not marker.exists()


@pytest.mark.parametrize("ranks", [1, 2])
def test_the_gas_solver_loads_no_library_of_a_case(tmp_path, library, marker, ranks, monkeypatch):
    gas_case = box_case((0.1, 0.1), 0.01, ranks=ranks)
    OpenFoamGas(gas_case, tmp_path / "gas", TEMPLATE).close()
    append(tmp_path / "gas" / "system" / "controlDict", f'libs ("{library}");')
    monkeypatch.setattr(case_files, "refuse_code", lambda *given: None)  # as if the first barrier had let it pass
    with pytest.raises(GasError, match="the case loads the library"):
        OpenFoamGas(gas_case, tmp_path / "gas", None)
    assert not marker.exists()
    OpenFoamGas(gas_case, tmp_path / "gas", None, allow_code=True).close()
    assert marker.exists()


@pytest.fixture
def of_nobody():
    """A folder that an ordinary user may write: OpenFOAM compiles nothing for root."""
    folder = Path(tempfile.mkdtemp(prefix="sdph-code-"))
    yield folder
    shutil.rmtree(folder)


def as_nobody(command, folder, environment):
    """Run a command as an ordinary user, with a wmake that leaves a marker."""
    (folder / "wmake").write_text(f"#!/bin/sh\ntouch {folder}/marker\nexit 1\n")
    (folder / "wmake").chmod(0o755)
    become = []
    if os.geteuid() == 0:
        become = ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"]
        subprocess.run(["chown", "-R", "65534", folder], check=True)
    more = {"PATH": os.pathsep.join([str(folder), environment["PATH"]]), "WM_OPTIONS": "any"}
    settings = {"cwd": folder / "gas", "env": environment | more, "capture_output": True, "text": True}
    return subprocess.run([*become, *command], **settings, check=False)


def test_programs_compile_nothing_for_a_case_whatever_it_switches(of_nobody):
    case_files.write_case(box_case((0.1, 0.1), 0.01), TEMPLATE, of_nobody / "gas")
    append(of_nobody / "gas" / "system" / "controlDict", SWITCHED_ON)
    append(of_nobody / "gas" / "system" / "blockMeshDict", 'x #calc "1 + 1";')
    as_nobody(["blockMesh"], of_nobody, install.environment())
    assert (of_nobody / "marker").exists()  # it would
    (of_nobody / "marker").unlink()
    done = as_nobody(["blockMesh"], of_nobody, barrier.environment(libraries=True))  # the guard lies in root's cache
    assert "case-supplied code may have been disabled" in done.stderr
    assert not (of_nobody / "marker").exists()


def test_the_user_s_own_control_dictionary_counts_but_for_code(tmp_path, case, monkeypatch):
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    own = tmp_path / "home" / ".OpenFOAM" / "controlDict"
    own.parent.mkdir(parents=True)
    own.write_text("// mine\nInfoSwitches { allowSystemOperations 1; writePrecision 7; }\n")
    programs.run(["blockMesh"], case, case / "log", barrier.environment(libraries=True))
    assert "Disallowing user-supplied system call operations" in (case / "log").read_text()
    given = barrier.environment(libraries=True)["FOAM_CONTROLDICT"]
    assert "mine" not in given and given.index("writePrecision 6") < given.index("writePrecision 7")


def test_no_program_is_taken_from_the_folder_of_a_case(case, monkeypatch):
    (case / "blockMesh").write_text("#!/bin/sh\ntouch marker\n")
    (case / "blockMesh").chmod(0o755)
    monkeypatch.setenv("PATH", f":.:{os.environ['PATH']}")
    monkeypatch.setenv("LD_LIBRARY_PATH", f":{case}:")
    programs.run(["blockMesh"], case, case / "log")
    assert not (case / "marker").exists()
    assert "" not in barrier.environment()["LD_LIBRARY_PATH"].split(":")


def test_a_comparison_takes_nothing_of_what_was_in_its_folder(tmp_path):
    """The folder of a run that came from elsewhere may hold one."""
    folder, kept = tmp_path / "tfm", tmp_path / "elsewhere"
    for name in ("system", "0.0", "constant/polyMesh", "dynamicCode"):
        (folder / name).mkdir(parents=True)
    (folder / "system" / "blockMeshDict").write_text('libs ("evil.so");')
    kept.mkdir()
    (folder / "processor0").symlink_to(kept)
    case = cases.load(
        scenes.HERE / "disc_cluster" / "case.toml",
        ("resolution.cell_mm=25.0", "coupling.one_way=true", "run.end_time_s=0.002", "run.output_interval_s=0.001"),
    )
    comparators.run_two_fluid(case, folder)
    assert "evil" not in (folder / "system" / "blockMeshDict").read_text()
    assert not (folder / "dynamicCode").exists() and kept.is_dir()
    (tmp_path / "link").symlink_to(folder)
    with pytest.raises(CaseError, match="is a link"):
        comparators.run_two_fluid(case, tmp_path / "link")
