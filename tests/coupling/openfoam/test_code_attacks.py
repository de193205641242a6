"""Without --allow-code nothing that came with a case or a run folder runs code, by whatever way it is hidden."""

import multiprocessing
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest
from attack_places import CUT, MESH, build_library, make_place
from code_attacks import ATTACKS, FUNCTION, PROBE, WM_OPTIONS
from run_attacks import RESUMED

from coupling.openfoam.programs import install
from sdph import cli

pytestmark = pytest.mark.openfoam
SMALL = ("--set", "resolution.spacing_mm=20", "--set", "resolution.cell_mm=50", "--until", "1e-6")
RUN = ("run", "my_case", "--gas", "openfoam", *SMALL, "--out", "run")
RESUME = ("run", "--resume", "run", "--until", "2e-6")
NOBODY = 65534  # user and group without rights
SHOWN = 300  # characters of what was said that a failure shows
LONGEST = 120.0  # s that a command may take

# Imported once, before it is forked for each command: what takes the time of a command that is refused
SERVER = multiprocessing.get_context("forkserver")
USED = (
    "sdph.cli",
    "sdph.running.driver",
    "sdph.show.watch",
    "sdph.study.cost.choice",
    "sdph.study.explain.tables",
    "coupling.openfoam.solver",
)
SERVER.set_forkserver_preload(list(USED))


def command_line(arguments, folder, said):
    """The command in a process of its own, which ends with the command's exit code."""
    os.environ |= {"WM_OPTIONS": WM_OPTIONS, "PWD": str(folder)}
    os.chdir(folder)
    with open(said, "wb") as out:
        os.dup2(out.fileno(), 1)
        os.dup2(out.fileno(), 2)
    sys.exit(cli.main(list(arguments)))


def sdph(*arguments, cwd):
    """(exit code, what it said) of a command line in a folder."""
    process = SERVER.Process(target=command_line, args=(arguments, cwd, cwd / "said"))
    process.start()
    process.join(LONGEST)
    if process.is_alive():
        process.kill()
        pytest.fail(f"sdph {' '.join(arguments)} does not end")
    return process.exitcode, (cwd / "said").read_text(errors="replace")


@pytest.fixture(scope="module")
def base(tmp_path_factory):
    """A folder with the case as `sdph init` makes it, a library that leaves a mark, and a run of the case."""
    folder = tmp_path_factory.mktemp("base")
    code, said = sdph("init", "disc_cluster", "my_case", cwd=folder)
    assert code == 0, said
    code, said = sdph(*RUN, cwd=folder)
    assert code == 0, said
    build_library(folder / "mark.so")
    return folder


@pytest.fixture
def place(base, tmp_path):
    return make_place(tmp_path, base / "my_case", base / "mark.so")


def assert_nothing_ran(place, code, said):
    assert not place.ran, f"code of the case ran (exit {code}): {said[-SHOWN:]}"
    assert "Traceback" not in said
    assert code in (0, 2), said[-SHOWN:]  # refused, or made harmless
    if code == 2:
        assert len([line for line in said.splitlines() if line.startswith("sdph: ")]) == 1


@pytest.mark.parametrize("name", ATTACKS)
def test_a_case_runs_no_code(place, name):
    ATTACKS[name].edit(place)
    assert_nothing_ran(place, *sdph(*RUN, cwd=place.root))


@pytest.mark.parametrize("name", RESUMED)
def test_a_run_folder_runs_no_code(base, place, name):
    shutil.copytree(base / "run", place.root / "run")
    RESUMED[name](place)
    assert_nothing_ran(place, *sdph(*RESUME, cwd=place.root))


def test_a_run_that_goes_on_writes_to_no_file_outside(base, place):
    """A log that is a link would let the run overwrite any file of the user's."""
    shutil.copytree(base / "run", place.root / "run")
    log, victim = place.root / "run" / "gas" / "log.sdphGasFoam", place.root / "profile"
    victim.write_text("mine\n")
    log.unlink()
    log.symlink_to(victim)
    code, said = sdph(*RESUME, cwd=place.root)
    assert victim.read_text() == "mine\n"
    assert code in (0, 2) and "Traceback" not in said


def test_a_comparison_runs_no_code(base, place):
    """The two-fluid template is our own, and includes what is made of case.toml: that alone is enough."""
    run = place.root / "run"
    shutil.copytree(base / "run", run)
    place.change("case.toml", "end_time_s = 1e-06", "end_time_s = 1e-4", run)
    place.change("case.toml", "output_interval_s = 0.01", "output_interval_s = 5e-5", run)
    place.add("case.toml", PROBE.replace("@ENTRY", FUNCTION), run)
    code, said = sdph("compare", "run", "--against", "tfm", cwd=place.root)
    assert not place.ran and "Traceback" not in said
    assert code in (0, 1, 2), said[-SHOWN:]


@pytest.fixture
def public(base):
    """As `place`, where a user without rights may work."""
    with tempfile.TemporaryDirectory() as folder:
        os.chmod(folder, 0o755)
        yield make_place(Path(folder), base / "my_case", base / "mark.so")


def openfoam(place, program, as_user):
    """Run a program of OpenFOAM on `run/gas`; its exit code does not matter."""
    other = {"user": NOBODY, "group": NOBODY} if as_user and os.geteuid() == 0 else {}
    environment = install.environment() | {"WM_OPTIONS": WM_OPTIONS, "PWD": str(place.root)}
    folder = place.root / "run" / "gas"
    subprocess.run([program], cwd=folder, env=environment, capture_output=True, check=False, timeout=LONGEST, **other)


@pytest.mark.parametrize("name", [name for name, attack in ATTACKS.items() if attack.programs])
def test_an_attack_is_one(public, name):
    """OpenFOAM alone does run the code: what is refused above is no straw man."""
    attack = ATTACKS[name]
    attack.edit(public)
    gas = public.root / "run" / "gas"
    shutil.copytree(public.gas, gas)
    for dictionary, text in (("blockMeshDict", MESH.replace("@WALLS", "walls")), ("decomposeParDict", CUT)):
        if not (gas / "system" / dictionary).exists():
            (gas / "system" / dictionary).write_text(text)
    for path in (gas, *gas.rglob("*")):
        path.chmod(0o777)
    for program in attack.programs:
        openfoam(public, program, attack.as_user)
    assert public.ran


BENIGN = {
    "comment": '// no libs ("liba.so"), #calc or #codeStream here\n/* libs (a); */ note "see // libs and #{ #calc";\n',
    "macro": "digits 10;\nnotes { writePrecision $digits; }\n$notes;\n",
    "include": '#include "../constant/numbers"\n#includeIfPresent "../constant/none"\n',
}


@pytest.mark.parametrize("name", BENIGN)
def test_what_only_looks_like_code_runs(place, name):
    place.change("system/controlDict", "writePrecision  10;", "" if name != "comment" else "writePrecision  10;")
    place.add("constant/numbers", "writePrecision 10;\n")
    place.add("system/controlDict", BENIGN[name])
    code, said = sdph(*RUN, cwd=place.root)
    assert code == 0, said
